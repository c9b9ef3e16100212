//! Pix4D, OpenSfM, ODM, nerfstudio, Bundler, INPHO, MicMac.

use ridgeline::orienting::orientation::{InputFile, StatedReference};
use ridgeline::orienting::scene_loader::{LoadOptions, inspect_files, load_scene};

use super::blocks::BLOCKS;
use super::{images, k, near, read, refusal, replaced};

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
    // Wide angles, so that the views overlap.
    let wide = replaced(PARAMETERS, "900 0 8.25\n0 900 5.5", "9 0 8.25\n0 9 5.5");
    let wide = (wide.0, &*wide.1);
    let (survey, warnings) = with(&[wide, WELL_KNOWN, OFFSET]);
    assert_eq!((survey.epsg, survey.anchor), (Some(25832), None));
    assert!(
        !warnings.iter().any(|w| w.contains("25832")),
        "{warnings:?}"
    );
    let (survey, warnings) = with(&[wide, WELL_KNOWN]);
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
    let blocks = (blocks.1)
        .replacen("</Block>", "</Block_1>", 1)
        .replace("<FocalLength>9<", "<FocalLength>0.09<");
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
    // Angle and size make a focal length; the size may be that of the image alone.
    let mut files = super::images();
    let names: Vec<String> = files.iter().map(|file| file.path.clone()).collect();
    let frames: Vec<String> = (names.iter())
        .map(|name| format!("{{\"file_path\": \"./{name}\", \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,9]]}}"))
        .collect();
    let angle = 2.0 * libm::atan(0.5);
    let text = format!(
        "{{\"camera_angle_x\": {angle}, \"frames\": [{}]}}",
        frames.join(",")
    );
    files.push(ridgeline::orienting::orientation::InputFile::new(
        "transforms.json",
        text.into_bytes(),
    ));
    let kinds: Vec<_> = files
        .iter()
        .map(ridgeline::orienting::orientation::detect)
        .collect();
    let (sets, _) = ridgeline::orienting::orientation::orientation_sets(&files, &kinds);
    let found = sets[0].read(&files, &mut Vec::new()).unwrap();
    assert_eq!((found.len(), found[0].size), (3, Some((16, 12))));
    near(&found[0].k, &k(16.0, 0.0, 16.0, 8.0, 6.0));
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
    let bundle = (
        "bundle.out",
        include_str!("../../fixtures/bundler/bundle.out"),
    );
    let list = ("list.txt", include_str!("../../fixtures/bundler/list.txt"));
    let points = include_str!("../../fixtures/bundler/principal_points.txt");
    let whole = read(&[bundle, list, ("principal_points.txt", points)]).unwrap();
    assert_eq!(whole.warnings, [""; 0]);
    let less: Vec<&str> = points.lines().filter(|l| !l.starts_with("s1_02")).collect();
    let less = read(&[bundle, list, ("principal_points.txt", &less.join("\n"))]).unwrap();
    less.warns(&["principal_points.txt", "s1_02", "in the middle"]);
    // A photo of INPHO that names a camera is not given another one.
    let project = ("gable.prj", include_str!("../../fixtures/inpho/gable.prj"));
    let cameras: Vec<usize> = (project.1.match_indices("$CAMERA_DEFINITION"))
        .map(|(at, _)| at)
        .collect();
    let photos = project.1.find("$PHOTO\n").unwrap();
    let one = format!("{}{}", &project.1[..cameras[1]], &project.1[photos..]);
    refusal(
        &[(project.0, &one)],
        &["its camera of s1_02.png is missing"],
    );
    let nameless = one.replace("  $ID : of s1_01.png\n", "");
    assert!(read(&[(project.0, &nameless)]).is_ok());
}

#[test]
fn of_calibrations_of_the_same_name_the_one_beside_is_taken() {
    let pose = (
        "Ori-A/Orientation-s1_02.png.xml",
        include_str!("../../fixtures/micmac/Orientation-s1_02.png.xml"),
    );
    let lens = include_str!("../../fixtures/micmac/AutoCal_s1_02.png.xml");
    let (_, other) = replaced(("", lens), "<F>15294", "<F>20000");
    let beside = ("Ori-A/AutoCal_s1_02.png.xml", lens);
    let elsewhere = ("Ori-B/AutoCal_s1_02.png.xml", &*other);
    for files in [[pose, beside, elsewhere], [elsewhere, beside, pose]] {
        let focal = read(&files).unwrap().orientations[0].k[(0, 0)];
        assert!((focal - 15294.0).abs() < 1.0, "{focal}");
    }
}
