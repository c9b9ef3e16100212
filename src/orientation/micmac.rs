//! MicMac's `Orientation-IMAGE.xml`, one an image; the interior orientation stands in it or in a file that it names.
//!
//! * `CodageMatr` leads from the camera (x right, y down, z forward) to the world; `Centre` is the projection centre.
//! * F and PP are pixels. Assumption: counted from the corner of the image, since MicMac's first guess of PP is half the size.
//! * The polynomial about `CDist` leads from measured to ideal coordinates (`eConvApero_DistM2C`), in pixels. Ours goes the other way:
//!   the inverse series is used; a centre that is not PP makes the tangential terms of first order p = k1 (CDist - PP) / F.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3};
use roxmltree::Node;

use super::xml::{Reader, child, parse, text_of};
use super::{Orientation, pinhole};
use crate::Result;
use crate::camera::Distortion;

/// Reads orientations and interior orientations, (path, text) each, in any order.
pub(super) fn read<T: AsRef<str>>(files: &[(&str, T)]) -> Result<Vec<Orientation>> {
    let mut lenses = BTreeMap::new();
    for (path, text) in files.iter().filter(|(path, _)| image_of(path).is_none()) {
        let document = parse(path, text.as_ref())?;
        if let Some(node) = document
            .descendants()
            .find(|n| n.has_tag_name("CalibrationInternConique"))
        {
            lenses.insert(base_name(path), Lens::read(&Reader { path }, node)?);
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
pub(super) fn image_of(path: &str) -> Option<&str> {
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
    lenses: &BTreeMap<&str, Lens>,
) -> Result<Orientation> {
    let document = parse(path, text)?;
    let file = Reader { path };
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
        Some(node) => Some(Lens::read(&file, node)?),
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

struct Lens {
    k: Matrix3<f64>,
    distortion: Option<Distortion>,
    size: (u32, u32),
}

impl Lens {
    fn read(file: &Reader, node: Node) -> Result<Self> {
        let numbers = |name: &str| {
            let found = child(node, name)
                .ok_or_else(|| file.error(node, &format!("<{name}> is missing")))?;
            Ok::<_, crate::Error>(file.numbers::<2>(found)?)
        };
        let (pp, size) = (numbers("PP")?, numbers("SzIm")?);
        let f = file.number(node, "F")?;
        if text_of(node, "KnownConv").is_some_and(|c| c != "eConvApero_DistM2C") {
            return Err(file.error(node, "only the convention eConvApero_DistM2C is supported"));
        }
        let distortion = match child(node, "CalibDistortion") {
            Some(model) => distortion(file, model, f, pp)?,
            None => None,
        };
        Ok(Self {
            k: Matrix3::new(f, 0.0, pp[0], 0.0, f, pp[1], 0.0, 0.0, 1.0),
            distortion,
            size: (size[0] as u32, size[1] as u32),
        })
    }
}

/// Brown's coefficients, ideal to measured, of the radial polynomial, measured to ideal.
fn distortion(file: &Reader, model: Node, f: f64, pp: [f64; 2]) -> Result<Option<Distortion>> {
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
    let middle = file.numbers::<2>(middle)?;
    let mut k = [0.0; 3];
    let coefficients = model.descendants().filter(|n| n.has_tag_name("CoeffDist"));
    for (i, node) in coefficients.enumerate() {
        let [value] = file.numbers::<1>(node)?;
        let scale = (0..=i.min(3)).fold(1.0, |scale, _| scale * f * f);
        match k.get_mut(i) {
            Some(k) => *k = value * scale,
            None if value == 0.0 => {}
            None => {
                return Err(file.error(
                    node,
                    "more than three coefficients of distortion are not supported",
                ));
            }
        }
    }
    let [k1, k2, k3] = k;
    let radial = [
        -k1,
        3.0 * k1 * k1 - k2,
        -12.0 * k1 * k1 * k1 + 8.0 * k1 * k2 - k3,
    ];
    let shift = [0, 1].map(|i| (middle[i] - pp[i]) / f);
    // p1 goes with y and p2 with x in our formula; the linear term is that of the inverse, -k1.
    Ok(Distortion::brown(radial, [k1 * shift[1], k1 * shift[0]]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn the_inverse_series_undoes_the_polynomial_about_its_own_centre() {
        let text = "<C><PP>1000 750</PP><F>2000</F><SzIm>2000 1500</SzIm><CalibDistortion><ModRad><CDist>1008 744</CDist>\
                    <CoeffDist>-1e-8</CoeffDist><CoeffDist>2e-15</CoeffDist></ModRad></CalibDistortion></C>";
        let document = parse("c.xml", text).unwrap();
        let lens = Lens::read(&Reader { path: "c.xml" }, document.root_element()).unwrap();
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
            assert!(error[0].abs() < 0.02 && error[1].abs() < 0.02, "{error:?}");
        }
    }
}
