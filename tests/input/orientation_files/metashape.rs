//! Metashape, PhotoScan, MeshLab.

use nalgebra::Point2;

use super::{Found, k, near, read, refusal, replaced, truth};

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
        found.orientations[3].source.contains("line 12"),
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
