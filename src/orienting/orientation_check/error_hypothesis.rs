//! The usual errors of orientation files: wrong units, conventions and assignments, and the cameras
//! without them.

use std::fmt;

use nalgebra::{Matrix3, Point3};

use super::view::CheckedView;
use crate::orienting::orientation::{
    AngleUnit, Crop, Y_UP, axis_rotations, omega_phi_kappa_from_rotation,
    rotation_from_omega_phi_kappa,
};
use crate::photographs::camera::Camera;

/// An error that the orientation may contain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorHypothesis {
    /// The angles are stated in another unit, another order, or turn in another sequence.
    AngleConvention(AngleUnit, AngleOrder, RotationSequence),
    /// Angles of another unit went into the matrices: all are too large by this factor.
    AnglesScaled(f64),
    /// The rotation matrix is that from the camera to the world.
    Transposed,
    /// Rotation and translation are those from the camera to the world.
    InversePose,
    /// The camera's y runs up and its z backwards (OpenGL, photogrammetry).
    CameraYUp,
    /// The principal point is counted from the bottom of the image.
    PrincipalPointFromBottom,
    /// The principal point lies at the middle of the image.
    PrincipalPointInMiddle,
    /// Crop offsets count rows from the bottom of the frame.
    CropFromBottom,
    /// Column and row of the crops are exchanged.
    CropExchanged,
    /// The crop offset is subtracted from the principal point twice.
    CropTwice,
    /// The images are assigned in reverse order.
    ReversedOrder,
    /// Each image must take the orientation of the one this many positions later.
    CyclicOrder(usize),
    /// These two views have each other's orientation.
    SwappedViews(usize, usize),
    /// The focal length must be multiplied by this factor: it was in other units than pixels.
    FocalLengthUnit(f64),
    /// The pixel origin is half a pixel off; this must be added to the principal point.
    HalfPixelOrigin(f64),
}

/// The order in which a list holds the angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AngleOrder {
    /// omega phi kappa.
    OmegaPhiKappa,
    /// phi omega kappa.
    PhiOmegaKappa,
    /// kappa phi omega.
    KappaPhiOmega,
}

/// The sequence in which the angles turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RotationSequence {
    /// Rx(omega) Ry(phi) Rz(kappa).
    OmegaFirst,
    /// Rz(kappa) Ry(phi) Rx(omega).
    KappaFirst,
}

/// Among more views, exchanged ones are found by the agreement of the others: pairs of views are
/// too many to test.
const MAX_SWAPPED_VIEWS: usize = 8;

impl ErrorHypothesis {
    /// All hypotheses that these views allow.
    pub(crate) fn all_of(views: &[CheckedView]) -> Vec<Self> {
        let mut all = Vec::new();
        if views.iter().all(|p| p.angles.is_some()) {
            for unit in AngleUnit::ALL {
                for order in AngleOrder::ALL {
                    let of = |sequence| Self::AngleConvention(unit, order, sequence);
                    all.extend(
                        [RotationSequence::OmegaFirst, RotationSequence::KappaFirst].map(of),
                    );
                }
            }
        } else {
            all.extend([0.9, 1.0 / 0.9, 180.0 / std::f64::consts::PI].map(Self::AnglesScaled));
        }
        all.extend([
            Self::Transposed,
            Self::InversePose,
            Self::CameraYUp,
            Self::PrincipalPointFromBottom,
            Self::PrincipalPointInMiddle,
            Self::ReversedOrder,
        ]);
        if views.iter().all(|p| p.crop.is_some()) {
            all.extend([Self::CropFromBottom, Self::CropExchanged, Self::CropTwice]);
        }
        let count = views.len();
        all.extend((1..count).map(Self::CyclicOrder));
        if count <= MAX_SWAPPED_VIEWS {
            let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
            all.extend(pairs.map(|(a, b)| Self::SwappedViews(a, b)));
        }
        all
    }

    /// The cameras without this error; `None` where the views do not allow it.
    pub fn corrected_cameras(self, views: &[CheckedView]) -> Option<Vec<Camera>> {
        let count = views.len();
        let of_view = |i: usize| -> Option<Camera> {
            let view = &views[i];
            match self {
                Self::ReversedOrder => with_orientation_of(view, &views[count - 1 - i]),
                Self::CyclicOrder(n) => with_orientation_of(view, &views[(i + n) % count]),
                Self::SwappedViews(a, b) => {
                    let from = match i {
                        _ if i == a => b,
                        _ if i == b => a,
                        _ => i,
                    };
                    with_orientation_of(view, &views[from])
                }
                _ => self.corrected_camera(view),
            }
        };
        (0..count).map(of_view).collect()
    }

    fn corrected_camera(self, view: &CheckedView) -> Option<Camera> {
        let mut camera = view.camera.clone();
        let (width, height) = (f64::from(camera.width), f64::from(camera.height));
        match self {
            Self::AngleConvention(unit, order, sequence) => {
                let angles = order.sorted(view.angles?).map(|a| a * unit.radians());
                camera.r = sequence.rotation(angles);
            }
            Self::AnglesScaled(factor) => {
                let [omega, phi, kappa] = omega_phi_kappa_from_rotation(&camera.r);
                // Lists count kappa from 0 to a full turn, or to half a turn both ways: the nearer
                // to the factor's own range is unknown, but the former is what differs.
                let full = std::f64::consts::TAU;
                let turn = if kappa < 0.0 && factor < 1.0 {
                    full
                } else {
                    0.0
                };
                let [o, p, k] = [omega, phi, kappa + turn].map(|a| a * factor);
                camera.r = rotation_from_omega_phi_kappa(o, p, k).into_inner();
            }
            Self::Transposed => camera.r = camera.r.transpose(),
            Self::InversePose => {
                // The file's t was taken for -R C; it is C itself.
                let world = camera.center + view.origin;
                let t = -(camera.r * world.coords);
                camera.r = camera.r.transpose();
                camera.center = Point3::from(t - view.origin);
            }
            Self::CameraYUp => {
                camera.r = Y_UP * camera.r;
            }
            Self::PrincipalPointFromBottom => camera.k[(1, 2)] = height - camera.k[(1, 2)],
            Self::PrincipalPointInMiddle => {
                (camera.k[(0, 2)], camera.k[(1, 2)]) = (width / 2.0, height / 2.0);
            }
            Self::CropFromBottom => {
                let crop = view.crop?;
                camera.k[(1, 2)] += crop.row - (crop.frame[1] - crop.row - height);
            }
            Self::CropExchanged => {
                let crop = view.crop?;
                camera.k[(0, 2)] += crop.column - crop.row;
                camera.k[(1, 2)] += crop.row - crop.column;
            }
            Self::CropTwice => {
                let Crop { column, row, .. } = view.crop?;
                camera.k[(0, 2)] += column;
                camera.k[(1, 2)] += row;
            }
            Self::FocalLengthUnit(factor) => {
                camera.k[(0, 0)] *= factor;
                camera.k[(1, 1)] *= factor;
            }
            Self::HalfPixelOrigin(step) => {
                camera.k[(0, 2)] += step;
                camera.k[(1, 2)] += step;
            }
            Self::ReversedOrder | Self::CyclicOrder(_) | Self::SwappedViews(..) => {}
        }
        Some(camera)
    }

    /// The hypothesis as a clause, in the words of the files.
    pub(crate) fn describe(self, views: &[CheckedView]) -> String {
        let name = |i: usize| views[i].name.to_owned();
        match self {
            Self::AngleConvention(unit, order, sequence) => {
                let turn = match sequence {
                    RotationSequence::OmegaFirst => "",
                    RotationSequence::KappaFirst => {
                        ", turned in the sequence Rz(kappa) Ry(phi) Rx(omega)"
                    }
                };
                format!("the angles are {order} in {}{turn}", unit.name())
            }
            Self::AnglesScaled(f) if f < 1.0 => {
                "the angles were in gon and taken for degrees".to_owned()
            }
            Self::AnglesScaled(f) if f < 2.0 => {
                "the angles were in degrees and taken for gon".to_owned()
            }
            Self::AnglesScaled(_) => "the angles were in radians and taken for degrees".to_owned(),
            Self::Transposed => "the rotation matrices are transposed (camera to world)".to_owned(),
            Self::InversePose => "the poses are inverted (camera to world)".to_owned(),
            Self::CameraYUp => "the camera's y axis runs up and its z axis backwards".to_owned(),
            Self::PrincipalPointFromBottom => {
                "the principal point is counted from the bottom of the image (y up)".to_owned()
            }
            Self::PrincipalPointInMiddle => {
                "the principal point is that of another frame; it lies in the middle of the images"
                    .to_owned()
            }
            Self::CropFromBottom => {
                "the crop rows are counted from the bottom of the frame".to_owned()
            }
            Self::CropExchanged => "column and row of the crop offsets are exchanged".to_owned(),
            Self::CropTwice => "the crop offsets are applied twice".to_owned(),
            Self::ReversedOrder => {
                "the images are in reverse order against their orientations".to_owned()
            }
            Self::CyclicOrder(n) => format!(
                "the images are displaced against their orientations by {n}: {} has that of {}",
                name(0),
                name(n)
            ),
            Self::SwappedViews(a, b) => {
                format!("{} and {} have each other's orientation", name(a), name(b))
            }
            Self::FocalLengthUnit(f) => format!(
                "the focal length {:.2} is not in pixels: {:.1} px fits, {:.4} px a unit",
                views[0].camera.k[(0, 0)],
                views[0].camera.k[(0, 0)] * f,
                f
            ),
            Self::HalfPixelOrigin(step) => format!(
                "the pixel origin is half a pixel off: add {step:+.1} px to the principal point (the centre \
                 of the top-left pixel is {})",
                if step > 0.0 {
                    "(0, 0) in the file"
                } else {
                    "(0.5, 0.5) in the file"
                }
            ),
        }
    }
}

/// The camera of another view, where both images have the same size.
fn with_orientation_of(own: &CheckedView, other: &CheckedView) -> Option<Camera> {
    let size = |p: &CheckedView| (p.camera.width, p.camera.height);
    (size(own) == size(other)).then(|| other.camera.clone())
}

impl AngleOrder {
    const ALL: [Self; 3] = [
        Self::OmegaPhiKappa,
        Self::PhiOmegaKappa,
        Self::KappaPhiOmega,
    ];

    /// omega, phi, kappa of the three numbers in a list.
    fn sorted(self, [a, b, c]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::OmegaPhiKappa => [a, b, c],
            Self::PhiOmegaKappa => [b, a, c],
            Self::KappaPhiOmega => [c, b, a],
        }
    }
}

impl fmt::Display for AngleOrder {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::OmegaPhiKappa => "omega, phi, kappa",
            Self::PhiOmegaKappa => "phi, omega, kappa",
            Self::KappaPhiOmega => "kappa, phi, omega",
        })
    }
}

impl RotationSequence {
    fn rotation(self, [omega, phi, kappa]: [f64; 3]) -> Matrix3<f64> {
        match self {
            Self::OmegaFirst => rotation_from_omega_phi_kappa(omega, phi, kappa).into_inner(),
            Self::KappaFirst => {
                let [rx, ry, rz] = axis_rotations([omega, phi, kappa]);
                Y_UP * (rz * ry * rx).transpose()
            }
        }
    }
}
