//! MicMac's `Orientation-IMAGE.xml`, one an image; the interior orientation is in it or in a file
//! that it names.
//!
//! * `CodageMatr` leads from the camera (x right, y down, z forward) to the world; `Centre` is the
//!   projection centre.
//! * F and PP are pixels. Assumption: counted from the corner of the image, since MicMac's first
//!   guess of PP is half the size.
//! * The polynomial about `CDist` leads from measured to ideal coordinates (`eConvApero_DistM2C`),
//!   in pixels. Ours goes the other way: a polynomial about the same centre is fitted to the
//!   inverse.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point2, Point3, Vector3};
use roxmltree::Node;

use super::xml::{XmlReader, child, parse, text_of};
use crate::camera::Distortion;
use crate::error::Result;
use crate::orientation::image_orientation::{Orientation, pinhole};

/// Reads orientations and interior orientations, (path, text) each, in any order.
pub(crate) fn read<T: AsRef<str>>(files: &[(&str, T)]) -> Result<Vec<Orientation>> {
    let mut lenses = BTreeMap::new();
    for (path, text) in files.iter().filter(|(path, _)| image_of(path).is_none()) {
        let document = parse(path, text.as_ref())?;
        if let Some(node) = document
            .descendants()
            .find(|n| n.has_tag_name("CalibrationInternConique"))
        {
            lenses.insert(
                base_name(path),
                MicmacCamera::read(&XmlReader { path }, node)?,
            );
        }
    }
    let mut found = Vec::new();
    for (path, text) in files {
        if let Some(image) = image_of(path) {
            found.push(orientation(path, image, text.as_ref(), &lenses)?);
        }
    }
    Ok(found)
}

/// The image that a file orients, by its name.
pub(crate) fn image_of(path: &str) -> Option<&str> {
    base_name(path)
        .strip_prefix("Orientation-")?
        .strip_suffix(".xml")
}

fn base_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

fn orientation(
    path: &str,
    image: &str,
    text: &str,
    lenses: &BTreeMap<&str, MicmacCamera>,
) -> Result<Orientation> {
    let document = parse(path, text)?;
    let file = XmlReader { path };
    let find = |name: &str| document.descendants().find(|n| n.has_tag_name(name));
    let missing = |name: &str| file.error(document.root_element(), &format!("<{name}> is missing"));
    let exterior = find("Externe").ok_or_else(|| missing("Externe"))?;
    let center = child(exterior, "Centre").ok_or_else(|| missing("Centre"))?;
    let matrix = find("CodageMatr").ok_or_else(|| missing("CodageMatr"))?;
    let mut rows = Vec::new();
    for name in ["L1", "L2", "L3"] {
        let row = child(matrix, name)
            .ok_or_else(|| file.error(matrix, &format!("<{name}> is missing")))?;
        rows.extend(file.numbers::<3>(row)?);
    }
    let world_from_cam = Matrix3::from_row_slice(&rows);
    let own = match find("Interne") {
        Some(node) => Some(MicmacCamera::read(&file, node)?),
        None => None,
    };
    let named = find("FileInterne")
        .and_then(|n| n.text())
        .map(|t| base_name(t.trim()));
    let lens = own.as_ref().or_else(|| lenses.get(named?));
    let lens = lens.ok_or_else(|| {
        let name = named.unwrap_or("<Interne>");
        file.error(
            exterior,
            &format!("its interior orientation {name} is not among the files"),
        )
    })?;
    Ok(Orientation {
        distortion: lens.distortion,
        size: Some(lens.size),
        ..pinhole(
            image,
            path,
            lens.k,
            world_from_cam.transpose(),
            Point3::from(file.numbers::<3>(center)?),
        )
    })
}

struct MicmacCamera {
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
    size: (u32, u32),
}

impl MicmacCamera {
    fn read(file: &XmlReader, node: Node) -> Result<Self> {
        let numbers = |name: &str| {
            let found = child(node, name)
                .ok_or_else(|| file.error(node, &format!("<{name}> is missing")))?;
            file.numbers::<2>(found)
        };
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
        if let Some(model) = child(node, "CalibDistortion") {
            lens.distortion = distortion(file, model, &lens)?;
        }
        Ok(lens)
    }
}

/// The lens, ideal to measured, of the radial polynomial, measured to ideal.
fn distortion(file: &XmlReader, model: Node, lens: &MicmacCamera) -> Result<Option<Distortion>> {
    let other = |n: &Node| {
        n.is_element() && !["ModRad", "ModPhgrStd", "ModNoDist"].contains(&n.tag_name().name())
    };
    if let Some(node) = model.children().find(other) {
        return Err(file.error(
            node,
            "only radial distortion (ModRad) is supported; undistort the images",
        ));
    }
    for name in ["P1", "P2", "b1", "b2"] {
        let term = model.descendants().find(|n| n.has_tag_name(name));
        if let Some(node) = term.filter(|n| n.text().is_some_and(|t| t.trim().parse() != Ok(0.0))) {
            return Err(file.error(
                node,
                "only radial distortion is supported; undistort the images",
            ));
        }
    }
    let find = |name: &str| model.descendants().find(|n| n.has_tag_name(name));
    let Some(middle) = find("CDist") else {
        return Ok(None);
    };
    let middle = Point2::from(file.numbers::<2>(middle)?);
    let mut coefficients = Vec::new();
    for node in model.descendants().filter(|n| n.has_tag_name("CoeffDist")) {
        coefficients.extend(file.numbers::<1>(node)?);
    }
    if coefficients.iter().all(|&c| c == 0.0) {
        return Ok(None);
    }
    let ideal = |measured: &Point2<f64>| {
        let d = measured - middle;
        let r2 = d.norm_squared();
        let g = coefficients.iter().rev().fold(0.0, |sum, c| (sum + c) * r2);
        measured + d * g
    };
    let fitted = fit(ideal, middle, lens);
    fitted.map(Some).ok_or_else(|| {
        file.error(
            model,
            "no polynomial comes near its inverse; undistort the images",
        )
    })
}

/// The radial polynomial (ideal to measured) about `middle` that undoes a map from measured to
/// ideal pixels, by least squares over the image; `None` where it misses by more than a twentieth
/// of a pixel.
fn fit(
    ideal: impl Fn(&Point2<f64>) -> Point2<f64>,
    middle: Point2<f64>,
    lens: &MicmacCamera,
) -> Option<Distortion> {
    const STEPS: u32 = 16;
    const WORST_PX: f64 = 0.05;
    let (f, pp) = (lens.k[(0, 0)], Point2::new(lens.k[(0, 2)], lens.k[(1, 2)]));
    let (width, height) = (f64::from(lens.size.0), f64::from(lens.size.1));
    let t = |i: u32| f64::from(i) / f64::from(STEPS);
    let places = (0..=STEPS)
        .flat_map(|i| (0..=STEPS).map(move |j| Point2::new(t(i) * width, t(j) * height)));
    let pairs: Vec<(Point2<f64>, Point2<f64>)> = places.map(|p| (ideal(&p), p)).collect();
    // Scaled by the farthest point, so that high powers keep their precision.
    let far = (pairs.iter().map(|(from, _)| (from - middle).norm())).fold(0.0, f64::max);
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (from, to) in &pairs {
        let (d, change) = ((from - middle) / far, (to - from) / far);
        let r2 = d.norm_squared();
        for axis in 0..2 {
            let row = Vector3::new(r2, r2 * r2, r2 * r2 * r2) * d[axis];
            normal += row * row.transpose();
            right += row * change[axis];
        }
    }
    let c = normal.cholesky()?.solve(&right);
    // From the farthest point to the focal length as the unit.
    let unit2 = (f / far) * (f / far);
    let center = (middle - pp) / f;
    let found = Distortion {
        radial: [
            c[0] * unit2,
            c[1] * unit2 * unit2,
            c[2] * unit2 * unit2 * unit2,
            0.0,
        ],
        radial_below: [0.0; 3],
        tangential: [0.0; 2],
        center: center.into(),
    };
    let miss = |(from, to): &(Point2<f64>, Point2<f64>)| {
        (pp + found.distort(&Point2::from((from - pp) / f)).coords * f - to).norm()
    };
    (pairs.iter().map(miss).fold(0.0, f64::max) < WORST_PX).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fitted_lens_undoes_the_polynomial_about_its_own_centre() {
        let text = "<C><PP>1000 750</PP><F>2000</F><SzIm>2000 1500</SzIm><CalibDistortion><ModRad><CDist>1008 744</CDist>\
                    <CoeffDist>-1e-8</CoeffDist><CoeffDist>2e-15</CoeffDist></ModRad></CalibDistortion></C>";
        let document = parse("c.xml", text).unwrap();
        let lens =
            MicmacCamera::read(&XmlReader { path: "c.xml" }, document.root_element()).unwrap();
        let distortion = lens.distortion.unwrap();
        for measured in [[20.0, 30.0], [1900.0, 700.0], [1200.0, 1400.0]] {
            let d = [measured[0] - 1008.0, measured[1] - 744.0];
            let r2 = d[0] * d[0] + d[1] * d[1];
            let g = -1e-8 * r2 + 2e-15 * r2 * r2;
            let ideal = [measured[0] + d[0] * g, measured[1] + d[1] * g];
            let ideal = Point2::new((ideal[0] - 1000.0) / 2000.0, (ideal[1] - 750.0) / 2000.0);
            let back = distortion.distort(&ideal) * 2000.0;
            let error = [back.x + 1000.0 - measured[0], back.y + 750.0 - measured[1]];
            // 16 px of distortion at the corner; the shift of the centre alone is 0.2 px there.
            assert!(error[0].abs() < 0.01 && error[1].abs() < 0.01, "{error:?}");
        }
    }
}
