//! MicMac's `Orientation-IMAGE.xml`, one an image; the interior orientation is in it or in a file
//! that it names.
//!
//! * `CodageMatr` leads from the camera (x right, y down, z forward) to the world; `Centre` is the
//!   projection centre.
//! * F and PP are pixels. Assumption: counted from the corner of the image, since MicMac's first
//!   guess of PP is half the size.
//! * The distortion leads from ideal to measured pixels (`eConvApero_DistM2C`: M is the world, C
//!   the camera), about `CDist`, with `d = ideal - CDist` and `r = |d|`:
//!
//! ```text
//! measured = ideal + d (c0 r^2 + c1 r^4 + ...)
//!            + (P1 (r^2 + 2 dx^2) + 2 P2 dx dy + b1 dx + b2 dy, P2 (r^2 + 2 dy^2) + 2 P1 dx dy)
//! ```
//!
//! Divided by F it is ours. `Verif` holds points of the world and where MicMac itself saw them, so
//! that each file proves the convention: one that its camera misses by more than a pixel is
//! refused.

use nalgebra::{Matrix3, Point2, Point3, Vector3};
use roxmltree::Node;

use super::xml::{XmlReader, child, parse, text_of};
use crate::base::error::Result;
use crate::orienting::orientation::image_orientation::{Orientation, pinhole};
use crate::orienting::orientation::input_file::base_name;
use crate::photographs::camera::{Camera, Distortion};

/// Reads orientations and interior orientations, (path, text) each, in any order.
pub(crate) fn read<T: AsRef<str>>(files: &[(&str, T)]) -> Result<Vec<Orientation>> {
    let mut cameras = Vec::new();
    for (path, text) in files.iter().filter(|(path, _)| image_of(path).is_none()) {
        let document = parse(path, text.as_ref())?;
        let interior = document
            .descendants()
            .find(|n| n.has_tag_name("CalibrationInternConique"));
        if let Some(node) = interior {
            // One that no image names may be an unknown one.
            cameras.push((*path, MicmacCamera::read(&XmlReader { path }, node)));
        }
    }
    let mut found = Vec::new();
    for (path, text) in files {
        if let Some(image) = image_of(path) {
            found.push(orientation(path, image, text.as_ref(), &cameras)?);
        }
    }
    Ok(found)
}

/// The interior orientation that a file names: of several with that name, the one in the folder
/// that it names, then the one beside it.
fn named<'a>(
    cameras: &'a [(&str, Result<MicmacCamera>)],
    name: &str,
    path: &str,
) -> Option<&'a Result<MicmacCamera>> {
    let parts = |path: &'a str| -> Vec<&'a str> { path.rsplit(['/', '\\']).collect() };
    let fits = |of: &'a str| {
        let (of, beside) = (parts(of), folder(of) == folder(path));
        let wanted = name.rsplit(['/', '\\']);
        let same = of.iter().zip(wanted).take_while(|(a, b)| **a == *b);
        (same.count(), beside)
    };
    let fitting = cameras.iter().map(|(of, camera)| (fits(of), camera));
    let best = fitting.max_by_key(|(fit, _)| *fit);
    best.filter(|((same, _), _)| *same > 0)
        .map(|(_, camera)| camera)
}

fn folder(path: &str) -> &str {
    path.rsplit_once(['/', '\\'])
        .map_or("", |(folder, _)| folder)
}

/// The image that a file orients, by its name.
pub(crate) fn image_of(path: &str) -> Option<&str> {
    base_name(path)
        .strip_prefix("Orientation-")?
        .strip_suffix(".xml")
}

fn orientation(
    path: &str,
    image: &str,
    text: &str,
    cameras: &[(&str, Result<MicmacCamera>)],
) -> Result<Orientation> {
    let document = parse(path, text)?;
    let file = XmlReader { path };
    let find = |name: &str| document.descendants().find(|n| n.has_tag_name(name));
    let missing = |name: &str| file.error(document.root_element(), &format!("<{name}> is missing"));
    let exterior = find("Externe").ok_or_else(|| missing("Externe"))?;
    let center = file.child(exterior, "Centre")?;
    let matrix = find("CodageMatr").ok_or_else(|| missing("CodageMatr"))?;
    let row = |name: &str| {
        file.numbers::<3>(file.child(matrix, name)?)
            .map(Vector3::from)
    };
    let cam_from_world = Matrix3::from_columns(&[row("L1")?, row("L2")?, row("L3")?]);
    if let Some(node) = find("TypeProj").filter(|n| n.text() != Some("eProjStenope")) {
        let problem = "only central projections (eProjStenope) are supported";
        return Err(file.error(node, problem));
    }
    for name in ["OrIntImaM2C", "OrIntGlob"] {
        if let Some(node) = find(name) {
            refuse_affinity(&file, node)?;
        }
    }
    let inner = find("FileInterne").and_then(|n| n.text()).map(str::trim);
    let lens = match (find("Interne"), inner) {
        (Some(node), _) => MicmacCamera::read(&file, node)?,
        (None, Some(name)) => named(cameras, name, path).cloned().unwrap_or_else(|| {
            let name = base_name(name);
            let problem = format!("its interior orientation {name} is not among the files");
            Err(file.error(exterior, &problem))
        })?,
        (None, None) => return Err(missing("Interne")),
    };
    let center = Point3::from(file.numbers::<3>(center)?);
    let found = Orientation {
        distortion: lens.distortion,
        size: Some(lens.size),
        ..pinhole(image, path, lens.k, cam_from_world, center)
    };
    if let Some(points) = find("Verif") {
        verify(&file, points, &found)?;
    }
    Ok(found)
}

/// Images that MicMac maps to its camera by an affinity (scanned ones).
fn refuse_affinity(file: &XmlReader, node: Node) -> Result<()> {
    let neutral = [
        ("I00", [0.0, 0.0]),
        ("V10", [1.0, 0.0]),
        ("V01", [0.0, 1.0]),
    ];
    for part in node.descendants().filter(Node::is_element) {
        let expected = neutral.iter().find(|(name, _)| part.has_tag_name(*name));
        if let Some((_, expected)) = expected
            && file.numbers::<2>(part)? != *expected
        {
            let problem = "an affinity between image and camera is not supported; resample the \
                           images (mm3d ReSampFid)";
            return Err(file.error(node, problem));
        }
    }
    Ok(())
}

/// Compares the points that MicMac itself projected with where this camera sees them.
fn verify(file: &XmlReader, points: Node, found: &Orientation) -> Result<()> {
    // The points are written by the same model: what is a whole pixel away was another one.
    // Assumption.
    const TOLERANCE_PX: f64 = 1.0;
    let (width, height) = found.size.unwrap_or_default();
    let camera = Camera {
        k: found.k,
        r: found.r,
        center: found.center,
        width,
        height,
    };
    let lens = found.distortion.unwrap_or_default();
    for point in points.children().filter(|n| n.has_tag_name("Appuis")) {
        let (Some(image), Some(world)) = (child(point, "Im"), child(point, "Ter")) else {
            continue;
        };
        let stated = Point2::from(file.numbers::<2>(image)?);
        let ideal = camera.project(&Point3::from(file.numbers::<3>(world)?));
        let seen = ideal.map(|ideal| lens.measured(&found.k, &ideal));
        let off_px = seen.map_or(f64::INFINITY, |seen| (seen - stated).norm());
        if off_px.is_nan() || off_px > TOLERANCE_PX {
            let problem = format!(
                "this point lies {off_px:.1} px from where the orientation and its interior \
                 orientation project it"
            );
            let expected = "the interior orientation that MicMac computed it with";
            return Err(file.refusal(point, &problem, expected));
        }
    }
    Ok(())
}

#[derive(Clone)]
struct MicmacCamera {
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
    size: (u32, u32),
}

impl MicmacCamera {
    fn read(file: &XmlReader, node: Node) -> Result<Self> {
        let numbers = |name: &str| file.numbers::<2>(file.child(node, name)?);
        let (pp, size) = (numbers("PP")?, numbers("SzIm")?);
        let f = file.number(node, "F")?;
        if text_of(node, "KnownConv").is_some_and(|c| c != "eConvApero_DistM2C") {
            return Err(file.error(node, "only the convention eConvApero_DistM2C is supported"));
        }
        let mut lens = Self {
            k: Matrix3::new(f, 0.0, pp[0], 0.0, f, pp[1], 0.0, 0.0, 1.0),
            distortion: None,
            size: (size[0] as u32, size[1] as u32),
        };
        for model in node
            .children()
            .filter(|n| n.has_tag_name("CalibDistortion"))
        {
            let next = distortion(file, model, f, pp)?;
            if next.is_some() && lens.distortion.is_some() {
                return Err(file.error(model, ONE_MODEL));
            }
            lens.distortion = lens.distortion.or(next);
        }
        Ok(lens)
    }
}

const ONE_MODEL: &str = "only one radial model (ModRad) or Fraser's (ModPhgrStd) is supported: \
                         calibrate with FraserBasic, or undistort the images with mm3d Drunk";

/// The lens of `<ModRad>` or `<ModPhgrStd>`, none where all terms are zero.
fn distortion(file: &XmlReader, model: Node, f: f64, pp: [f64; 2]) -> Result<Option<Distortion>> {
    let known = ["ModRad", "ModPhgrStd", "ModNoDist"];
    let named = |n: &Node| known.contains(&n.tag_name().name());
    if let Some(node) = model.children().find(|n| n.is_element() && !named(n)) {
        let kind = text_of(node, "TypeModele").unwrap_or_default();
        return Err(file.error(node, format!("{kind} {ONE_MODEL}").trim()));
    }
    let of = |name: &str| model.descendants().find(|n| n.has_tag_name(name));
    let Some(middle) = of("CDist") else {
        return Ok(None);
    };
    let middle = file.numbers::<2>(middle)?;
    let term = |name: &str| of(name).map_or(Ok(0.0), |n| Ok(file.numbers::<1>(n)?[0]));
    // From pixels to focal lengths.
    let mut unit = 1.0;
    let mut lens = Distortion {
        tangential: [term("P2")? * f, term("P1")? * f],
        affine: [term("b1")?, term("b2")?],
        ..Distortion::default()
    };
    let coefficients = model.descendants().filter(|n| n.has_tag_name("CoeffDist"));
    for (i, node) in coefficients.enumerate() {
        let [c] = file.numbers::<1>(node)?;
        unit *= f * f;
        match lens.radial.get_mut(i) {
            Some(place) => *place = c * unit,
            None if c == 0.0 => {}
            None => return Err(file.error(node, "more than ten radial terms are not supported")),
        }
    }
    if lens == Distortion::default() {
        return Ok(None);
    }
    lens.center = [0, 1].map(|i| (middle[i] - pp[i]) / f);
    Ok(Some(lens))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An orientation whose camera stands 100 m above the origin, and its interior orientation.
    fn files(distortion: &str, points: &str) -> [(&'static str, String); 2] {
        let interior = format!(
            "<E><CalibrationInternConique><KnownConv>eConvApero_DistM2C</KnownConv><PP>1000 750</PP><F>2000</F>\
             <SzIm>2000 1500</SzIm><CalibDistortion>{distortion}</CalibDistortion></CalibrationInternConique></E>"
        );
        let exterior = format!(
            "<E><OrientationConique><TypeProj>eProjStenope</TypeProj><FileInterne>Ori-A/AutoCal.xml</FileInterne>\
             <Externe><Centre>0 0 100</Centre><ParamRotation><CodageMatr><L1>1 0 0</L1><L2>0 -1 0</L2><L3>0 0 -1</L3>\
             </CodageMatr></ParamRotation></Externe><Verif>{points}</Verif></OrientationConique></E>"
        );
        [
            ("Ori-A/Orientation-a.jpg.xml", exterior),
            ("Ori-A/AutoCal.xml", interior),
        ]
    }

    fn measured(found: &Orientation, ideal: [f64; 2]) -> Point2<f64> {
        let lens = found.distortion.unwrap();
        lens.measured(&found.k, &Point2::from(ideal))
    }

    #[test]
    fn frasers_model_leads_from_ideal_to_measured_about_its_own_centre() {
        let (c, [p1, p2], [b1, b2]) = (
            [-1e-8, 2e-15, -3e-22, 4e-29, -5e-36],
            [3e-7, -2e-7],
            [1e-4, -4e-4],
        );
        let coefficients: String = c.map(|c| format!("<CoeffDist>{c}</CoeffDist>")).concat();
        let found = &read(&files(
            &format!(
                "<ModPhgrStd><RadialePart><CDist>1008 744</CDist>{coefficients}</RadialePart>\
                 <P1>{p1}</P1><P2>{p2}</P2><b1>{b1}</b1><b2>{b2}</b2></ModPhgrStd>"
            ),
            "",
        ))
        .unwrap()[0];
        for ideal in [[20.0, 30.0], [1900.0, 700.0], [1200.0, 1400.0]] {
            let [x, y] = [ideal[0] - 1008.0, ideal[1] - 744.0];
            let r2: f64 = x * x + y * y;
            let g = c.iter().rev().fold(0.0, |sum, c| (sum + c) * r2);
            let dx = x * g + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y + b1 * x + b2 * y;
            let dy = y * g + p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y;
            let expected = Point2::new(ideal[0] + dx, ideal[1] + dy);
            // 16 px of distortion at the corner.
            assert!(
                (measured(found, ideal) - expected).norm() < 1e-9,
                "{expected}"
            );
        }
    }

    #[test]
    fn the_points_that_micmac_projected_prove_the_file() {
        // 30 m east and 20 m north: 600 px right and 400 px up of the centre.
        let lens = "<ModRad><CDist>1000 750</CDist><CoeffDist>-2e-8</CoeffDist></ModRad>";
        let g = -2e-8 * (600.0 * 600.0 + 400.0 * 400.0);
        let point = |g: f64| {
            let (x, y) = (1000.0 + 600.0 * (1.0 + g), 750.0 - 400.0 * (1.0 + g));
            format!("<Appuis><Im>{x} {y}</Im><Ter>30 20 0</Ter></Appuis>")
        };
        let found = &read(&files(lens, &point(g))).unwrap()[0];
        let seen = measured(found, [1600.0, 350.0]);
        assert!(
            (seen - Point2::new(1000.0 + 600.0 * (1.0 + g), 750.0 - 400.0 * (1.0 + g))).norm()
                < 1e-9
        );
        // The other direction would put it 15 px away.
        let refusal = read(&files(lens, &point(-g))).unwrap_err().to_string();
        assert!(
            refusal.contains("Orientation-a.jpg.xml, line 1: <Appuis>: this point lies 15.0 px"),
            "{refusal}"
        );
    }

    #[test]
    fn of_interior_orientations_with_one_name_the_folder_decides() {
        let [exterior, (_, interior)] = files("<ModNoDist/>", "");
        let other = interior.replace("2000</F>", "1900</F>");
        for order in [false, true] {
            let mut files = vec![
                exterior.clone(),
                ("Ori-A/AutoCal.xml", interior.clone()),
                ("Ori-B/AutoCal.xml", other.clone()),
            ];
            if order {
                files.reverse();
            }
            let found = read(&files).unwrap();
            assert_eq!((found[0].k[(0, 0)], found[0].distortion), (2000.0, None));
        }
    }

    #[test]
    fn projections_and_conventions_that_are_not_read_are_named() {
        let [exterior, interior] = files("<ModNoDist/>", "");
        let message = |exterior: &str, interior: &str| {
            let files = [
                ("Ori-A/Orientation-a.jpg.xml", exterior),
                ("Ori-A/AutoCal.xml", interior),
            ];
            read(&files).map(|_| ()).map_err(|e| e.to_string())
        };
        let affinity = |i00: &str| {
            let parts = format!("<I00>{i00}</I00><V10>1 0</V10><V01>0 1</V01>");
            let node = format!("<OrIntImaM2C>{parts}</OrIntImaM2C><Externe>");
            exterior.1.replace("<Externe>", &node)
        };
        assert_eq!(message(&affinity("0 0"), &interior.1), Ok(()));
        let ortho = exterior.1.replace("eProjStenope", "eProjOrtho");
        let other = interior.1.replace("DistM2C", "DistC2M");
        for (refusal, word) in [
            (message(&affinity("3 0"), &interior.1), "ReSampFid"),
            (message(&ortho, &interior.1), "eProjStenope"),
            (message(&exterior.1, &other), "eConvApero_DistM2C"),
        ] {
            let refusal = refusal.unwrap_err();
            assert!(refusal.contains(word), "{refusal}");
        }
    }

    #[test]
    fn models_that_are_not_read_are_named() {
        let unified =
            "<ModUnif><TypeModele>eModele_FishEye_10_5_5</TypeModele><Params>1</Params></ModUnif>";
        let refusal = read(&files(unified, "")).unwrap_err().to_string();
        assert!(
            refusal.contains("eModele_FishEye_10_5_5") && refusal.contains("Drunk"),
            "{refusal}"
        );
        // Where no image names it, it does no harm.
        let [exterior, used] = files("<ModNoDist/>", "");
        let unused = files(unified, "")[1].1.clone();
        let files = [exterior, used, ("Ori-A/AutoCal_other.xml", unused)];
        assert_eq!(read(&files).unwrap().len(), 1);
    }
}
