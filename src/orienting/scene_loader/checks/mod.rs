//! What is checked before a scene is handed over: cameras by themselves, and against the images.
//!
//! ```text
//! camera_checks   do the cameras look down, at the same place, from above the ground
//! correction      orientation check, and corrections where the options ask for them
//! consequence     its finding as a refusal or a warning
//! ```

pub(super) mod camera_checks;
mod consequence;
mod correction;

pub(super) use correction::check_and_correct;
