//! A number that is known to some accuracy.

/// A number and its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// One standard deviation, in the same unit; `None` where the images show too little.
    pub sigma: Option<f64>,
}
