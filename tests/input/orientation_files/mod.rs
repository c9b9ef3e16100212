//! Orientation files as their programs write them beyond the plain case: what newer and older
//! versions write, what several chunks and blocks say, and names that lead nowhere.
//!
//! The files in `tests/fixtures/cases` hold the three cameras of [`truth`].

use std::io::Cursor;

use nalgebra::{Matrix3, Point3, Vector3};
use ridgeline::orienting::orientation::{
    InputFile, Orientation, StatedReference, detect, orientation_sets,
    rotation_from_omega_phi_kappa,
};

/// Path and content of a file of `tests/fixtures/cases`.
macro_rules! case {
    ($path:literal) => {
        (
            $path,
            include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/tests/fixtures/cases/",
                $path
            )),
        )
    };
}

mod blocks;
mod metashape;
mod others;
mod sensors;

/// Rotation and centre of the cameras a, b, c.
fn truth(i: usize) -> (Matrix3<f64>, Point3<f64>) {
    let (angles, center) = [
        ([4.0, -3.0, 70.0], Point3::new(12.5, -31.25, 143.75)),
        ([-2.0, 5.0, 68.0], Point3::new(42.5, -21.25, 141.25)),
        ([1.0, -6.0, -110.0], Point3::new(27.5, 11.25, 146.5)),
    ][i];
    let [omega, phi, kappa] = angles.map(f64::to_radians);
    let r = rotation_from_omega_phi_kappa(omega, phi, kappa);
    (r.into_inner(), center)
}

fn k(fx: f64, skew: f64, fy: f64, cx: f64, cy: f64) -> Matrix3<f64> {
    Matrix3::new(fx, skew, cx, 0.0, fy, cy, 0.0, 0.0, 1.0)
}

/// The orientations of the preferred set, its warnings, and what it says of its system.
struct Found {
    orientations: Vec<Orientation>,
    warnings: Vec<String>,
    reference: StatedReference,
}

fn read(files: &[(&str, &str)]) -> Result<Found, String> {
    let inputs: Vec<InputFile> = files
        .iter()
        .map(|(path, text)| InputFile::new(path, text.as_bytes().to_vec()))
        .collect();
    let kinds: Vec<_> = inputs.iter().map(detect).collect();
    let (sets, _) = orientation_sets(&inputs, &kinds);
    let set = sets.first().ok_or("no set")?;
    let mut warnings = Vec::new();
    let orientations = set
        .read(&inputs, &mut warnings)
        .map_err(|e| e.to_string())?;
    Ok(Found {
        orientations,
        warnings,
        reference: set.reference(&inputs, None),
    })
}

fn refusal(files: &[(&str, &str)], words: &[&str]) {
    let message = read(files).err().expect("it must be refused");
    assert!(message.starts_with(files[0].0), "{message}");
    assert!(!message.contains("export it again"), "{message}");
    for word in words {
        assert!(message.contains(word), "{message}\nlacks: {word}");
    }
}

impl Found {
    fn names(&self) -> Vec<&str> {
        self.orientations.iter().map(|o| &*o.image).collect()
    }

    /// The camera stands where the truth has it, moved by an offset.
    fn stands(&self, at: usize, i: usize, offset: [f64; 3]) -> &Orientation {
        let (r, center) = truth(i);
        let found = &self.orientations[at];
        let moved = center + Vector3::from(offset);
        assert!((found.r - r).norm() < 1e-9, "{}{r}", found.r);
        assert!((found.center - moved).norm() < 1e-7, "{}", found.center);
        found
    }

    fn warns(&self, words: &[&str]) {
        let fits = |w: &&String| words.iter().all(|word| w.contains(word));
        assert!(
            self.warnings.iter().any(|w| fits(&w)),
            "{:?}",
            self.warnings
        );
    }
}

fn replaced((path, text): (&'static str, &str), from: &str, to: &str) -> (&'static str, String) {
    assert!(text.contains(from), "{path} holds {from}");
    (path, text.replace(from, to))
}

fn near(found: &Matrix3<f64>, expected: &Matrix3<f64>) {
    assert!((found - expected).norm() < 1e-9, "{found}{expected}");
}

/// Three images of 16 x 12 pixels, which show nothing.
fn images() -> Vec<InputFile> {
    let mut png = Cursor::new(Vec::new());
    image::RgbImage::from_pixel(16, 12, image::Rgb([90, 90, 90]))
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("memory takes all");
    ["a.png", "b.png", "c.png"]
        .map(|name| InputFile::new(name, png.get_ref().clone()))
        .to_vec()
}
