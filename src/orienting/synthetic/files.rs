//! A scene as the files that the readers take: PNG images and the three orientation formats.

use std::fmt::Write as _;

use nalgebra::{Rotation3, UnitQuaternion};

use crate::orienting::orientation::omega_phi_kappa_from_rotation;
use crate::orienting::scene::Scene;

/// Images (`images/*.png`) and a COLMAP text model (`colmap/*.txt`): path and bytes of each file.
pub fn to_files(scene: &Scene) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = scene
        .views
        .iter()
        .map(|view| (format!("images/{}", view.name), png(&view.rgb)))
        .collect();
    files.extend(to_colmap(scene));
    files
}

fn png(rgb: &image::RgbImage) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    rgb.write_to(&mut bytes, image::ImageFormat::Png)
        .expect("encoding into memory cannot fail");
    bytes.into_inner()
}

/// The orientation as a COLMAP text model in world coordinates.
pub fn to_colmap(scene: &Scene) -> Vec<(String, Vec<u8>)> {
    let mut cameras = String::from("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n");
    let mut images = String::from(
        "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as (X, Y, POINT3D_ID)\n",
    );
    for (i, view) in scene.views.iter().enumerate() {
        let (id, c) = (i + 1, &view.camera);
        let [fx, fy, cx, cy] = [c.k[(0, 0)], c.k[(1, 1)], c.k[(0, 2)], c.k[(1, 2)]];
        writes(
            &mut cameras,
            format_args!("{id} PINHOLE {} {} {fx} {fy} {cx} {cy}", c.width, c.height),
        );
        let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(c.r));
        let t = -(c.r * (c.center.coords + scene.origin));
        writes(
            &mut images,
            format_args!(
                "{id} {} {} {} {} {} {} {} {id} {}\n",
                q.w, q.i, q.j, q.k, t.x, t.y, t.z, view.name
            ),
        );
    }
    vec![
        ("colmap/cameras.txt".to_owned(), cameras.into_bytes()),
        ("colmap/images.txt".to_owned(), images.into_bytes()),
    ]
}

/// The orientation as one `.P` file per view: centre of the top-left pixel (0, 0).
pub fn to_projection(scene: &Scene) -> Vec<(String, Vec<u8>)> {
    scene
        .views
        .iter()
        .map(|view| {
            let mut camera = view.camera.clone();
            camera.k[(0, 2)] -= 0.5;
            camera.k[(1, 2)] -= 0.5;
            camera.center += scene.origin;
            let p = camera.projection_matrix();
            let mut text = String::new();
            for row in p.row_iter() {
                writes(
                    &mut text,
                    format_args!("{} {} {} {}", row[0], row[1], row[2], row[3]),
                );
            }
            let stem = view.name.rsplit_once('.').map_or(&*view.name, |(s, _)| s);
            (format!("projection/{stem}.P"), text.into_bytes())
        })
        .collect()
}

/// The orientation as a photogrammetric list: the views must be crops, at whole pixels, of frames
/// of one focal length.
pub fn to_photogrammetric(scene: &Scene) -> Vec<(String, Vec<u8>)> {
    // An 11500 x 9000 frame of 12 micrometres; the crops state the position of its corner.
    let (pixel_mm, width, height) = (0.012, 11500.0, 9000.0);
    let first = &scene.views[0].camera.k;
    let fraction = |v: f64| v - v.floor();
    let (px, py) = (fraction(first[(0, 2)]), fraction(first[(1, 2)]));
    let mut camera = String::from("# angles in degrees, lengths in mm and m\n");
    writes(
        &mut camera,
        format_args!(
            "principal_distance_mm {}\nprincipal_point_mm {} {}\npixel_size_mm {pixel_mm}\nimage_size_px {width} {height}",
            first[(0, 0)] * pixel_mm,
            px * pixel_mm,
            -py * pixel_mm
        ),
    );
    let mut exterior = String::from("# angles in degrees\n# image X0 Y0 Z0 omega phi kappa\n");
    for view in &scene.views {
        let c = &view.camera;
        let (x, y) = (
            (width / 2.0 + px - c.k[(0, 2)]).round(),
            (height / 2.0 + py - c.k[(1, 2)]).round(),
        );
        writes(
            &mut camera,
            format_args!("crop {} {x} {y} {} {}", view.name, c.width, c.height),
        );
        let center = c.center + scene.origin;
        let [omega, phi, kappa] = omega_phi_kappa_from_rotation(&c.r).map(f64::to_degrees);
        writes(
            &mut exterior,
            format_args!(
                "{} {} {} {} {omega} {phi} {kappa}",
                view.name, center.x, center.y, center.z
            ),
        );
    }
    vec![
        ("photogrammetric/camera.txt".to_owned(), camera.into_bytes()),
        (
            "photogrammetric/exterior.txt".to_owned(),
            exterior.into_bytes(),
        ),
    ]
}

fn writes(text: &mut String, arguments: std::fmt::Arguments) {
    writeln!(text, "{arguments}").expect("writing to a string cannot fail");
}
