//! What a point of a list is for, as its line says behind the name.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::orienting::structure_from_motion::similarity_fit::KnownOf;

/// What a point is for: it gives the frame, or it checks it; and what of it counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(target_arch = "wasm32", derive(tsify::Tsify))]
pub struct Role {
    /// Is it kept out of the fit, to check it?
    pub is_check: bool,
    /// What of its coordinates counts.
    pub known: KnownOf,
}

impl Role {
    /// Every word that may stand behind a name.
    pub(super) const WORDS: &str = "control, check, plan, height, check plan, check height";

    /// What one word states; `None` where it is no role.
    pub(super) fn named(word: &str) -> Option<Self> {
        let [control, check] = [false, true].map(|is_check| Self {
            is_check,
            ..Self::default()
        });
        let known = |known| Self { known, ..control };
        Some(match word.to_ascii_lowercase().as_str() {
            "control" => control,
            "check" => check,
            "plan" => known(KnownOf::Plan),
            "height" => known(KnownOf::Height),
            _ => return None,
        })
    }

    /// The role that words state; `None` where they state none. Words that are none are added to
    /// `others`; numbers are none either, and what follows a # is a remark.
    pub(super) fn of(words: &[String], others: &mut Vec<String>) -> Option<Self> {
        let mut role: Option<Self> = None;
        for word in words.iter().take_while(|word| !word.starts_with('#')) {
            match Self::named(word) {
                Some(more) => {
                    let stated = role.get_or_insert_default();
                    stated.is_check |= more.is_check;
                    if more.known != KnownOf::All {
                        stated.known = more.known;
                    }
                }
                None if word.chars().all(char::is_alphabetic) && !others.contains(word) => {
                    others.push(word.clone());
                }
                None => {}
            }
        }
        role
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match (self.is_check, self.known) {
            (false, KnownOf::All) => "control",
            (false, KnownOf::Plan) => "plan",
            (false, KnownOf::Height) => "height",
            (true, KnownOf::All) => "check",
            (true, KnownOf::Plan) => "check plan",
            (true, KnownOf::Height) => "check height",
        })
    }
}
