//! Lists of orientations as people have them: separators, encodings, names, headings, and angles of
//! which nobody says the unit.

use std::fmt::Write;
use std::io::Cursor;

use image::{ImageFormat, Rgb, RgbImage};
use nalgebra::{Matrix3, Point3, Vector3};
use ridgeline::orienting::orientation::{
    InputFile, Orientation, detect, orientation_sets, rotation_from_omega_phi_kappa,
    rotation_from_yaw_pitch_roll,
};
use ridgeline::orienting::scene_loader::{LoadOptions, inspect_files, load_scene};

const CAMERA: &str = "principal_distance_mm 4\npixel_size_mm 0.01\nimage_size_px 16 12\n";

/// Centre and angles in degrees of three views.
const PLANTED: [[f64; 6]; 3] = [
    [0.0, 0.0, 100.0, 1.5, 0.0, -2.0],
    [15.0, 2.0, 101.0, 0.5, 0.7, 1.0],
    [30.0, 4.0, 102.0, -0.5, 1.4, 4.0],
];

fn png(width: u32, height: u32) -> Vec<u8> {
    encoded(&RgbImage::new(width, height))
}

fn encoded(image: &RgbImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// The orientations that a camera file and this list give.
fn read(path: &str, list: impl Into<Vec<u8>>) -> ridgeline::Result<Vec<Orientation>> {
    let files = [
        InputFile::new("camera.txt", CAMERA.into()),
        InputFile::new(path, list.into()),
    ];
    let kinds: Vec<_> = files.iter().map(detect).collect();
    let (sets, incomplete) = orientation_sets(&files, &kinds);
    assert_eq!(sets.len(), 1, "{kinds:?} {incomplete:?}");
    sets[0].read(&files, &mut Vec::new())
}

/// A list of the planted views, a line each.
fn lines(line: impl Fn(usize, [f64; 6]) -> String) -> String {
    (0..3).map(|i| line(i + 1, PLANTED[i]) + "\n").collect()
}

fn joined(v: [f64; 6], separator: &str) -> String {
    v.map(|v| format!("{v:.6}")).join(separator)
}

/// Do these lists hold the planted views under these names?
fn check(what: &str, list: impl Into<Vec<u8>>, name: impl Fn(usize) -> String) {
    let found = read("eo.txt", list).unwrap_or_else(|e| panic!("{what}: {e}"));
    assert_eq!(found.len(), 3, "{what}");
    for (i, (found, v)) in found.iter().zip(PLANTED).enumerate() {
        assert_eq!(found.image, name(i + 1), "{what}");
        assert_eq!(found.center, Point3::new(v[0], v[1], v[2]), "{what}");
        let [o, p, k] = [v[3], v[4], v[5]].map(f64::to_radians);
        let r = rotation_from_omega_phi_kappa(o, p, k);
        assert!((found.r - r.matrix()).norm() < 1e-9, "{what}");
        assert!(found.readings.is_empty(), "{what}: the unit is stated");
    }
}

#[test]
fn separators_decimal_signs_and_more_columns_are_read() {
    let plain = |i: usize| format!("v{i}.jpg");
    for (what, separator) in [
        ("comma", ","),
        ("comma and blank", ", "),
        ("semicolon", ";"),
    ] {
        let list = lines(|i, v| format!("v{i}.jpg{separator}{}", joined(v, separator)));
        check(what, format!("# degrees\n{list}"), plain);
    }
    for sign in ["!", "//", "%", "#"] {
        let list = lines(|i, v| format!("v{i}.jpg {}", joined(v, " ")));
        check(
            sign,
            format!("{sign} angles in degrees\n{list}{sign} the end\n"),
            plain,
        );
    }
    for (what, separator) in [("tab", "\t"), ("semicolon", ";"), ("blanks", "  ")] {
        let list =
            lines(|i, v| format!("v{i}.jpg{separator}{}", joined(v, separator)).replace('.', ","));
        check(
            &format!("decimal comma, {what}"),
            format!("# deg\n{}", list.replace(",jpg", ".jpg")),
            plain,
        );
    }
    let quoted = lines(|i, v| format!("\"v{i}.jpg\",\"{}\"", joined(v, "\",\"")).replace('.', ","));
    let quoted = quoted.replace(",jpg", ".jpg");
    check("decimal comma in quotes", format!("# deg\n{quoted}"), plain);

    let agisoft = lines(|i, v| format!("v{i}\t{}{}", joined(v, "\t"), "\t0.5".repeat(9)));
    let heading = "# Cameras (3)\n# PhotoID, X, Y, Z, Omega, Phi, Kappa, r11, r12, r13, r21, r22, r23, r31, r32, r33\n";
    check("Agisoft", format!("{heading}{agisoft}"), |i| {
        format!("v{i}")
    });
    let more = lines(|i, v| format!("v{i}.jpg {} 0.02 fixed", joined(v, " ")));
    check("more columns", format!("# deg\n{more}"), plain);
    let grouped = "# deg\nv1.jpg;1.234,5;0,0;100,0;1,5;0;0\n";
    assert_eq!(read("eo.txt", grouped).unwrap()[0].center.x, 1234.5);
    let minus = "# deg\nv1.jpg \u{2212}2.5 0 1.0D+02 1 0 0\n";
    let found = read("eo.txt", minus).unwrap();
    assert_eq!(found[0].center, Point3::new(-2.5, 0.0, 100.0));
}

#[test]
fn names_with_blanks_and_running_numbers_are_read() {
    let blank = |i: usize| format!("v {i} (2).jpg");
    for separator in ["\t", ";", ",", " "] {
        let list = lines(|i, v| format!("v {i} (2).jpg{separator}{}", joined(v, separator)));
        check(separator, format!("# degrees\n{list}"), blank);
        let list = lines(|i, v| {
            format!(
                "{i}{separator}v {i} (2).jpg{separator}{}",
                joined(v, separator)
            )
        });
        check(separator, format!("# degrees\n{list}"), blank);
    }
    let list = lines(|i, v| format!("\"v {i}\" {}", joined(v, " ")));
    check("quotes", format!("# degrees\n{list}"), |i| format!("v {i}"));
    let list = lines(|i, v| format!("{i} v{i} {}", joined(v, " ")));
    check("number", format!("# degrees\n{list}"), |i| format!("v{i}"));
    let list = lines(|i, v| format!("104{i} {}", joined(v, " ")));
    check("photos by number", format!("# degrees\n{list}"), |i| {
        format!("104{i}")
    });
    // A copy of a photograph that is called by a number.
    let list = lines(|i, v| format!("000{i} (2).jpg {}", joined(v, " ")));
    check("copies", format!("# degrees\n{list}"), |i| {
        format!("000{i} (2).jpg")
    });
}

#[test]
fn headings_decide_about_the_columns() {
    let plain = |i: usize| format!("v{i}.jpg");
    let list = lines(|i, v| format!("v{i}.jpg {}", joined(v, " ")));
    check(
        "Pix4D is in degrees",
        format!("imageName X Y Z Omega Phi Kappa\n{list}"),
        plain,
    );
    let list = lines(|i, [x, y, z, o, p, k]| format!("{i};{k};{p};{o};{z};{y};{x};v{i}.jpg"));
    check(
        "another order",
        format!("Nr;Kappa [deg];Phi [deg];Omega [deg];Höhe;Hochwert;Rechtswert;Bild\n{list}"),
        plain,
    );
    let list = lines(|i, v| format!("v{i}.jpg;{}", joined(v, ";")));
    check(
        "another language",
        format!("Снимок;Восток;Север;Высота;а;б;в [deg]\n{list}"),
        plain,
    );
    let heading = "Label,X/Easting,Y/Northing,Z/Altitude,Yaw,Pitch,Roll,X_est,Y_est,Z_est,Yaw_est,Pitch_est,Roll_est";
    let list = "# CoordinateSystem: LOCAL\n#LABEL\nv1.jpg,9,9,9,9,9,9,1,2,100,30,2,-1\nv2.jpg,9,9,9,9,9,9,,,,,,\n";
    let found = read("reference.csv", list.replace("LABEL", heading)).unwrap();
    assert_eq!(found.len(), 1, "the other is not aligned");
    assert_eq!(found[0].center, Point3::new(1.0, 2.0, 100.0));
    let [yaw, pitch, roll] = [30f64, 2.0, -1.0].map(f64::to_radians);
    let r = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
    assert!((found[0].r - r.matrix()).norm() < 1e-12);
}

#[test]
fn a_unit_that_is_stated_holds_for_all_angles() {
    for (word, per_degree) in [
        ("degrees", 1.0),
        ("gon", 1.0 / 0.9),
        ("radians", 1f64.to_radians()),
    ] {
        let row = |v: [f64; 6]| {
            let [a, b, c] = [v[3], v[4], v[5]].map(|v| v * per_degree);
            format!("{} {} {} {a} {b} {c}", v[0], v[1], v[2])
        };
        let list = lines(|i, v| format!("v{i}.jpg {}", row(v)));
        check(word, format!("# angles in {word}\n{list}"), |i| {
            format!("v{i}.jpg")
        });
        let found = read(
            "eo.txt",
            format!("# {word}\nimage X Y Z yaw pitch roll\n{list}"),
        );
        for (found, v) in found.unwrap().iter().zip(PLANTED) {
            let [yaw, pitch, roll] = [v[3], v[4], v[5]].map(f64::to_radians);
            let r = rotation_from_yaw_pitch_roll(yaw, pitch, roll);
            assert!((found.r - r.matrix()).norm() < 1e-9, "{word}");
        }
    }
}

#[test]
fn pixels_need_not_be_square() {
    let camera = CAMERA.replace("pixel_size_mm 0.01", "pixel_size_mm 0.01 0.02");
    let camera = format!("{camera}principal_point_mm 0.02 0.04\n");
    let files = [
        InputFile::new("camera.txt", camera.into_bytes()),
        InputFile::new("eo.txt", b"# degrees\nv1.jpg 0 0 100 0 0 0\n".to_vec()),
    ];
    let kinds: Vec<_> = files.iter().map(detect).collect();
    let (sets, _) = orientation_sets(&files, &kinds);
    let found = sets[0].read(&files, &mut Vec::new()).unwrap();
    let k = Matrix3::new(400.0, 0.0, 10.0, 0.0, 200.0, 4.0, 0.0, 0.0, 1.0);
    assert!((found[0].k - k).norm() < 1e-9, "{}", found[0].k);
}

#[test]
fn encodings_and_ends_of_lines_of_other_systems_are_read() {
    let name = |i: usize| format!("überflug {i}.jpg");
    let list = format!(
        "# degrees\n{}",
        lines(|i, v| format!("{}\t{}", name(i), joined(v, "\t")))
    );
    let utf16 = |mark: u16, order: fn(u16) -> [u8; 2]| -> Vec<u8> {
        let units = std::iter::once(mark).chain(list.encode_utf16());
        units.flat_map(order).collect()
    };
    check("UTF-16, little", utf16(0xfeff, u16::to_le_bytes), name);
    check("UTF-16, big", utf16(0xfeff, u16::to_be_bytes), name);
    check("byte order mark", format!("\u{feff}{list}"), name);
    let without = list.trim_start_matches("# degrees\n");
    check(
        "byte order mark before an image",
        format!("\u{feff}{without}# degrees\n"),
        name,
    );
    check(
        "Windows-1252",
        list.chars().map(|c| c as u8).collect::<Vec<u8>>(),
        name,
    );
    // A dash, an apostrophe and a euro stand where Latin-1 has nothing.
    let special = |i: usize| format!("flug \u{2013} l\u{2019}été {i}\u{20ac}.jpg");
    let byte = |c: char| match c {
        '\u{2013}' => 0x96,
        '\u{2019}' => 0x92,
        '\u{20ac}' => 0x80,
        c => c as u8,
    };
    let listed = lines(|i, v| format!("{}\t{}", special(i), joined(v, "\t")));
    let bytes: Vec<u8> = format!("# degrees\n{listed}").chars().map(byte).collect();
    check("Windows-1252 beyond Latin-1", bytes, special);
    check("CRLF", list.replace('\n', "\r\n"), name);
    check("CR", list.replace('\n', "\r"), name);
}

#[test]
fn a_list_that_nearly_fits_is_named_with_its_line() {
    let refusal = |list: &str| {
        let mut files: Vec<InputFile> = (1..=3)
            .map(|i| InputFile::new(&format!("v{i}.png"), png(16, 12)))
            .collect();
        files.push(InputFile::new("camera.txt", CAMERA.into()));
        files.push(InputFile::new("eo.txt", list.into()));
        let message = load_scene(&files, &LoadOptions::default())
            .unwrap_err()
            .to_string();
        let inspected = inspect_files(&files, &LoadOptions::default());
        assert_eq!(inspected.errors[0], message, "the page says the same");
        message
    };
    for (list, words) in [
        (
            "# deg\nv1 0 0 100 1 0\nv2 0 0 100 1 0\n",
            "eo.txt, line 2: 6 fields",
        ),
        (
            "# deg\nv1.jpg 0 0 100 1 0 0\nv2.jpg 0 0 1oo 1 0 0\n",
            "eo.txt, line 3: a coordinate is \"1oo\"",
        ),
        (
            "v1.jpg,0,5,0,5,100,5,1,5,0,5,0,5\n",
            "whole numbers between commas",
        ),
        (
            "flight 1 0 0 100 1 0 0\nflight 2 0 0 100 1 0 0\n",
            "which may end with a number of its own",
        ),
        (
            "foto;breite;lange;hohe;o;p;k;quality\nv1;0;0;9;1;2;3;4\nv2;0;0;9;1;2;3;4\n",
            "eo.txt, line 1: the heading",
        ),
        (
            "name;x;y;z;omega;phi\nv1;0;0;9;1;2\n",
            "eo.txt, line 1: the heading names no column of kappa",
        ),
    ] {
        let message = refusal(list);
        assert!(message.contains(words), "{message}\nlacks: {words}");
        assert!(!message.contains("beside it"), "{message}");
    }
}

#[test]
fn formats_that_are_not_read_are_named_with_what_to_do() {
    let mut files = vec![InputFile::new("v1.png", png(16, 12))];
    let json = "{\"sfm_data_version\": \"0.3\", \"views\": [], \"intrinsics\": []}";
    files.push(InputFile::new("sfm_data.json", json.into()));
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("sfm_data.json is an OpenMVG scene"),
        "{message}"
    );
    assert!(message.contains("openMVG_main_openMVG2Colmap"), "{message}");
}

#[test]
fn names_with_blanks_stand_before_the_numbers_of_other_formats() {
    let cameras = |path: &str, text: &str, more: &[(&str, &str)]| {
        let mut files = vec![InputFile::new(path, text.into())];
        files.extend(more.iter().map(|(p, t)| InputFile::new(p, (*t).into())));
        let kinds: Vec<_> = files.iter().map(detect).collect();
        let sets = orientation_sets(&files, &kinds).0;
        sets[0].read(&files, &mut Vec::new()).unwrap()
    };
    let matrices = "400 0 8\n0 400 6\n0 0 1\n0 0 0\n0 0\n0 0 100\n1 0 0\n0 -1 0\n0 0 -1\n";
    let pix4d = format!(
        "fileName imageWidth imageHeight\nDJI 1 (2).jpg 16 12\n{matrices}DJI 2 (2).jpg 16 12\n{matrices}"
    );
    let found = cameras("p_calibrated_camera_parameters.txt", &pix4d, &[]);
    let names: Vec<&str> = found.iter().map(|o| &*o.image).collect();
    assert_eq!(names, ["DJI 1 (2).jpg", "DJI 2 (2).jpg"]);

    let nvm = "NVM_V3\n\n4\nDJI 1 (2).jpg 400 0 1 0 0 1 2 3 0 0\nDJI\"2\"(2).jpg\t400 0 1 0 0 1 2 3 0 0\n\
               \"DJI 3.jpg\" 400 0 1 0 0 1 2 3 0\nDJI_4.jpg 400 0 1 0 0 1 2 3 0 0\n";
    let found = cameras("m.nvm", nvm, &[]);
    let names: Vec<&str> = found.iter().map(|o| &*o.image).collect();
    assert_eq!(
        names,
        ["DJI 1 (2).jpg", "DJI 2 (2).jpg", "DJI 3.jpg", "DJI_4.jpg"]
    );
    assert!(
        found
            .iter()
            .all(|o| o.center == Point3::new(1.0, 2.0, 3.0) && o.k[(0, 0)] == 400.0)
    );
    let fixed = nvm.replace("NVM_V3", "NVM_V3 FixedK 410 7 420 5");
    let found = cameras("m.nvm", &fixed, &[]);
    let k = Matrix3::new(410.0, 0.0, 7.0, 0.0, 420.0, 5.0, 0.0, 0.0, 1.0);
    assert!(found[0].k == k && !found[0].from_middle);

    let camera = "400 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -100\n";
    let bundle = format!("# Bundle file v0.3\n2 0\n{camera}{camera}");
    for list in [
        "./my images/DJI 1 (2).jpg\n./my images/DJI 2 (2).JPG\n",
        "my images/DJI 1 (2).jpg 0 400.5\nmy images/DJI 2 (2).JPG 0 400.5\n",
    ] {
        let found = cameras("out/bundle.out", &bundle, &[("files.lst", list)]);
        assert!(
            found[0].image.ends_with("my images/DJI 1 (2).jpg"),
            "{}",
            found[0].image
        );
        assert!(
            found[1].image.ends_with("my images/DJI 2 (2).JPG"),
            "{}",
            found[1].image
        );
    }
}

#[test]
fn rotations_of_a_few_digits_are_accepted_and_wrong_ones_are_not() {
    for digits in [4usize, 5, 6] {
        let files = strecha(digits, 1.0);
        let scene = load_scene(&files, &LoadOptions::default()).unwrap();
        for view in &scene.views {
            let r = view.camera.r;
            let deviation = (r * r.transpose() - Matrix3::identity()).amax();
            // Six digits may be exact enough to stay as they are.
            let most = if digits == 6 { 1e-6 } else { 1e-12 };
            assert!(deviation < most, "{digits} digits: {deviation}");
        }
    }
    for (digits, factor) in [(2, 1.0), (12, 1.01), (12, -1.0)] {
        let error = load_scene(&strecha(digits, factor), &LoadOptions::default()).unwrap_err();
        let message = error.to_string();
        assert!(message.contains("is not a rotation"), "{message}");
        assert!(!message.contains("export"), "{message}");
    }
}

/// Three views with their cameras in Strecha's files, the rotations of so many digits.
fn strecha(digits: usize, factor: f64) -> Vec<InputFile> {
    let view = |(i, v): (usize, [f64; 6])| {
        let [o, p, k] = [v[3], v[4], v[5]].map(f64::to_radians);
        let r = rotation_from_omega_phi_kappa(o, p, k).matrix().transpose() * factor;
        let mut text = String::from("40 0 8\n0 40 6\n0 0 1\n0 0 0\n");
        for row in r.row_iter() {
            writeln!(
                text,
                "{:.*} {:.*} {:.*}",
                digits, row[0], digits, row[1], digits, row[2]
            )
            .unwrap();
        }
        writeln!(text, "{} {} {}\n16 12", v[0], v[1], v[2]).unwrap();
        [
            InputFile::new(&format!("v{i}.png"), png(16, 12)),
            InputFile::new(&format!("v{i}.png.camera"), text.into_bytes()),
        ]
    };
    PLANTED.into_iter().enumerate().flat_map(view).collect()
}

/// Four views straight down on a patterned plain, as a drone takes them.
const NADIR: [[f64; 6]; 4] = [
    [-10.0, 0.0, 95.0, 0.13, -2.47, -5.8],
    [0.0, 0.5, 93.0, -0.59, -0.25, -2.6],
    [9.6, -0.1, 94.7, 1.15, 2.38, -1.9],
    [9.3, 12.5, 96.2, 1.31, 1.77, -177.9],
];

const NADIR_CAMERA: &str = "principal_distance_mm 11\npixel_size_mm 0.016\nimage_size_px 300 224\n";

/// The images of these views, and a list of them in a unit of so many degrees.
fn nadir_scene(unit_deg: f64) -> Vec<InputFile> {
    let mut files = vec![InputFile::new("camera.txt", NADIR_CAMERA.into())];
    let mut list = String::new();
    for (i, [x, y, z, o, p, k]) in NADIR.into_iter().enumerate() {
        let [omega, phi, kappa] = [o, p, k].map(f64::to_radians);
        let world_from_cam = rotation_from_omega_phi_kappa(omega, phi, kappa).inverse();
        let image = RgbImage::from_fn(300, 224, |column, row| {
            let f = 11.0 / 0.016;
            let (u, v) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
            let ray = world_from_cam * Vector3::new((u - 150.0) / f, (v - 112.0) / f, 1.0);
            let depth = -z / ray.z;
            let grey = pattern(x + ray.x * depth, y + ray.y * depth);
            Rgb([grey, grey, grey])
        });
        files.push(InputFile::new(&format!("v{i}.png"), encoded(&image)));
        let [o, p, k] = [o, p, k].map(|a| a / unit_deg);
        writeln!(list, "v{i}.png {x} {y} {z} {o} {p} {k}").unwrap();
    }
    files.push(InputFile::new("eo.txt", list.into_bytes()));
    files
}

/// Grey values of the plain: noise in cells of 0.6 m, interpolated.
fn pattern(x: f64, y: f64) -> u8 {
    let noise = |i: f64, j: f64| {
        let mixed = (i as i64).wrapping_mul(0x9e37_79b9_7f4a_7c15_u64 as i64)
            ^ (j as i64).wrapping_mul(0x2545_f491_4f6c_dd1d);
        let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0x1656_67b1_9e37_79f9);
        ((mixed >> 32) & 0xff) as f64
    };
    let (x, y) = (x / 0.6, y / 0.6);
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    let row = |j: f64| noise(i, j) * (1.0 - s) + noise(i + 1.0, j) * s;
    (row(j) * (1.0 - t) + row(j + 1.0) * t) as u8
}

#[test]
fn the_images_decide_about_a_unit_that_nobody_states() {
    for (unit, unit_deg) in [
        ("degrees", 1.0),
        ("gon", 0.9),
        ("radians", 180.0 / std::f64::consts::PI),
    ] {
        let files = nadir_scene(unit_deg);
        for roi in [None, Some([-2.0, -2.0, 2.0, 2.0])] {
            let options = LoadOptions {
                roi,
                ..LoadOptions::default()
            };
            let scene = load_scene(&files, &options).unwrap_or_else(|e| panic!("{unit}: {e}"));
            let words = scene.warnings.join("\n");
            assert!(
                words.contains(&format!("the angles were read in {unit}: so the images")),
                "{words}"
            );
            let is_cut =
                |view: &ridgeline::View| view.camera.width < 300 || view.camera.height < 224;
            assert_eq!(roi.is_some(), scene.views.iter().any(is_cut), "{unit}");
            for (view, [_, _, _, o, p, k]) in scene.views.iter().zip(NADIR) {
                let [o, p, k] = [o, p, k].map(f64::to_radians);
                let r = rotation_from_omega_phi_kappa(o, p, k);
                assert!((view.camera.r - r.matrix()).norm() < 1e-9, "{unit}");
            }
        }
    }
}

#[test]
fn a_stated_unit_that_is_wrong_is_still_refused() {
    let mut files = nadir_scene(1.0);
    let list = files.last_mut().unwrap();
    list.bytes = [b"# angles in gon\n".to_vec(), list.bytes.clone()].concat();
    let message = load_scene(&files, &LoadOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("omega, phi, kappa in degrees"),
        "{message}"
    );
    assert!(message.contains("--apply-fix"), "{message}");
}
