//! Formats that are known but not read, each with what to do instead.

use super::input_file::{HEAD_BYTES, InputFile};

/// A format that is recognised to say what to do instead of reading it.
#[derive(Debug)]
pub(crate) struct UnreadFormat {
    /// Its usual name, with an article.
    pub name: &'static str,
    /// How its orientation can be given, as a clause.
    pub advice: &'static str,
    /// Bytes or words that its beginning holds, each group of them together.
    signatures: &'static [&'static [&'static str]],
    /// How names of such files end, for those without signature.
    endings: &'static [&'static str],
}

const METASHAPE: &str = "in Metashape choose File > Export > Export Cameras and \"Agisoft XML\"";
const PIX4D: &str =
    "add the file NAME_calibrated_camera_parameters.txt that Pix4D writes to 1_initial/params";
const PLACES: &str = "places alone do not orient photographs; orient them with any program that the table of formats \
                      names (COLMAP, OpenDroneMap and MicMac are free) and add its result";

/// Content decides before names.
const UNREAD: [UnreadFormat; 23] = [
    UnreadFormat {
        name: "an OpenMVG scene",
        advice: "convert it with openMVG_main_openMVG2Colmap, and add cameras.txt and images.txt",
        signatures: &[&["\"sfm_data_version\""]],
        endings: &["sfm_data.bin"],
    },
    UnreadFormat {
        name: "an AliceVision (Meshroom) scene",
        advice: "add a node ExportColmap (aliceVision_exportColmap) behind StructureFromMotion, and its cameras.txt and images.txt",
        signatures: &[
            &["\"poses\"", "\"intrinsics\"", "\"poseId\""],
            &["\"views\"", "\"intrinsicId\"", "\"viewId\""],
        ],
        endings: &[".sfm"],
    },
    UnreadFormat {
        name: "an Alembic archive (Meshroom)",
        advice: "add a node ExportColmap (aliceVision_exportColmap) behind StructureFromMotion, and its cameras.txt and images.txt",
        signatures: &[&["Ogawa"]],
        endings: &[".abc"],
    },
    UnreadFormat {
        name: "an OPF project (Open Photogrammetry Format)",
        advice: "convert it with opf2colmap of the package pyopf, and add cameras.txt and images.txt",
        signatures: &[&["application/opf-"]],
        endings: &[".opf"],
    },
    UnreadFormat {
        name: "a RealityCapture list of cameras",
        advice: "in RealityCapture export the registration as COLMAP or as Bundler",
        signatures: &[
            &["#name,x,y,alt,"],
            &["#name,x,y,alt\n"],
            &["#name,x,y,z,heading,pitch,roll"],
        ],
        endings: &[],
    },
    UnreadFormat {
        name: "a RealityCapture sidecar",
        advice: "in RealityCapture export the registration as COLMAP or as Bundler",
        signatures: &[&["xcr:Rotation"], &["xcr:Version"]],
        endings: &[".rcproj"],
    },
    UnreadFormat {
        name: "a Metashape project",
        advice: METASHAPE,
        signatures: &[&["<document", ".files/project.zip"]],
        endings: &[".psx", ".psz"],
    },
    UnreadFormat {
        name: "a Pix4Dmapper project",
        advice: PIX4D,
        signatures: &[],
        endings: &[".p4d"],
    },
    UnreadFormat {
        name: "a Pix4Dmatic project",
        advice: "export its camera parameters (calibrated_camera_parameters.txt), or OPF and convert that with opf2colmap of the package pyopf",
        signatures: &[],
        endings: &[".p4m"],
    },
    UnreadFormat {
        name: "a ContextCapture project",
        advice: "in ContextCapture choose \"Export block\" as BlocksExchange XML",
        signatures: &[],
        endings: &[".ccm", ".ccp", ".3mx", ".s3c"],
    },
    UnreadFormat {
        name: "a database of COLMAP or another program",
        advice: "it holds features; add cameras and images of the model (.bin, or .txt of colmap model_converter)",
        signatures: &[&["SQLite format 3"]],
        endings: &["database.db"],
    },
    UnreadFormat {
        name: "an OpenMVS scene",
        advice: "add the orientation that it was made from",
        signatures: &[],
        endings: &[".mvs"],
    },
    UnreadFormat {
        name: "OpenDroneMap's list of places before the adjustment",
        advice: "add opensfm/reconstruction.json or odm_report/shots.geojson of the finished project",
        signatures: &[],
        endings: &["geo.txt"],
    },
    UnreadFormat {
        name: "a KML file",
        advice: PLACES,
        signatures: &[&["<kml"]],
        endings: &[".kml"],
    },
    UnreadFormat {
        name: "a GPX track",
        advice: PLACES,
        signatures: &[&["<gpx"]],
        endings: &[".gpx"],
    },
    UnreadFormat {
        name: "a list of exposure times",
        advice: PLACES,
        signatures: &[],
        endings: &[".mrk", ".obs", ".rtk"],
    },
    UnreadFormat {
        name: "a ROS recording",
        advice: "write its poses as JSON with K, R and C of each image",
        signatures: &[&["#ROSBAG"]],
        endings: &[".bag", ".db3", ".mcap"],
    },
    UnreadFormat {
        name: "a calibration of ROS or OpenCV, without poses",
        advice: "write poses and calibration as JSON with K, R and C of each image",
        signatures: &[&["camera_matrix:", "distortion_coefficients:"]],
        endings: &[],
    },
    UnreadFormat {
        name: "rational polynomials of a satellite image",
        advice: "only perspective cameras are read",
        signatures: &[&["LINE_NUM_COEFF"], &["lineNumCoef"]],
        endings: &[".rpb"],
    },
    UnreadFormat {
        name: "a SOCET support file",
        advice: "export the exterior orientation as a list `image X0 Y0 Z0 omega phi kappa` or as PAT-B, and add a camera file",
        signatures: &[],
        endings: &[".sup"],
    },
    UnreadFormat {
        name: "an IMAGINE Photogrammetry (LPS) block",
        advice: "export the exterior orientation as a list `image X0 Y0 Z0 omega phi kappa` or as PAT-B, and add a camera file",
        signatures: &[],
        endings: &[".blk"],
    },
    UnreadFormat {
        name: "a project of a digital photogrammetric workstation",
        advice: "export the exterior orientation as a list `image X0 Y0 Z0 omega phi kappa` or as PAT-B, and add a camera file",
        signatures: &[],
        endings: &[".dpw", ".psprj"],
    },
    UnreadFormat {
        name: "an INPHO block of strips",
        advice: "add the project (.prj) with the exterior orientations of the photos",
        signatures: &[],
        endings: &[".strips", ".strip"],
    },
];

/// The format by the beginning of the content, as bytes are in UTF-8.
pub(crate) fn by_content(head: &str) -> Option<&'static UnreadFormat> {
    let holds = |group: &&[&str]| group.iter().all(|word| head.contains(word));
    (UNREAD.iter()).find(|format| format.signatures.iter().any(holds))
}

/// The format by a name that programs give to such files alone.
pub(crate) fn by_whole_name(file: &InputFile) -> Option<&'static UnreadFormat> {
    let name = file.name().to_lowercase();
    (UNREAD.iter()).find(|format| format.endings.contains(&&*name))
}

/// The format by the name of a file.
pub(crate) fn by_name(file: &InputFile) -> Option<&'static UnreadFormat> {
    let name = file.name().to_lowercase();
    // Metashape packs a project as one archive, which is unpacked like any other.
    let folder = format!("/{}", file.path.to_lowercase());
    (UNREAD.iter()).find(|format| {
        let ends = |ending: &&str| match ending.starts_with('.') {
            true => name.ends_with(ending) || *ending == ".psz" && folder.contains(".psz/"),
            false => name == *ending,
        };
        format.endings.iter().any(ends)
    })
}

/// The format of a file.
pub(crate) fn of(file: &InputFile) -> Option<&'static UnreadFormat> {
    let head = &file.bytes[..file.bytes.len().min(HEAD_BYTES)];
    let text = file.start_as_text(HEAD_BYTES);
    let text = text.unwrap_or_else(|| String::from_utf8_lossy(head));
    by_content(&text).or_else(|| by_name(file))
}

#[cfg(test)]
mod tests {
    use super::super::detect::{FileKind, detect};
    use super::*;

    #[test]
    fn formats_that_are_not_read_are_known_by_content_or_name() {
        for (path, content, name) in [
            (
                "a.json",
                "{\"sfm_data_version\": \"0.3\", \"views\": []}",
                "OpenMVG",
            ),
            (
                "a.json",
                "{\"views\": [{\"viewId\": \"1\", \"poseId\": \"1\", \"intrinsicId\": \"2\"}]}",
                "AliceVision",
            ),
            (
                "project.opf",
                "{\"format\": \"application/opf-project+json\"}",
                "OPF",
            ),
            (
                "a.csv",
                "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\na.jpg,0,0,9,1,2,3,4,5,6,7,8,9,0,1,2\n",
                "RealityCapture",
            ),
            (
                "a.psx",
                "<document version=\"1.2.0\" path=\"{projectname}.files/project.zip\"/>",
                "Metashape",
            ),
            ("a.psz/doc.xml", "<document/>", "Metashape"),
            ("a.p4d", "<pix4d/>", "Pix4Dmapper"),
            ("database.db", "SQLite format 3\0", "COLMAP"),
            (
                "flight.kml",
                "<?xml version=\"1.0\"?><kml xmlns=\"x\">",
                "KML",
            ),
            ("a_Timestamp.MRK", "1\t2.5\t[2000]\n", "exposure"),
            ("geo.txt", "EPSG:32632\na.jpg 1 2 3 4 5 6\n", "OpenDroneMap"),
            ("block.abc", "Ogawa\u{ff}\0", "Alembic"),
        ] {
            let file = InputFile::new(path, content.as_bytes().to_vec());
            assert_eq!(detect(&file), FileKind::Unread, "{path}");
            assert!(of(&file).unwrap().name.contains(name), "{path}");
        }
        let other = InputFile::new("a.txt", b"sfm".to_vec());
        assert_eq!(detect(&other), FileKind::Ignored);
        for format in &UNREAD {
            assert!(!format.signatures.is_empty() || !format.endings.is_empty());
            assert!(!format.advice.contains("; ") || format.advice.matches("; ").count() == 1);
        }
    }
}
