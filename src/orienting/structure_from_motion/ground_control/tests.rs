//! Planted blocks and control points on their map.

use nalgebra::{Point3, Vector3};

use super::*;
use crate::base::geometry::rotation_from_axis_angle;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::bundle::tests::planted;
use crate::orienting::structure_from_motion::frame::{FrameBasis, StatedPose};
use crate::orienting::structure_from_motion::similarity::Similarity;

mod roles;

const OFFSET: Vector3<f64> = Vector3::new(432_100.0, 5_412_300.0, 0.0);

/// A block in a frame of its own, and a list of its points of these numbers as they are on the
/// map; `change` may spoil coordinates and marks.
fn listed(
    numbers: &[usize],
    mut change: impl FnMut(usize, &mut Point3<f64>, &mut Vec<Vector3<f64>>),
) -> (Block, Block, Vec<String>, GroundControl) {
    let truth = planted(0.1, 3);
    let paths: Vec<String> = (0..9).map(|i| format!("images/P{i}.jpg")).collect();
    let mut text = "EPSG:25832\n".to_owned();
    for (name, &number) in numbers.iter().enumerate() {
        let track = &truth.tracks[number];
        let mut place = track.point.unwrap() + OFFSET;
        let mut marks: Vec<Vector3<f64>> = (track.used())
            .map(|o| truth.pixel(o).coords.push(o.photo as f64))
            .collect();
        change(name, &mut place, &mut marks);
        for mark in marks {
            let [x, y, z] = place.into();
            text += &format!(
                "{x} {y} {z} {} {} p{}.JPG g{name}\n",
                mark.x, mark.y, mark.z
            );
        }
    }
    let mut block = truth.clone();
    let similarity = Similarity {
        scale: 0.02,
        rotation: rotation_from_axis_angle(&Vector3::new(1.2, -0.7, 0.5)),
        shift: Vector3::new(0.3, 0.1, 4.0),
    };
    similarity.apply(&mut block);
    let control = GroundControl::read("gcp_list.txt", &text).unwrap();
    (truth, block, paths, control)
}

/// Numbers of points that several photographs show.
fn well_seen(count: usize) -> Vec<usize> {
    let truth = planted(0.1, 3);
    let seen = (0..truth.tracks.len()).filter(|&t| truth.tracks[t].observations.len() >= 4);
    seen.step_by(9).take(count).collect()
}

fn placed(
    block: &mut Block,
    paths: &[String],
    control: &GroundControl,
    applies_fix: bool,
) -> (Option<FrameBasis>, String) {
    let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
    let beside = Beside {
        paths: &paths,
        stated: &[],
        anchor: None,
        applies_fix,
    };
    let (basis, words) = to_control(block, control, &beside);
    (basis, words.join("\n"))
}

#[test]
fn control_points_give_the_map_and_a_wrong_one_and_a_wrong_mark_are_named() {
    let (truth, mut block, paths, control) = listed(&well_seen(7), |name, place, marks| {
        if name == 2 {
            *place += Vector3::new(0.0, 3.0, -1.0);
        }
        if name == 4 {
            marks[0].x += 80.0;
        }
    });
    let (basis, _) = placed(&mut block, &paths, &control, false);
    let Some(FrameBasis::Control {
        points,
        rms_m,
        offset,
        epsg,
        ..
    }) = basis
    else {
        panic!("{basis:?}")
    };
    assert_eq!(epsg, Some(25832));
    let agrees: Vec<bool> = points.iter().map(|p| p.agrees).collect();
    assert_eq!(agrees, [true, true, false, true, true, true, true]);
    assert_eq!(points[4].wrong_marks.len(), 1);
    let [_, y, z] = points[2].residual_m.unwrap().map(Option::unwrap);
    assert!((y + 3.0).abs() < 0.1 && (z - 1.0).abs() < 0.1, "{y} {z}");
    assert!(rms_m[0] < 0.03 && rms_m[1] < 0.06, "{rms_m:?}");
    for (a, b) in block.photos.iter().zip(&truth.photos) {
        let [a, b] = [a, b].map(|p| p.pose.as_ref().unwrap().center);
        let off = (a + Vector3::from(offset) - (b + OFFSET)).norm();
        assert!(off < 0.1, "{off} m");
    }
}

#[test]
fn too_few_points_or_points_on_a_line_give_no_frame() {
    let (_, block, paths, control) = listed(&well_seen(4), |name, _, marks| {
        marks.truncate(if name < 2 { 1 } else { 4 });
    });
    let refused = |control: &GroundControl| {
        let mut attempt = block.clone();
        let (basis, why) = placed(&mut attempt, &paths, control, false);
        assert_eq!(basis, None);
        assert_eq!(attempt.photos[0].pose, block.photos[0].pose);
        why
    };
    assert!(refused(&control).starts_with("2 of 4 ground control points"));
    let (_, _, _, control) = listed(&well_seen(4), |name, place, _| {
        *place = Point3::from(OFFSET + Vector3::new(5.0, 4.0, 0.1) * name as f64);
    });
    assert!(refused(&control).contains("on one line"));
}

/// Plants a change of the list's lines (coordinates, marks; the height of photographs is 300 px).
fn spoilt(change: impl Fn(&mut [f64; 3], &mut [f64; 2])) -> (Block, Block, Vec<String>, String) {
    let truth = planted(0.1, 3);
    let (_, block, paths, control) = listed(&well_seen(9), |_, _, _| {});
    let mut text = "EPSG:25832\n".to_owned();
    for point in &control.points {
        for (image, pixel) in &point.marks {
            let (mut place, mut mark) = (point.stated, [pixel.x, pixel.y]);
            change(&mut place, &mut mark);
            let ([x, y, z], [u, v]) = (place, mark);
            text += &format!("{x} {y} {z} {u} {v} {image} {}\n", point.name);
        }
    }
    (truth, block, paths, text)
}

#[test]
fn usual_mistakes_of_lists_are_named_and_mended() {
    let height = f64::from(planted(0.1, 3).cameras[0].size[1]);
    type Change = Box<dyn Fn(&mut [f64; 3], &mut [f64; 2])>;
    let cases: Vec<(Change, &str)> = vec![
        (Box::new(|p, _| p.swap(0, 1)), "x and y exchanged"),
        (Box::new(|p, _| p.swap(1, 2)), "height before the northing"),
        (
            Box::new(move |_, m| m[1] = height - m[1]),
            "rows of the marks counted from the lower",
        ),
        (
            Box::new(|_, m| m.swap(0, 1)),
            "row and column of the marks exchanged",
        ),
        (
            Box::new(|_, m| *m = m.map(|v| 1.5 * v)),
            "marks that fit photographs 1.50 times",
        ),
        (
            Box::new(|_, m| *m = m.map(|v| 4.0 * v)),
            "marks that fit photographs 4.00 times",
        ),
        (
            Box::new(|_, m| *m = m.map(|v| 6.85 * v)),
            "marks that fit photographs 6.85 times",
        ),
        (
            Box::new(|_, m| *m = m.map(|v| 0.5 * v)),
            "marks that fit photographs 0.50 times",
        ),
    ];
    for (change, words) in cases {
        let (truth, block, paths, text) = spoilt(change);
        let control = GroundControl::read("gcp_list.txt", &text).unwrap();
        let mut attempt = block.clone();
        let (basis, said) = placed(&mut attempt, &paths, &control, false);
        assert_eq!(basis, None, "{words}: {said}");
        assert_eq!(attempt.photos[0].pose, block.photos[0].pose);
        assert!(
            said.contains(words) && said.contains("--apply-fix"),
            "{words}: {said}"
        );
        let (basis, said) = placed(&mut attempt, &paths, &control, true);
        let Some(FrameBasis::Control { offset, .. }) = basis else {
            panic!("{words}: {said}")
        };
        assert!(said.contains("was read with"), "{said}");
        for (a, b) in attempt.photos.iter().zip(&truth.photos) {
            let [a, b] = [a, b].map(|p| p.pose.as_ref().unwrap().center);
            let off = (a + Vector3::from(offset) - (b + OFFSET)).norm();
            assert!(off < 0.3, "{words}: {off} m");
        }
    }
}

#[test]
fn units_of_a_list_give_the_same_metres() {
    let us = 1200.0 / 3937.0;
    for (system, plan, height) in [
        ("EPSG:2249", us, us),
        ("EPSG:2249", us, 1.0),
        ("EPSG:2249+5703", us, 1.0),
        ("EPSG:2249+6360", us, us),
        ("EPSG:6588", us, us),
        ("EPSG:2868", 0.3048, 0.3048),
        ("EPSG:2992+8228", 0.3048, 0.3048),
        ("EPSG:26986", 1.0, 1.0),
        ("+proj=lcc +lat_0=41 +units=us-ft", us, us),
        ("+proj=tmerc +lat_0=31 +to_meter=0.3048", 0.3048, 0.3048),
        ("PROJCS[\"x\",UNIT[\"Foot_US\",0.3048006096012192]]", us, us),
    ] {
        let (truth, mut block, paths, text) = spoilt(|p, _| {
            *p = [p[0] / plan, p[1] / plan, p[2] / height];
        });
        let text = text.replace("EPSG:25832", system);
        let control = GroundControl::read("gcp_list.txt", &text).unwrap();
        let (basis, said) = placed(&mut block, &paths, &control, false);
        let unit = basis.as_ref().map(FrameBasis::unit);
        let (Some(FrameBasis::Control { offset, .. }), Some(unit)) = (basis, unit) else {
            panic!("{system}: {said}")
        };
        let has_code = system.starts_with("EPSG");
        assert!((unit.metres - if has_code { plan } else { 1.0 }).abs() < 1e-9);
        for (a, b) in block.photos.iter().zip(&truth.photos) {
            let [a, b] = [a, b].map(|p| p.pose.as_ref().unwrap().center);
            let off = (a + Vector3::from(offset) - (b + OFFSET)).norm();
            assert!(off < 0.3, "{system} {height}: {off} m");
        }
    }
}

/// Degrees, minutes and seconds of an angle to the hundred thousandth of a second.
fn sexagesimal(deg: f64) -> [f64; 3] {
    let seconds = (deg.abs() * 3600.0 * 1e5).round() / 1e5;
    let minutes = (seconds / 60.0).floor();
    [
        (minutes / 60.0).floor(),
        minutes % 60.0,
        seconds - 60.0 * minutes,
    ]
}

#[test]
fn lists_in_the_forms_of_many_programs_give_the_same_frame() {
    use crate::orienting::orientation::{InputFile, TransverseMercator};
    let (truth, block, paths, text) = spoilt(|_, _| {});
    let lines = |system: &str, line: &dyn Fn(&[&str]) -> String| {
        let of = |text: &str| line(&text.split(' ').collect::<Vec<_>>());
        let lines: Vec<String> = text.lines().skip(1).map(of).collect();
        format!("{system}\n{}\n", lines.join("\n"))
    };
    let joined = |by: &'static str| move |f: &[&str]| f.join(by);
    let comma = |f: &[&str]| f[..5].join(" ").replace('.', ",") + " " + &f[5..].join(" ");
    let grid = TransverseMercator::of_epsg(25832).unwrap();
    let degrees = |f: &[&str], form: &dyn Fn([f64; 3], char) -> String| {
        let [x, y] = [f[0], f[1]].map(|v| v.parse().unwrap());
        let [lon, lat] = grid.geographic(x, y).map(sexagesimal);
        format!("{} {} {}", form(lon, 'E'), form(lat, 'N'), f[2..].join(" "))
    };
    let marks = |[d, m, s]: [f64; 3], letter: char| format!("{d}°{m}'{s:.5}\"{letter}");
    let before = |[d, m, s]: [f64; 3], letter: char| format!("{letter}{d}d{m}'{s:.5}");
    let colons = |[d, m, s]: [f64; 3], _: char| format!("{d}:{m}:{s:.5}");
    let decimal =
        |[d, m, s]: [f64; 3], letter: char| format!("{:.10}{letter}", d + m / 60.0 + s / 3600.0);
    let plain = lines("EPSG:25832", &joined(" "));
    let utf16: Vec<u8> = "\u{feff}"
        .encode_utf16()
        .chain(plain.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let forms: Vec<Vec<u8>> = [
        lines("EPSG:25832", &comma),
        lines("EPSG:25832", &|f| comma(f).replace(' ', ";")),
        lines("EPSG:25832", &joined("\t")),
        lines("EPSG:25832", &joined(",")),
        lines("EPSG:25832", &joined(", ")),
        lines("WGS 84 / UTM zone 32N", &joined(" ")),
        lines("ETRS89 UTM 32N", &joined(" ")),
        lines("25832", &joined(" ")),
        lines(
            "+proj=utm +zone=32 +ellps=GRS80 +units=m +no_defs",
            &joined(" "),
        ),
        lines("+PROJ=UTM +ZONE=32 +DATUM=WGS84", &joined(" ")),
        lines(
            "urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837",
            &joined(" "),
        ),
        lines("EPSG:25832", &|f| f.join(" ") + " 0.02 # seen"),
        format!(
            "\u{feff}# of the office\r\n\r\n{}",
            plain.replace('\n', "\r\n")
        ),
        lines("EPSG:4326", &|f| degrees(f, &marks)),
        lines("WGS84", &|f| degrees(f, &before)),
        lines("EPSG:4258", &|f| degrees(f, &colons)),
        lines("+proj=longlat +datum=WGS84", &|f| degrees(f, &decimal)),
    ]
    .map(String::into_bytes)
    .into_iter()
    .chain([utf16])
    .collect();
    let far = |block: &Block| {
        let [a, b] = [0, 8].map(|i| block.photos[i].pose.as_ref().unwrap().center);
        b - a
    };
    for bytes in forms {
        let shown: String = String::from_utf8_lossy(&bytes).chars().take(120).collect();
        let file = InputFile::new("GCP_list.txt", bytes);
        let control = GroundControl::among(&[file]).unwrap_or_else(|e| panic!("{e}: {shown}"));
        let mut block = block.clone();
        let (basis, said) = placed(&mut block, &paths, &control.unwrap(), false);
        let Some(FrameBasis::Control { points, .. }) = basis else {
            panic!("{shown}: {said}")
        };
        assert!(
            points.iter().all(|p| p.agrees) && said.is_empty(),
            "{shown}: {said}"
        );
        // Grid north is 0.7 degrees from true north there.
        let off = (far(&block) - far(&truth)).norm();
        assert!(off < 0.02 * far(&truth).norm(), "{shown}: {off} m");
    }
}

#[test]
fn names_are_matched_as_those_of_orientations_and_what_fits_nothing_is_named() {
    let (_, block, paths, text) = spoilt(|_, _| {});
    let with = |name: &dyn Fn(&str) -> String| {
        let lines = text.lines().map(|line| {
            let fields: Vec<String> = (line.split(' ').enumerate())
                .map(|(i, field)| {
                    if i == 5 {
                        name(field)
                    } else {
                        field.to_owned()
                    }
                })
                .collect();
            fields.join(" ")
        });
        let text = lines.collect::<Vec<_>>().join("\n");
        let control = GroundControl::read("gcp_list.txt", &text).unwrap();
        placed(&mut block.clone(), &paths, &control, false)
    };
    let stem = |name: &str| name.split('.').next().unwrap_or(name).to_owned();
    let fits: [&dyn Fn(&str) -> String; 5] = [
        &|n| stem(n),
        &|n| format!("D:\\flight\\images\\{n}"),
        &|n| format!("/home/x/{}.tif", stem(n)),
        &|n| n.to_lowercase(),
        &|n| format!("images/{n}"),
    ];
    for name in fits {
        let (basis, said) = with(name);
        assert!(basis.is_some() && said.is_empty(), "{said}");
    }
    let (basis, said) = with(&|n| format!("DJI_{n}"));
    assert_eq!(basis, None);
    assert!(
        said.contains("name no photograph that is there: DJI_p0.JPG"),
        "{said}"
    );
}

#[test]
fn headers_that_contradict_control_are_said() {
    let (truth, block, paths, text) = spoilt(|_, _| {});
    let (.., with_zone) = spoilt(|place, _| place[0] += 32e6);
    let (.., below) = spoilt(|place, _| place[2] = -300.0 - place[2]);
    let anchor = |lon_deg, lat_deg| crate::orienting::orientation::Anchor {
        lon_deg,
        lat_deg,
        height_m: 0.0,
    };
    let names: Vec<&str> = paths.iter().map(String::as_str).collect();
    let said = |text: &str, scale: f64, up_m: f64, anchor| {
        let stated: Vec<StatedPose> = (truth.photos.iter())
            .map(|p| StatedPose {
                position: (p.pose.as_ref()).map(|pose| pose.center * scale + Vector3::z() * up_m),
                ..StatedPose::default()
            })
            .collect();
        let beside = Beside {
            paths: &names,
            stated: &stated,
            anchor: Some(anchor),
            applies_fix: false,
        };
        let control = GroundControl::read("gcp_list.txt", text).unwrap();
        let (basis, words) = to_control(&mut block.clone(), &control, &beside);
        (basis.is_some(), words.join("\n"))
    };
    let here = anchor(8.0742, 48.8599);
    assert_eq!(said(&text, 1.0, 100.0, here), (true, String::new()));
    for (text, scale, up_m, anchor, is_used, expected) in [
        (
            &text,
            1.0,
            0.0,
            anchor(-71.0, 42.0),
            true,
            "km from the positions in the headers",
        ),
        (
            &text,
            1.0,
            660.0,
            here,
            true,
            "lie 660 m below the heights in the headers",
        ),
        (&text, 0.3048, 0.0, here, false, "3.281 times as far apart"),
        (
            &with_zone,
            1.0,
            0.0,
            here,
            false,
            "the number of the zone before the easting",
        ),
        (&below, 1.0, 300.0, here, false, "heights of the other sign"),
    ] {
        let (is_taken, words) = said(text, scale, up_m, anchor);
        assert_eq!(is_taken, is_used, "{words}");
        assert!(words.contains(expected), "{words}");
        assert_eq!(words.contains("not used"), !is_used, "{words}");
    }
}
