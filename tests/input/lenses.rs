//! Lenses, from the files of the programs that state them to photographs without distortion.
//!
//! The numbers of `tests/fixtures/cases/micmac_lens` follow MicMac's own formula
//! (`tests/fixtures/make.py`); photographs are drawn here, of a pattern on flat ground, by lenses
//! that are inverted independently.

#![allow(clippy::disallowed_methods)]

use nalgebra::{Point2, Point3};
use ridgeline::orienting::orientation::{
    FileKind, InputFile, Orientation, detect, orientation_sets,
};
use ridgeline::orienting::scene_loader::{LoadOptions, load_scene};

fn micmac() -> Vec<InputFile> {
    macro_rules! files {
        ($($name:literal),*) => {
            vec![$(InputFile::new(
                concat!("Ori-T/", $name),
                include_bytes!(concat!("../fixtures/cases/micmac_lens/", $name)).to_vec(),
            )),*]
        };
    }
    files![
        "Orientation-v0.png.xml",
        "Orientation-v1.png.xml",
        "Orientation-v2.png.xml",
        "AutoCal_Foc-20000_Cam-T.xml"
    ]
}

fn text(file: &InputFile) -> String {
    String::from_utf8(file.bytes.clone()).unwrap()
}

fn read(files: &[InputFile]) -> ridgeline::Result<Vec<Orientation>> {
    let kinds: Vec<FileKind> = files.iter().map(detect).collect();
    orientation_sets(files, &kinds).0[0].read(files, &mut Vec::new())
}

/// The numbers of all elements of a name.
fn elements(text: &str, name: &str) -> Vec<Vec<f64>> {
    let tag = format!("<{name}>");
    let rest = text.split(&tag).skip(1);
    rest.map(|rest| {
        let numbers = rest.split('<').next().unwrap().split_whitespace();
        numbers.map(|n| n.parse().unwrap()).collect()
    })
    .collect()
}

#[test]
fn micmac_lenses_lead_from_ideal_to_measured() {
    let files = micmac();
    let found = read(&files).unwrap();
    let (mut count, mut farthest) = (0, 0.0_f64);
    for (orientation, file) in found.iter().zip(&files) {
        let text = text(file);
        for (image, world) in elements(&text, "Im").iter().zip(elements(&text, "Ter")) {
            let ray =
                orientation.r * (Point3::new(world[0], world[1], world[2]) - orientation.center);
            let ideal = Point2::new(ray.x / ray.z, ray.y / ray.z);
            let pixel = |p: Point2<f64>| (orientation.k * p.to_homogeneous()).xy();
            let seen = pixel(orientation.distortion.unwrap().distort(&ideal));
            let stated = Point2::new(image[0], image[1]).coords;
            assert!((seen - stated).norm() < 1e-6, "{seen} instead of {stated}");
            farthest = farthest.max((pixel(ideal) - stated).norm());
            count += 1;
        }
    }
    assert_eq!(count, 12);
    assert!(farthest > 1.0, "the lens does distort: {farthest} px");
}

#[test]
fn a_micmac_lens_that_misses_the_check_points_is_refused() {
    let mut files = micmac();
    let turned = text(&files[3]).replace("<CoeffDist>-2e-07", "<CoeffDist>2e-07");
    files[3].bytes = turned.into_bytes();
    let refusal = read(&files).unwrap_err().to_string();
    assert!(
        refusal.contains("Orientation-v0.png.xml, line 5: <Appuis>: this point lies"),
        "{refusal}"
    );
}

/// Smooth waves on the ground, 0 to 255.
fn pattern(x: f64, y: f64) -> f64 {
    127.5 + 60.0 * (x / 9.0).sin() * (y / 8.0).cos() + 60.0 * ((x + y) / 11.0).sin()
}

const SIZE: [u32; 2] = [320, 240];

/// The photograph that a camera above `center` takes, looking down, with x to the east; `angle` is
/// the angle from the axis at a radius in focal lengths.
fn photograph(center: [f64; 3], f: f64, pp: [f64; 2], angle: impl Fn(f64) -> f64) -> Vec<u8> {
    let image = image::GrayImage::from_fn(SIZE[0], SIZE[1], |column, row| {
        let x = (f64::from(column) + 0.5 - pp[0]) / f;
        let y = (f64::from(row) + 0.5 - pp[1]) / f;
        let r = x.hypot(y);
        let tangent = angle(r).min(1.5).tan();
        let (x, y) = (x * tangent / r, y * tangent / r);
        let value = pattern(center[0] + center[2] * x, center[1] - center[2] * y);
        image::Luma([value.round() as u8])
    });
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Loads three photographs with the camera of a COLMAP file, and measures how far the pattern lies
/// from where the views' pinholes see it: the largest shift of a window, px.
fn off_px(
    camera: &str,
    f: f64,
    pp: [f64; 2],
    angle: impl Fn(f64) -> f64 + Copy,
) -> (f64, Vec<String>) {
    let mut files = vec![InputFile::new("cameras.txt", camera.as_bytes().to_vec())];
    let mut list = String::new();
    for (i, [x, y, z]) in [[0.0, 0.0, 100.0], [20.0, 3.0, 100.0], [4.0, 22.0, 104.0]]
        .into_iter()
        .enumerate()
    {
        // Half a turn about x: R = diag(1, -1, -1), t = -R C.
        list += &format!("{} 0 1 0 0 {} {y} {z} 1 v{i}.png\n\n", i + 1, -x);
        let bytes = photograph([x, y, z], f, pp, angle);
        files.push(InputFile::new(&format!("v{i}.png"), bytes));
    }
    files.push(InputFile::new("images.txt", list.into_bytes()));
    let options = LoadOptions {
        ignore_check: true,
        ..LoadOptions::default()
    };
    let scene = load_scene(&files, &options).unwrap();
    let mut largest: f64 = 0.0;
    for view in &scene.views {
        let ground = |column: f64, row: f64| {
            let p = view
                .camera
                .at_height(&Point2::new(column, row), -scene.origin.z);
            let p = p.unwrap() + scene.origin;
            pattern(p.x, p.y)
        };
        for (left, top) in [(0, 0), (272, 0), (0, 192), (272, 192), (140, 100)] {
            // Least squares: value = pattern + shift * slope.
            let (mut normal, mut right) = (nalgebra::Matrix2::zeros(), nalgebra::Vector2::zeros());
            for (column, row) in
                (top..top + 48).flat_map(|r| (left..left + 48).map(move |c| (c, r)))
            {
                let (x, y) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
                let slope = nalgebra::Vector2::new(
                    ground(x + 0.5, y) - ground(x - 0.5, y),
                    ground(x, y + 0.5) - ground(x, y - 0.5),
                );
                let value = f64::from(view.rgb.get_pixel(column, row)[0]);
                normal += slope * slope.transpose();
                right += slope * (value - ground(x, y));
            }
            largest = largest.max((normal.try_inverse().unwrap() * right).norm());
        }
    }
    (largest, scene.warnings)
}

/// The angle at which a growing function reaches a radius.
fn solve(radius: f64, of_angle: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.57);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of_angle(middle) < radius {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn fisheye_photographs_become_pinholes() {
    let k = [-0.03, 0.004, -0.002, 0.0006];
    let opencv = |theta: f64| {
        let t2 = theta * theta;
        theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))))
    };
    let (f, pp) = (140.0, [158.0, 122.0]);
    let (off, warnings) = off_px(
        "1 OPENCV_FISHEYE 320 240 140 140 158 122 -0.03 0.004 -0.002 0.0006\n",
        f,
        pp,
        |r| solve(r, opencv),
    );
    assert!(off < 0.06, "{off} px");
    let said = "fisheye photographs are rectified to pinholes: what lies more than 60 degrees";
    assert!(warnings.iter().any(|w| w.starts_with(said)), "{warnings:?}");
    // A field of view that the photograph ends, not the angle.
    let w = 1.0_f64;
    let fov = |theta: f64| (2.0 * theta.tan() * (w / 2.0).tan()).atan() / w;
    let (off, warnings) = off_px("1 FOV 320 240 300 300 158 122 1.0\n", 300.0, pp, |r| {
        solve(r, fov)
    });
    assert!(off < 0.06, "{off} px");
    assert!(
        !warnings.iter().any(|w| w.contains("60 degrees")),
        "{warnings:?}"
    );
}

#[test]
fn a_fisheye_read_as_a_pinhole_would_lie_elsewhere() {
    let (off, _) = off_px(
        "1 SIMPLE_PINHOLE 320 240 140 158 122\n",
        140.0,
        [158.0, 122.0],
        |r| r,
    );
    assert!(off > 1.0, "{off} px");
}
