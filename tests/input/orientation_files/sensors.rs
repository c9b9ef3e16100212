//! Lenses, pixels that are not square, portraits and places: the terms that plain samples leave at
//! zero.

#![allow(clippy::disallowed_methods)]

use nalgebra::{Matrix3, Point2, Point3};
use ridgeline::orienting::orientation::Orientation;

use super::blocks::{block_of, matrix_elements};
use super::{k, near, read, replaced, truth};

/// Radial k1, k2, k3 and tangential p1, p2.
const LENS: [f64; 5] = [-0.05, 0.02, -0.006, 0.002, -0.001];

/// Does the camera have the planted lens? In x, p2 is the factor of r2 + 2 x2; some programs call
/// it p1.
fn has_lens(found: &Orientation) {
    let [k1, k2, k3, p1, p2] = LENS;
    for [x, y] in [[0.31, 0.22], [-0.35, 0.1], [0.05, -0.28]] {
        let r2: f64 = x * x + y * y;
        let g = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
        let expected = Point2::new(
            x * g + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * g + 2.0 * p2 * x * y + p1 * (r2 + 2.0 * y * y),
        );
        let lens = found.distortion.expect("a lens is stated");
        let put = lens.distort(&Point2::new(x, y));
        assert!((put - expected).norm() < 1e-12, "{put} for {expected}");
    }
}

#[test]
fn the_lens_of_a_block_is_the_one_of_its_description() {
    // There P1 is the factor of r2 + 2 x2.
    let [k1, k2, k3, p1, p2] = LENS;
    let group = format!(
        "<FocalLengthPixels>900</FocalLengthPixels><Distortion><K1>{k1}</K1><K2>{k2}</K2>\
         <K3>{k3}</K3><P1>{p2}</P1><P2>{p1}</P2></Distortion>"
    );
    let (r, center) = truth(0);
    let text = block_of(&group, &matrix_elements(&r), &center);
    has_lens(&read(&[("block.xml", &text)]).unwrap().orientations[0]);
}

#[test]
fn the_sensor_of_a_block_is_as_long_as_its_longer_side() {
    let (r, center) = truth(0);
    let group = "<FocalLength>9</FocalLength><SensorSize>0.16</SensorSize>";
    let lying = block_of(group, &matrix_elements(&r), &center);
    let standing = lying.replace(
        "<Width>16</Width><Height>12</Height>",
        "<Width>12</Width><Height>16</Height>",
    );
    let camera = |text: &str| read(&[("block.xml", text)]).unwrap().orientations[0].k;
    near(&camera(&lying), &k(900.0, 0.0, 900.0, 8.0, 6.0));
    near(&camera(&standing), &k(900.0, 0.0, 900.0, 6.0, 8.0));
}

#[test]
fn the_lens_of_pix4d_is_the_one_of_its_manual() {
    let parameters = case!("pix4d_offset/params/house_calibrated_camera_parameters.txt");
    let [k1, k2, k3, p1, p2] = LENS;
    let lens = format!("\n{k1} {k2} {k3}\n{p1} {p2}\n");
    let (path, text) = replaced(parameters, "\n0 0 0\n0 0\n", &lens);
    has_lens(&read(&[(path, &text)]).unwrap().orientations[0]);
}

#[test]
fn opensfm_counts_in_the_longer_side_of_a_portrait() {
    let [k1, k2, k3, p1, p2] = LENS;
    let text = format!(
        "[{{\"cameras\": {{\"c\": {{\"projection_type\": \"brown\", \"width\": 12, \"height\": 16, \
         \"focal_x\": 56.25, \"focal_y\": 57.5, \"c_x\": 0.125, \"c_y\": -0.0625, \
         \"k1\": {k1}, \"k2\": {k2}, \"k3\": {k3}, \"p1\": {p1}, \"p2\": {p2}}}}}, \
         \"shots\": {{\"a.jpg\": {{\"rotation\": [0, 0, 0], \"translation\": [0, 0, 0], \
         \"camera\": \"c\"}}}}}}]"
    );
    let found = read(&[("reconstruction.json", &text)]).unwrap();
    near(&found.orientations[0].k, &k(900.0, 0.0, 920.0, 8.0, 7.0));
    has_lens(&found.orientations[0]);
}

#[test]
fn nerfstudio_states_angles_of_the_whole_image() {
    let frame = "{\"file_path\": \"a.png\", \
                 \"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}";
    let of = |angles: &str| {
        let text = format!("{{{angles}, \"w\": 16, \"h\": 12, \"frames\": [{frame}]}}");
        read(&[("transforms.json", &text)]).unwrap().orientations[0].k
    };
    // 8 / 10 and 6 / 12 from the middle to the border.
    let [x, y] = [0.8f64, 0.5].map(|t| 2.0 * t.atan());
    let both = format!("\"camera_angle_x\": {x}, \"camera_angle_y\": {y}");
    near(&of(&both), &k(10.0, 0.0, 12.0, 8.0, 6.0));
    let one = format!("\"camera_angle_x\": {x}");
    near(&of(&one), &k(10.0, 0.0, 10.0, 8.0, 6.0));
}

#[test]
fn the_origin_of_a_list_of_k_r_c_is_added() {
    let list = include_str!("../../fixtures/krc/cameras.json");
    let path = "cameras.json";
    let moved = list.replacen('{', "{\"origin\": [432000.0, 5412000.0, 100.0],", 1);
    let [plain, moved] = [list, &moved].map(|text| read(&[(path, text)]).unwrap().orientations);
    for (plain, moved) in plain.iter().zip(&moved) {
        let offset = moved.center - plain.center;
        let expected = Point3::new(432_000.0, 5_412_000.0, 100.0).coords;
        assert!((offset - expected).norm() < 1e-6, "{offset}");
    }
}

#[test]
fn inpho_counts_pixels_from_the_point_that_it_names() {
    let project = include_str!("../../fixtures/inpho/gable.prj");
    let of = |reference: &str| {
        let stated = "$PIXEL_REFERENCE : CenterTopLeft";
        let text = project.replace(stated, &format!("$PIXEL_REFERENCE : {reference}"));
        assert!(project.contains(stated));
        read(&[("gable.prj", &text)]).unwrap().orientations[0].k
    };
    let half = Matrix3::new(0.0, 0.0, 0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0);
    let off = of("CenterTopLeft") - of("TopLeft") - half;
    assert!(off.norm() < 1e-6, "{off}");
}
