//! Points that check, and points of which the plan or the height alone is known.

use super::*;
use crate::orienting::structure_from_motion::similarity_fit::KnownOf;

/// A list of so many points with what stands behind their names; `change` spoils a place.
fn with_roles(
    roles: &[&str],
    change: impl Fn(usize, &mut Point3<f64>),
) -> (Block, Block, Vec<String>, String) {
    let numbers = well_seen(roles.len());
    let (truth, block, paths, control) = listed(&numbers, |i, place, _| change(i, place));
    let mut text = "EPSG:25832\n".to_owned();
    for (point, role) in control.points.iter().zip(roles) {
        let [x, y, z] = point.stated;
        for (image, pixel) in &point.marks {
            text += &format!(
                "{x} {y} {z} {} {} {image} {} {role}\n",
                pixel.x, pixel.y, point.name
            );
        }
    }
    (truth, block, paths, text)
}

/// The block in the frame of a list, what the frame rests on, and what is said.
fn framed(
    block: &Block,
    paths: &[String],
    text: &str,
) -> (Block, Vec<ControlResidual>, [f64; 2], String) {
    let control = GroundControl::read("gcp_list.txt", text).unwrap();
    let mut block = block.clone();
    match placed(&mut block, paths, &control, false) {
        (Some(FrameBasis::Control { points, rms_m, .. }), said) => (block, points, rms_m, said),
        (basis, said) => panic!("{basis:?} {said}"),
    }
}

/// Largest distance of the projection centres from the truth, in plan and in height.
fn off(block: &Block, truth: &Block) -> [f64; 2] {
    let centers = |b: &Block, i: usize| b.photos[i].pose.as_ref().unwrap().center;
    (0..9).fold([0.0, 0.0f64], |[plan, height], i| {
        let d = centers(block, i) - centers(truth, i);
        [d.xy().norm().max(plan), d.z.abs().max(height)]
    })
}

#[test]
fn check_points_do_not_move_the_frame_and_are_reported_apart() {
    let mut roles = ["check"; 7];
    roles[..5].fill("");
    let (_, block, paths, text) = with_roles(&roles, |i, place| {
        if i == 6 {
            *place += Vector3::new(0.0, 5.0, -2.0);
        }
    });
    let without: String = (text.lines())
        .filter(|line| !line.ends_with("check"))
        .flat_map(|line| [line, "\n"])
        .collect();
    let (alone, _, rms_alone, _) = framed(&block, &paths, &without);
    let (with, points, rms, said) = framed(&block, &paths, &text);
    for (a, b) in with.photos.iter().zip(&alone.photos) {
        assert_eq!(a.pose, b.pose);
    }
    assert_eq!((rms, said.as_str()), (rms_alone, ""));
    let checks: Vec<&ControlResidual> = points.iter().filter(|p| p.role.is_check).collect();
    let agrees: Vec<bool> = checks.iter().map(|p| p.agrees).collect();
    assert_eq!(agrees, [true, false]);
    let [_, y, z] = checks[1].residual_m.unwrap().map(Option::unwrap);
    assert!((y + 5.0).abs() < 0.1 && (z - 2.0).abs() < 0.1, "{y} {z}");
    let [plan, height] = rms_m(checks.into_iter()).map(Option::unwrap);
    assert!((plan - 5.0 / 2f64.sqrt()).abs() < 0.1, "{plan}");
    assert!((height - 2.0 / 2f64.sqrt()).abs() < 0.1, "{height}");
}

#[test]
fn points_of_plan_or_height_alone_move_only_that() {
    let roles = ["", "", "", "", "plan", "plan", "height", "HEIGHT # seen"];
    let wrong = |i: usize, place: &mut Point3<f64>| match i {
        4 | 5 => place.z += 50.0,
        6 | 7 => *place += Vector3::new(-300.0, 40.0, 0.0),
        _ => {}
    };
    let (truth, block, paths, text) = with_roles(&roles, wrong);
    let (found, points, ..) = framed(&block, &paths, &text);
    let [plan, height] = off(&found, &with_offset(&truth));
    assert!(plan < 0.1 && height < 0.1, "{plan} {height}");
    assert!(points.iter().all(|p| p.agrees), "{points:?}");
    let known = |i: usize| points[i].residual_m.unwrap().map(|d| d.is_some());
    assert_eq!(known(4), [true, true, false]);
    assert_eq!(known(7), [false, false, true]);
    assert_eq!(points[7].role.known, KnownOf::Height);
}

/// The truth where the map of the list has it.
fn with_offset(truth: &Block) -> Block {
    let mut moved = truth.clone();
    let control = GroundControl::read("gcp_list.txt", &with_roles(&[""], |_, _| {}).3).unwrap();
    let similarity = Similarity {
        shift: OFFSET - control.offset,
        ..Similarity::default()
    };
    similarity.apply(&mut moved);
    moved
}

#[test]
fn two_points_in_plan_and_three_in_height_are_enough() {
    let roles = ["plan", "plan", "height", "height", "height"];
    let (truth, block, paths, text) = with_roles(&roles, |_, _| {});
    let (found, points, ..) = framed(&block, &paths, &text);
    let [plan, height] = off(&found, &with_offset(&truth));
    assert!(plan < 0.4 && height < 0.6, "{plan} {height} {points:?}");
    let refused = |roles: &[&str]| {
        let (_, block, paths, text) = with_roles(roles, |_, _| {});
        let control = GroundControl::read("gcp_list.txt", &text).unwrap();
        let (basis, said) = placed(&mut block.clone(), &paths, &control, false);
        assert_eq!(basis, None);
        said
    };
    let said = refused(&["plan", "height", "height", "height"]);
    assert!(
        said.contains("two in plan and 3 in height (1 and 3 are)"),
        "{said}"
    );
    let said = refused(&["", "", "check", "check"]);
    assert!(said.contains("2 of 2 ground control points"), "{said}");
}

#[test]
fn roles_are_read_in_all_forms_and_what_is_none_is_named() {
    let read = |text: &str| GroundControl::read("gcp_list.txt", text);
    let line = |more: &str| format!("EPSG:25832\n1 2 3 4 5 a.jpg{more}\n");
    for (more, role) in [
        ("", "control"),
        (" p", "control"),
        (" p control 0.02", "control"),
        (" p 0.02 Check", "check"),
        (" p plan # check", "plan"),
        (" p check height", "check height"),
        (" p plan,check", "check plan"),
    ] {
        let control = read(&line(more)).unwrap();
        assert_eq!(control.points[0].role.to_string(), role, "{more}");
        assert_eq!(control.words(), None, "{more}");
    }
    let control = read(&line(" p chekc")).unwrap();
    assert!(!control.points[0].role.is_check);
    let said = control.words().unwrap();
    assert!(
        said.contains("no role: chekc") && said.contains("check height"),
        "{said}"
    );
    for (text, words) in [
        (line(" check"), "line 2: 'check' where the name"),
        (
            line(" p check") + "1 2 3 6 7 b.jpg p\n1 2 3 6 7 c.jpg p plan\n",
            "line 4: point p is for check above, not plan",
        ),
    ] {
        let message = read(&text).unwrap_err().to_string();
        assert!(message.contains(words), "{message}");
    }
    let control = read(&(line(" p") + "1 2 3 6 7 b.jpg p check\n1 2 3 8 9 c.jpg p\n")).unwrap();
    assert!(control.points[0].role.is_check);
}
