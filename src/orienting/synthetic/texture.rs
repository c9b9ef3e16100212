//! Value noise: a smooth texture from a hash of lattice points, the same on every target.

/// Colour and texture of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfaceTexture {
    /// Colour without texture and light, 0 to 1.
    pub rgb: [f64; 3],
    /// Amplitude of the texture, relative to the colour: 0.04 is weak, 0.25 strong.
    pub contrast: f64,
    /// Seed; faces with different seeds have unrelated textures.
    pub seed: u32,
}

impl SurfaceTexture {
    /// Colour at a position on the face, metres, under light from 0 to 1.
    pub(crate) fn colour(&self, u: f64, v: f64, light: f64) -> [f64; 3] {
        let factor = light * (1.0 + self.contrast * noise(u, v, self.seed));
        self.rgb.map(|c| c * factor)
    }
}

/// Three octaves of value noise, -1 to 1; the finest has cells of 0.25 m (three ground pixels).
fn noise(u: f64, v: f64, seed: u32) -> f64 {
    0.45 * octave(u / 0.25, v / 0.25, seed)
        + 0.35 * octave(u / 0.7, v / 0.7, seed ^ 0x5bd1)
        + 0.20 * octave(u / 2.1, v / 2.1, seed ^ 0xa3c7)
}

/// Lattice values joined by a smooth step.
fn octave(u: f64, v: f64, seed: u32) -> f64 {
    let (column, row) = (u.floor(), v.floor());
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let (fu, fv) = (smooth(u - column), smooth(v - row));
    let (i, j) = (column as i32, row as i32);
    let top = lattice(i, j, seed) * (1.0 - fu) + lattice(i + 1, j, seed) * fu;
    let bottom = lattice(i, j + 1, seed) * (1.0 - fu) + lattice(i + 1, j + 1, seed) * fu;
    top * (1.0 - fv) + bottom * fv
}

/// A value from -1 to 1 at an integer position.
fn lattice(i: i32, j: i32, seed: u32) -> f64 {
    let mut h = (i as u32).wrapping_mul(0x9e37_79b1)
        ^ (j as u32).wrapping_mul(0x85eb_ca77)
        ^ seed.wrapping_mul(0xc2b2_ae3d);
    h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    h = (h ^ (h >> 12)).wrapping_mul(0x297a_2d39);
    h ^= h >> 15;
    f64::from(h) / f64::from(u32::MAX) * 2.0 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_smooth_bounded_and_not_constant() {
        let values: Vec<f64> = (-400..400)
            .map(|i| noise(f64::from(i) * 0.05, 3.0 - f64::from(i) * 0.02, 7))
            .collect();
        assert!(values.iter().all(|v| v.abs() <= 1.0));
        assert!(values.windows(2).all(|w| (w[1] - w[0]).abs() < 0.35));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 800.0;
        assert!(mean.abs() < 0.15 && variance > 0.02, "{mean} {variance}");
    }
}
