//! COLMAP's binary model, `cameras.bin` and `images.bin` (little-endian), as the text that says the
//! same.
//!
//! The text reader then checks it, whatever the bytes were; its lines are the records.

use std::fmt::Write;

use crate::base::error::{Error, Result};

/// Names of the camera models, and how many parameters they have, by number.
const MODELS: [(&str, usize); 18] = [
    ("SIMPLE_PINHOLE", 3),
    ("PINHOLE", 4),
    ("SIMPLE_RADIAL", 4),
    ("RADIAL", 5),
    ("OPENCV", 8),
    ("OPENCV_FISHEYE", 8),
    ("FULL_OPENCV", 12),
    ("FOV", 5),
    ("SIMPLE_RADIAL_FISHEYE", 4),
    ("RADIAL_FISHEYE", 5),
    ("THIN_PRISM_FISHEYE", 12),
    ("RAD_TAN_THIN_PRISM_FISHEYE", 16),
    ("SIMPLE_DIVISION", 4),
    ("DIVISION", 5),
    ("SIMPLE_FISHEYE", 3),
    ("FISHEYE", 4),
    ("EUCM", 6),
    ("EQUIRECTANGULAR", 2),
];

/// `cameras.bin` as `cameras.txt`.
pub(crate) fn cameras_text(path: &str, bytes: &[u8]) -> Result<String> {
    let mut bytes = ByteReader { path, rest: bytes };
    let mut text = String::new();
    for _ in 0..bytes.u64()? {
        let (id, model) = (bytes.u32()?, bytes.u32()?);
        let (width, height) = (bytes.u64()?, bytes.u64()?);
        let Some((name, count)) = MODELS.get(model as usize) else {
            return Err(bytes.error(&format!("camera {id} has the unknown model {model}")));
        };
        write!(text, "{id} {name} {width} {height}").expect("a String takes all");
        for _ in 0..*count {
            write!(text, " {}", bytes.f64()?).expect("a String takes all");
        }
        text.push('\n');
    }
    Ok(text)
}

/// `images.bin` as `images.txt`, without the image points.
pub(crate) fn images_text(path: &str, bytes: &[u8]) -> Result<String> {
    let mut bytes = ByteReader { path, rest: bytes };
    let mut text = String::new();
    for _ in 0..bytes.u64()? {
        write!(text, "{}", bytes.u32()?).expect("a String takes all");
        for _ in 0..7 {
            write!(text, " {}", bytes.f64()?).expect("a String takes all");
        }
        let camera = bytes.u32()?;
        let name = bytes.name()?;
        writeln!(text, " {camera} {name}\n").expect("a String takes all");
        // x, y and the number of the world point.
        let points = bytes.u64()?;
        bytes.skip(points.saturating_mul(24))?;
    }
    Ok(text)
}

struct ByteReader<'a> {
    path: &'a str,
    rest: &'a [u8],
}

impl<'a> ByteReader<'a> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let Some((first, rest)) = self.rest.split_first_chunk::<N>() else {
            return Err(self.error("it ends in the middle of a record"));
        };
        self.rest = rest;
        Ok(*first)
    }

    fn u32(&mut self) -> Result<u32> {
        Ok(u32::from_le_bytes(self.take()?))
    }

    fn u64(&mut self) -> Result<u64> {
        Ok(u64::from_le_bytes(self.take()?))
    }

    fn f64(&mut self) -> Result<f64> {
        Ok(f64::from_le_bytes(self.take()?))
    }

    /// Up to the zero that ends it; a line break would end the line of the text.
    fn name(&mut self) -> Result<String> {
        let Some(end) = self.rest.iter().position(|&b| b == 0) else {
            return Err(self.error("a name does not end"));
        };
        let name = String::from_utf8_lossy(&self.rest[..end]).replace(['\n', '\r'], "_");
        self.rest = &self.rest[end + 1..];
        Ok(name)
    }

    fn skip(&mut self, count: u64) -> Result<()> {
        let rest = usize::try_from(count).ok().and_then(|n| self.rest.get(n..));
        self.rest = rest.ok_or_else(|| self.error("it ends in the middle of a record"))?;
        Ok(())
    }

    fn error(&self, problem: &str) -> Error {
        Error::file(self.path, problem, "export the model again, as text")
    }
}
