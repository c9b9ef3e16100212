//! Planted blocks and control points on their map.

use nalgebra::{Point3, Vector3};

use super::*;
use crate::base::geometry::rotation_from_axis_angle;
use crate::orienting::structure_from_motion::block::Block;
use crate::orienting::structure_from_motion::bundle::tests::planted;
use crate::orienting::structure_from_motion::frame::{FrameBasis, StatedPose};
use crate::orienting::structure_from_motion::similarity::Similarity;

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
    let [_, y, z] = points[2].residual_m.unwrap();
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
        let Some(FrameBasis::Control { offset, unit, .. }) = basis else {
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
    let anchor = |lon_deg, lat_deg| crate::orienting::orientation::Anchor {
        lon_deg,
        lat_deg,
        height_m: 0.0,
    };
    let names: Vec<&str> = paths.iter().map(String::as_str).collect();
    let said = |scale: f64, anchor| {
        let stated: Vec<StatedPose> = (truth.photos.iter())
            .map(|p| StatedPose {
                position: p.pose.as_ref().map(|pose| pose.center * scale),
                ..StatedPose::default()
            })
            .collect();
        let beside = Beside {
            paths: &names,
            stated: &stated,
            anchor: Some(anchor),
            applies_fix: false,
        };
        let control = GroundControl::read("gcp_list.txt", &text).unwrap();
        let (basis, words) = to_control(&mut block.clone(), &control, &beside);
        (basis.is_some(), words.join("\n"))
    };
    let here = anchor(8.0742, 48.8599);
    assert_eq!(said(1.0, here), (true, String::new()));
    let (is_taken, words) = said(1.0, anchor(-71.0, 42.0));
    assert!(
        is_taken && words.contains("km from the positions in the headers"),
        "{words}"
    );
    let (_, words) = said(0.3048, here);
    assert!(words.contains("3.281 times as far apart"), "{words}");
}
