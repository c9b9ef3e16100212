//! Orientation files as their programs write them beyond the plain case: what newer and older
//! versions write, what several chunks and blocks say, and names that lead nowhere.
//!
//! The files in `tests/fixtures/cases` hold the three cameras of [`truth`].
#![cfg(not(target_arch = "wasm32"))]

use std::io::Cursor;

use nalgebra::{Matrix3, Point2, Point3, Vector3};
use ridgeline::orientation::{
    InputFile, Orientation, StatedReference, detect, orientation_sets,
    rotation_from_omega_phi_kappa,
};
use ridgeline::scene_loader::{LoadOptions, inspect_files, load_scene};

macro_rules! case {
    ($path:literal) => {
        ($path, include_str!(concat!("fixtures/cases/", $path)))
    };
}

/// Rotation and centre of the cameras a, b, c.
fn truth(i: usize) -> (Matrix3<f64>, Point3<f64>) {
    let (angles, center) = [
        ([4.0, -3.0, 70.0], Point3::new(12.5, -31.25, 143.75)),
        ([-2.0, 5.0, 68.0], Point3::new(42.5, -21.25, 141.25)),
        ([1.0, -6.0, -110.0], Point3::new(27.5, 11.25, 146.5)),
    ][i];
    let [omega, phi, kappa] = angles.map(f64::to_radians);
    let r = rotation_from_omega_phi_kappa(omega, phi, kappa);
    (r.into_inner(), center)
}

fn k(fx: f64, skew: f64, fy: f64, cx: f64, cy: f64) -> Matrix3<f64> {
    Matrix3::new(fx, skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0)
}

/// The orientations of the preferred set, its warnings, and what it says of its system.
struct Found {
    orientations: Vec<Orientation>,
    warnings: Vec<String>,
    reference: StatedReference,
}

fn read(files: &[(&str, &str)]) -> Result<Found, String> {
    let inputs: Vec<InputFile> = files
        .iter()
        .map(|(path, text)| InputFile::new(path, text.as_bytes().to_vec()))
        .collect();
    let kinds: Vec<_> = inputs.iter().map(detect).collect();
    let (sets, _) = orientation_sets(&inputs, &kinds);
    let set = sets.first().ok_or("no set")?;
    let mut warnings = Vec::new();
    let orientations = set
        .read(&inputs, &mut warnings)
        .map_err(|e| e.to_string())?;
    Ok(Found {
        orientations,
        warnings,
        reference: set.reference(&inputs, None),
    })
}

fn refusal(files: &[(&str, &str)], words: &[&str]) {
    let message = read(files).err().expect("it must be refused");
    assert!(message.starts_with(files[0].0), "{message}");
    assert!(!message.contains("export it again"), "{message}");
    for word in words {
        assert!(message.contains(word), "{message}\nlacks: {word}");
    }
}

impl Found {
    fn names(&self) -> Vec<&str> {
        self.orientations.iter().map(|o| &*o.image).collect()
    }

    /// The camera stands where the truth has it, moved by an offset.
    fn stands(&self, at: usize, i: usize, offset: [f64; 3]) -> &Orientation {
        let (r, center) = truth(i);
        let found = &self.orientations[at];
        let moved = center + Vector3::from(offset);
        assert!((found.r - r).norm() < 1e-9, "{}{r}", found.r);
        assert!((found.center - moved).norm() < 1e-7, "{}", found.center);
        found
    }

    fn warns(&self, words: &[&str]) {
        let fits = |w: &&String| words.iter().all(|word| w.contains(word));
        assert!(
            self.warnings.iter().any(|w| fits(&w)),
            "{:?}",
            self.warnings
        );
    }
}

fn replaced((path, text): (&'static str, &str), from: &str, to: &str) -> (&'static str, String) {
    assert!(text.contains(from), "{path} holds {from}");
    (path, text.replace(from, to))
}

fn near(found: &Matrix3<f64>, expected: &Matrix3<f64>) {
    assert!((found - expected).norm() < 1e-9, "{found}{expected}");
}

/// Three images of 16 x 12 pixels, which show nothing.
fn images() -> Vec<InputFile> {
    let mut png = Cursor::new(Vec::new());
    image::RgbImage::from_pixel(16, 12, image::Rgb([90, 90, 90]))
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("memory takes all");
    ["a.png", "b.png", "c.png"]
        .map(|name| InputFile::new(name, png.get_ref().clone()))
        .to_vec()
}

const COMPONENTS: (&str, &str) = case!("metashape_components/cameras.xml");

#[test]
fn a_component_of_metashape_leads_to_the_world() {
    let found = read(&[COMPONENTS]).unwrap();
    assert_eq!(found.names(), ["a", "b", "c"]);
    for i in 0..3 {
        // The adjusted calibration, not the one it began with.
        let camera = found.stands(i, i, [0.0; 3]);
        near(&camera.k, &k(900.0, 0.0, 900.0, 8.25, 5.5));
        assert_eq!((camera.size, &camera.group), (Some((16, 12)), &None));
    }
    found.warns(&["disabled", "off"]);
    assert_eq!(found.warnings.len(), 1, "{:?}", found.warnings);
}

#[test]
fn a_component_without_transform_is_not_mixed_with_others() {
    let text = COMPONENTS.1;
    // Of both components.
    let strip = |text: &str, which: usize| {
        let at = text
            .match_indices("<transform><rotation")
            .nth(which)
            .unwrap()
            .0;
        let end = at + text[at..].find("</transform>").unwrap() + "</transform>".len();
        format!("{}{}", &text[..at], &text[end..])
    };
    // Component 2, and the chunk's own, which would serve for it.
    let one = strip(&strip(text, 2), 1);
    let found = read(&[("cameras.xml", &one)]).unwrap();
    assert_eq!(found.names(), ["a", "c"]);
    found.stands(1, 2, [0.0; 3]);
    found.warns(&["not placed together", "b", "Chunk 1"]);
    let none = strip(&one, 0);
    let found = read(&[("cameras.xml", &none)]).unwrap();
    assert_eq!(found.names(), ["a", "c"], "those of the active component");
    found.warns(&["states no transform", "need not be metres"]);
    // The chunk's transform serves all that have none of their own.
    let of_chunk = strip(&strip(text, 1), 0);
    let found = read(&[("cameras.xml", &of_chunk)]).unwrap();
    assert_eq!(found.names(), ["a", "b", "c"]);
    assert!((found.orientations[0].center - truth(0).1).norm() > 1.0);
}

#[test]
fn what_a_metashape_camera_names_must_be_there() {
    let (path, component) = replaced(
        COMPONENTS,
        "label=\"a\" component_id=\"0\"",
        "label=\"a\" component_id=\"7\"",
    );
    refusal(
        &[(path, &component)],
        &["line 15", "component \"7\"", "<component>"],
    );
    let (path, sensor) = replaced(
        COMPONENTS,
        "sensor_id=\"0\" label=\"b\"",
        "sensor_id=\"5\" label=\"b\"",
    );
    refusal(&[(path, &sensor)], &["line 16", "sensor \"5\""]);
    // A lens that is not read leaves out its cameras where there are others, and is refused alone.
    let (path, panorama) = replaced(
        COMPONENTS,
        "sensor_id=\"0\" label=\"b\"",
        "sensor_id=\"1\" label=\"b\"",
    );
    let panorama = panorama.replace(
        "<resolution width=\"64\" height=\"32\"/>",
        "<calibration type=\"spherical\"/>",
    );
    let found = read(&[(path, &panorama)]).unwrap();
    assert_eq!(found.names(), ["a", "c"]);
    found.warns(&["line 8", "spherical", "left out: b"]);
    let all = panorama.replace("sensor_id=\"0\"", "sensor_id=\"1\"");
    refusal(&[(path, &all)], &["line 8", "spherical"]);
}

#[test]
fn the_chunk_in_use_comes_last() {
    const CHUNKS: (&str, &str) = case!("metashape_chunks/cameras.xml");
    let groups = |found: &Found| -> Vec<String> {
        let groups = found.orientations.iter().map(|o| o.group.clone().unwrap());
        groups.collect()
    };
    let found = read(&[CHUNKS]).unwrap();
    assert_eq!(groups(&found), ["copy", "copy", "in use", "in use"]);
    found.stands(3, 1, [0.0; 3]);
    // Of two enabled ones the active one; of the same label both are kept apart.
    let (path, text) = replaced(CHUNKS, "enabled=\"false\"", "enabled=\"true\" id=\"1\"");
    let text = text
        .replace("enabled=\"true\">", "enabled=\"true\" id=\"0\">")
        .replace(
            "<document version=\"1.5.0\">",
            "<document version=\"1.5.0\"><chunks active_id=\"0\"/>",
        )
        .replace("label=\"copy\"", "label=\"in use\"");
    let found = read(&[(path, &text)]).unwrap();
    let groups = groups(&found);
    assert_ne!(groups[0], groups[3]);
    assert!(
        found.orientations[3].source.contains("line 10"),
        "{}",
        found.orientations[3].source
    );
}

#[test]
fn photoscan_and_meshlab_count_the_principal_point_from_the_corner() {
    const OLD: (&str, &str) = case!("metashape_old/cameras.xml");
    let found = read(&[OLD]).unwrap();
    let camera = found.stands(0, 0, [0.0; 3]);
    near(&camera.k, &k(900.0, 0.5, 910.0, 8.25, 5.5));
    found.warns(&["no transform", "chunk 1"]);
    // x' = x (1 + k1 r2) + p2 (r2 + 2 x2) + 2 p1 x y, and p1, p2 exchanged in y'.
    let (x, y, k1, p1, p2) = (0.21, -0.13, -0.05, 0.002, -0.001);
    let r2: f64 = x * x + y * y;
    let expected = Point2::new(
        x * (1.0 + k1 * r2) + p2 * (r2 + 2.0 * x * x) + 2.0 * p1 * x * y,
        y * (1.0 + k1 * r2) + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
    );
    let put = camera.distortion.unwrap().distort(&Point2::new(x, y));
    assert!((put - expected).norm() < 1e-12);
    // A calibration of the sensor at twice the resolution of the photos, and of another shape.
    let size = "class=\"adjusted\"><resolution width=\"16\" height=\"12\"/>";
    let larger = replaced(OLD, size, &size.replace("16", "32").replace("12", "24"));
    let found = read(&[(larger.0, &larger.1)]).unwrap();
    near(
        &found.orientations[0].k,
        &k(450.0, 0.25, 455.0, 4.125, 2.75),
    );
    assert_eq!(found.orientations[0].size, Some((16, 12)));
    let square = replaced(OLD, size, &size.replace("16", "12"));
    refusal(&[(square.0, &square.1)], &["16 x 12", "12 x 12"]);
}

#[test]
fn a_slave_of_a_rig_stands_beside_its_master() {
    let rig = |offset: &str| {
        let slave =
            "<camera id=\"8\" sensor_id=\"8\" master_id=\"0\" component_id=\"0\" label=\"slave\"/>";
        let (_, text) = replaced(
            COMPONENTS,
            "<camera id=\"5\"",
            &format!("{slave}<camera id=\"5\""),
        );
        let sensor = format!(
            "<sensor id=\"8\" master_id=\"0\" type=\"frame\"><calibration><resolution width=\"16\" height=\"12\"/><f>900</f></calibration>{offset}</sensor></sensors>"
        );
        text.replace("</sensors>", &sensor)
    };
    // The slave's x is the master's y, and it stands 2 m to the right of it.
    let stated = rig("<rotation>0 -1 0 1 0 0 0 0 1</rotation><location>2 0 0</location>");
    let found = read(&[("cameras.xml", &stated)]).unwrap();
    let (r, center) = truth(0);
    let slave = found
        .orientations
        .iter()
        .find(|o| o.image == "slave")
        .unwrap();
    assert!((slave.center - (center + r.row(0).transpose() * 2.0)).norm() < 1e-9);
    assert!((slave.r.row(0) - r.row(1)).norm() < 1e-9, "{}", slave.r);
    assert!((slave.r.row(2) - r.row(2)).norm() < 1e-9, "{}", slave.r);
    found.warns(&["1 cameras of a rig"]);
    let found = read(&[("cameras.xml", &rig(""))]).unwrap();
    assert_eq!(found.names(), ["a", "b", "c"]);
    found.warns(&["no rotation and location", "slave"]);
}

const BLOCKS: (&str, &str) = case!("blocks/block.xml");

#[test]
fn a_block_stands_in_the_system_that_it_names() {
    let found = read(&[BLOCKS]).unwrap();
    assert_eq!(found.names(), ["a.jpg", "b.jpg", "a.jpg", "b.jpg", "c.jpg"]);
    let groups: Vec<_> = found
        .orientations
        .iter()
        .map(|o| o.group.as_deref().unwrap())
        .collect();
    assert_eq!(groups[..2], ["Block_1"; 2]);
    assert_eq!(groups[2..], ["Block_1 - AT"; 3]);
    found.stands(0, 0, [500.0; 3]);
    let camera = found.stands(4, 2, [0.0; 3]);
    near(&camera.k, &k(900.0, 0.0, 900.0, 8.25, 5.5));
    found.warns(&["component 0", "gps.jpg"]);
    let StatedReference::Place(place) = found.reference else {
        panic!("{:?}", found.reference);
    };
    assert_eq!(
        (place.lat_deg, place.lon_deg, place.height_m),
        (50.1, 14.5, 0.0)
    );
    // The other block, by its label.
    let inputs = [InputFile::new(BLOCKS.0, BLOCKS.1.as_bytes().to_vec())];
    let (sets, _) = orientation_sets(&inputs, &[detect(&inputs[0])]);
    let other = sets[0].reference(&inputs, Some("Block_1"));
    assert_eq!(other, StatedReference::System(25833));
}

#[test]
fn a_block_without_a_system_that_is_known_has_none() {
    let reference = |from: &str, to: &str| {
        let (path, text) = replaced(BLOCKS, from, to);
        read(&[(path, &text)])
    };
    let local = reference("<SRSId>2</SRSId>", "").unwrap().reference;
    assert!(matches!(local, StatedReference::Local(_)), "{local:?}");
    let absent = reference("<SRSId>2</SRSId>", "<SRSId>7</SRSId>").unwrap();
    assert!(matches!(absent.reference, StatedReference::Local(_)));
    absent.warns(&["reference system 7", "not in the file"]);
    // A photogroup may name its own; then it must be that of the whole block.
    let group = |id: &str| format!("<SRSId>{id}</SRSId><Name>Photogroup 1</Name>");
    let own = reference("<Name>Photogroup 1</Name>", &group("1"))
        .unwrap()
        .reference;
    assert_eq!(own, StatedReference::System(25833));
    let (path, text) = replaced(
        BLOCKS,
        "    <Photo><Id>1<",
        "   </Photogroup><Photogroup><SRSId>0</SRSId>    <Photo><Id>1<",
    );
    refusal(
        &[(path, &text)],
        &["another reference system", "one <SRSId>"],
    );
}

#[test]
fn all_eight_orientations_of_a_camera_are_read() {
    let directions = [
        ("Right", Vector3::x()),
        ("Left", -Vector3::x()),
        ("Down", Vector3::y()),
        ("Up", -Vector3::y()),
    ];
    let (r, center) = truth(0);
    let mut count = 0;
    for (x_name, x) in directions {
        for (y_name, y) in directions.iter().filter(|(_, y)| x.dot(y) == 0.0) {
            // What the camera calls x is x of the image, and so on: rows of the file's matrix.
            let rows =
                Matrix3::from_rows(&[x.transpose(), y.transpose(), x.cross(y).transpose()]) * r;
            let mm = |v: &Vector3<f64>| 0.01 * (v.x * 0.25 + v.y * -0.5);
            let text = block_of(
                &format!(
                    "<PixelSize>0.01</PixelSize><FocalLength>9</FocalLength><CameraOrientation>X{x_name}Y{y_name}</CameraOrientation>\
                     <PrincipalPoint><xmm>{}</xmm><ymm>{}</ymm></PrincipalPoint>",
                    mm(&x),
                    mm(y)
                ),
                &matrix_elements(&rows),
                &center,
            );
            let found = read(&[("block.xml", &text)]).unwrap();
            let camera = found.stands(0, 0, [0.0; 3]);
            near(&camera.k, &k(900.0, 0.0, 900.0, 8.25, 5.5));
            count += 1;
        }
    }
    assert_eq!(count, 8);
    let unknown = |name: &str| {
        let group = format!(
            "<FocalLengthPixels>900</FocalLengthPixels><CameraOrientation>{name}</CameraOrientation>"
        );
        let text = block_of(&group, &matrix_elements(&r), &center);
        refusal(
            &[("block.xml", &text)],
            &[&format!("\"{name}\""), "XDownYLeft"],
        );
    };
    for name in ["XRightYLeft", "YUpXRight", "XNorthYDown"] {
        unknown(name);
    }
}

/// A block of one photo of 16 x 12 pixels.
fn block_of(group: &str, rotation: &str, center: &Point3<f64>) -> String {
    format!(
        "<BlocksExchange version=\"2.1\"><Block><Photogroups><Photogroup>\n\
         <ImageDimensions><Width>16</Width><Height>12</Height></ImageDimensions>{group}\n\
         <Photo><Id>0</Id><ImagePath>a.jpg</ImagePath><Pose><Rotation>{rotation}</Rotation>\
         <Center><x>{}</x><y>{}</y><z>{}</z></Center></Pose></Photo>\n\
         </Photogroup></Photogroups></Block></BlocksExchange>",
        center.x, center.y, center.z
    )
}

fn matrix_elements(m: &Matrix3<f64>) -> String {
    let at = |i: usize, j: usize| format!("<M_{i}{j}>{}</M_{i}{j}>", m[(i, j)]);
    (0..9).map(|n| at(n / 3, n % 3)).collect()
}

#[test]
fn the_forms_of_a_block_that_its_description_allows() {
    let center = truth(0).1;
    // World to camera of the example in the format's description: 179.6523, 0.0499, 179.9065.
    let example = Matrix3::new(
        -0.999998291223340,
        -0.001636319085375301,
        -0.0008602425863163225,
        -0.001631068695467463,
        0.9999802528616577,
        -0.00606906089589293,
        0.0008701565192966738,
        -0.006067647409696231,
        -0.9999812130648239,
    );
    let angles = "<Omega>179.6523471469934</Omega><Phi>0.04985630236313049</Phi><Kappa>179.9065465708369</Kappa>";
    let group =
        "<FocalLengthPixels>900</FocalLengthPixels><AspectRatio>1.01</AspectRatio><Skew>0.5</Skew>";
    let found = read(&[("block.xml", &block_of(group, angles, &center))]).unwrap();
    assert!((found.orientations[0].r - example).norm() < 1e-9);
    near(&found.orientations[0].k, &k(900.0, 0.5, 909.0, 8.0, 6.0));
    assert_eq!(found.reference, StatedReference::None);
    let refused = |group: &str, rotation: &str, words: &[&str]| {
        refusal(&[("block.xml", &block_of(group, rotation, &center))], words);
    };
    let matrix = matrix_elements(&example);
    refused(
        group,
        "<Yaw>1</Yaw><Pitch>2</Pitch><Roll>3</Roll>",
        &["line 3", "<Yaw>", "M_00"],
    );
    refused(
        "<CameraModelType>Fisheye</CameraModelType>",
        &matrix,
        &["\"Fisheye\"", "line 1"],
    );
    refused(
        "<FocalLength>9</FocalLength>",
        &matrix,
        &["<SensorSize> or <PixelSize>"],
    );
    let lens = |term: &str| format!("{group}<Distortion><K1>0.1</K1>{term}</Distortion>");
    refused(&lens("<K4>0.1</K4>"), &matrix, &["<K4>", "not read"]);
    assert!(
        read(&[(
            "block.xml",
            &block_of(&lens("<K4>0</K4>"), &matrix, &center)
        )])
        .is_ok()
    );
}

const PARAMETERS: (&str, &str) =
    case!("pix4d_offset/params/house_calibrated_camera_parameters.txt");
const OFFSET: (&str, &str) = case!("pix4d_offset/params/house_offset.xyz");
const OTHER_OFFSET: (&str, &str) = case!("pix4d_offset/params/barn_offset.xyz");
const WELL_KNOWN: (&str, &str) = case!("pix4d_offset/params/house_wkt.prj");

#[test]
fn the_offset_of_pix4d_belongs_to_all_of_its_files() {
    let offset = [432_000.0, 5_412_000.0, 100.0];
    let found = read(&[PARAMETERS, OTHER_OFFSET, OFFSET]).unwrap();
    for i in 0..3 {
        found.stands(i, i, offset);
    }
    assert_eq!(found.reference, StatedReference::None);
    // In a folder of its own it serves where it is the only one.
    let elsewhere = ("house_offset.xyz", OFFSET.1);
    read(&[PARAMETERS, elsewhere]).unwrap().stands(1, 1, offset);
    let without = read(&[PARAMETERS, elsewhere, ("x/barn_offset.xyz", OTHER_OFFSET.1)]).unwrap();
    without.stands(0, 0, [0.0; 3]);
    assert!(matches!(without.reference, StatedReference::Local(_)));
}

#[test]
fn no_system_is_stated_for_coordinates_that_are_not_in_it() {
    let with = |texts: &[(&str, &str)]| {
        let mut files = images();
        files.extend(
            texts
                .iter()
                .map(|(p, t)| InputFile::new(p, t.as_bytes().to_vec())),
        );
        let scene = load_scene(&files, &LoadOptions::default()).unwrap();
        (
            scene.survey,
            inspect_files(&files, &LoadOptions::default()).warnings,
        )
    };
    let (survey, warnings) = with(&[PARAMETERS, WELL_KNOWN, OFFSET]);
    assert_eq!((survey.epsg, survey.anchor), (Some(25832), None));
    assert!(
        !warnings.iter().any(|w| w.contains("25832")),
        "{warnings:?}"
    );
    let (survey, warnings) = with(&[PARAMETERS, WELL_KNOWN]);
    assert_eq!((survey.epsg, survey.anchor), (None, None));
    let says =
        |w: &String| w.contains("house_wkt.prj names EPSG:25832") && w.contains("_offset.xyz");
    assert!(warnings.iter().any(says), "{warnings:?}");
    // East, north and up from a place are no map coordinates either. Here the last block alone.
    let blocks = replaced(
        BLOCKS,
        "<Block><Name>Block_1</Name><SRSId>1</SRSId>",
        "<Block_1>",
    );
    let blocks = blocks.1.replacen("</Block>", "</Block_1>", 1);
    let (survey, warnings) = with(&[("block.xml", &blocks), WELL_KNOWN]);
    assert_eq!(
        (survey.epsg, survey.anchor.map(|a| a.lat_deg)),
        (None, Some(50.1))
    );
    assert!(
        warnings.iter().any(|w| w.contains("names EPSG:25832")),
        "{warnings:?}"
    );
}

const SHOTS: (&str, &str) = case!("odm_shots/odm_report/shots.geojson");
const CAMERAS: (&str, &str) = case!("odm_shots/cameras.json");

#[test]
fn a_shot_finds_its_camera_under_the_name_that_odm_gives_it() {
    // OpenSfM's camera_models.json holds what the adjustment began with.
    let models = case!("odm_shots/opensfm/camera_models.json");
    let found = read(&[models, SHOTS, CAMERAS]).unwrap();
    assert_eq!(found.names(), ["a.jpg", "b.jpg"]);
    let expected = k(900.0, 0.0, 900.0, 8.25, 5.5);
    for i in 0..2 {
        let camera = found.stands(i, i, [0.0; 3]);
        near(&camera.k, &expected);
        assert_eq!(camera.distortion.unwrap().radial[0], -0.02);
    }
    assert_eq!(found.warnings, [""; 0]);
    // The other way round as well.
    let long = replaced(CAMERAS, "\"maker", "\"v2 maker");
    let bare = replaced(SHOTS, "v2 maker", "maker");
    let found = read(&[(bare.0, &bare.1), (long.0, &long.1)]).unwrap();
    near(&found.stands(1, 1, [0.0; 3]).k, &expected);
}

#[test]
fn a_camera_that_a_shot_names_must_be_there() {
    let other = replaced(CAMERAS, "\"maker", "\"other maker");
    let message = read(&[SHOTS, (other.0, &other.1)]).err().unwrap();
    assert!(message.starts_with(CAMERAS.0), "{message}");
    for word in ["a.jpg", "v2 maker model", "not in it", "other maker model"] {
        assert!(message.contains(word), "{message}");
    }
    // A shot of an older version names none: size and focal length tell which it was.
    let unnamed = replaced(SHOTS, "\"camera\": \"v2 maker model 16 12 brown 1.2\",", "");
    let found = read(&[(unnamed.0, &unnamed.1), CAMERAS]).unwrap();
    near(
        &found.stands(0, 0, [0.0; 3]).k,
        &k(900.0, 0.0, 900.0, 8.25, 5.5),
    );
    found.warns(&["2 shots name no camera", "maker model"]);
    let focal = replaced(CAMERAS, "\"focal_x\": 56.25", "\"focal_x\": 56.5");
    let message = read(&[(unnamed.0, &unnamed.1), (focal.0, &focal.1)])
        .err()
        .unwrap();
    assert!(
        message.contains("none has its size and focal length"),
        "{message}"
    );
    // Without any cameras the lens is a guess, and one that the shot must allow.
    let found = read(&[SHOTS]).unwrap();
    found.warns(&["no cameras.json"]);
    let blind = replaced(SHOTS, "\"focal\": 56.25", "\"focal\": null");
    refusal(&[(blind.0, &blind.1)], &["a.jpg", "no focal length"]);
    // A shot by a lens that is not read is left out; alone it is refused.
    let panorama = SHOTS
        .1
        .replacen("v2 maker model 16 12 brown 1.2", "panorama 64 32", 1);
    let found = read(&[(SHOTS.0, &panorama), CAMERAS]).unwrap();
    assert_eq!(found.names(), ["b.jpg"]);
    found.warns(&["equirectangular", "left out: a.jpg"]);
}

#[test]
fn the_largest_reconstruction_of_opensfm_comes_last_with_its_place() {
    let models = case!("opensfm_models/reconstruction.json");
    let found = read(&[models]).unwrap();
    assert_eq!(found.names(), ["c.jpg", "a.jpg", "b.jpg"]);
    let groups: Vec<_> = found
        .orientations
        .iter()
        .map(|o| o.group.as_deref().unwrap())
        .collect();
    assert_eq!(
        groups,
        ["reconstruction 2", "reconstruction 1", "reconstruction 1"]
    );
    found.stands(0, 2, [7.0; 3]);
    near(
        &found.stands(1, 0, [0.0; 3]).k,
        &k(900.0, 0.0, 900.0, 8.25, 5.5),
    );
    let lat = |reference: StatedReference| match reference {
        StatedReference::Place(place) => place.lat_deg,
        other => panic!("{other:?}"),
    };
    assert_eq!(lat(found.reference), 50.1);
    // The place stood in a file of its own before.
    let place = case!("opensfm_place/reference_lla.json");
    let old = read(&[case!("opensfm_place/reconstruction.json"), place]).unwrap();
    assert_eq!(lat(old.reference), 50.3);
    let unknown = replaced(
        models,
        "\"camera\": \"v2 maker model\"",
        "\"camera\": \"maker\"",
    );
    refusal(
        &[(unknown.0, &unknown.1)],
        &["\"maker\"", "not in it", "v2 maker model"],
    );
}

#[test]
fn what_nerfstudio_applied_is_undone() {
    let transforms = case!("nerfstudio_scale/transforms.json");
    let found = read(&[transforms]).unwrap();
    near(
        &found.stands(0, 0, [0.0; 3]).k,
        &k(900.0, 0.0, 900.0, 8.25, 5.5),
    );
    let second = found.stands(1, 1, [0.0; 3]);
    near(&second.k, &k(910.0, 0.0, 920.0, 8.0, 6.0));
    assert_eq!(second.distortion.unwrap().radial[0], -0.03);
    assert_eq!(second.image, "./images/b", "the extension may be missing");
    let model = |name: &str| replaced(transforms, "\"OPENCV\"", &format!("\"{name}\""));
    for name in ["SIMPLE_RADIAL", "pinhole"] {
        assert!(read(&[(transforms.0, &model(name).1)]).is_ok());
    }
    refusal(
        &[(transforms.0, &model("ORTHOPHOTO").1)],
        &["./images/a", "\"ORTHOPHOTO\""],
    );
    let scale = |value: &str| {
        replaced(
            transforms,
            "\"applied_scale\": 0.05",
            &format!("\"applied_scale\": {value}"),
        )
    };
    refusal(&[(transforms.0, &scale("0.0").1)], &["applied_scale is 0"]);
    refusal(&[(transforms.0, &scale("-1").1)], &["applied_scale is -1"]);
    // One lens of several: the others are read.
    let one = transforms.1.replacen(
        "\"fl_x\": 900",
        "\"camera_model\": \"EQUIRECTANGULAR\", \"fl_x\": 900",
        1,
    );
    let found = read(&[(transforms.0, &one)]).unwrap();
    assert_eq!(found.names(), ["./images/b"]);
    found.warns(&["EQUIRECTANGULAR", "left out: ./images/a"]);
}

#[test]
fn a_guess_of_the_other_readers_is_named() {
    let bundle = ("bundle.out", include_str!("fixtures/bundler/bundle.out"));
    let list = ("list.txt", include_str!("fixtures/bundler/list.txt"));
    let points = include_str!("fixtures/bundler/principal_points.txt");
    let whole = read(&[bundle, list, ("principal_points.txt", points)]).unwrap();
    assert_eq!(whole.warnings, [""; 0]);
    let less: Vec<&str> = points.lines().filter(|l| !l.starts_with("s1_02")).collect();
    let less = read(&[bundle, list, ("principal_points.txt", &less.join("\n"))]).unwrap();
    less.warns(&["principal_points.txt", "s1_02", "in the middle"]);
    // A photo of INPHO that names a camera is not given another one.
    let project = ("gable.prj", include_str!("fixtures/inpho/gable.prj"));
    let first = project.1.find("$CAMERA_ID").unwrap();
    let line = project.1[first..].lines().next().unwrap();
    let (path, other) = replaced(project, line, "$CAMERA_ID : nowhere");
    refusal(&[(path, &other)], &["its camera nowhere is missing"]);
}

#[test]
fn of_calibrations_of_the_same_name_the_one_beside_is_taken() {
    let pose = (
        "Ori-A/Orientation-s1_02.png.xml",
        include_str!("fixtures/micmac/Orientation-s1_02.png.xml"),
    );
    let lens = include_str!("fixtures/micmac/AutoCal_s1_02.png.xml");
    let (_, other) = replaced(("", lens), "<F>15294", "<F>20000");
    let beside = ("Ori-A/AutoCal_s1_02.png.xml", lens);
    let elsewhere = ("Ori-B/AutoCal_s1_02.png.xml", &*other);
    for files in [[pose, beside, elsewhere], [elsewhere, beside, pose]] {
        let focal = read(&files).unwrap().orientations[0].k[(0, 0)];
        assert!((focal - 15294.0).abs() < 1.0, "{focal}");
    }
}
