//! Units that well-known text and PROJ texts state themselves.

use super::unit::{LinearUnit, PlanUnit};

/// What a text states.
#[derive(Default)]
pub(super) struct Stated {
    pub plan: Option<PlanUnit>,
    pub height: Option<LinearUnit>,
}

/// Reads a text of any kind; nothing where it is neither.
pub(super) fn stated(text: &str) -> Stated {
    if text.contains('[') {
        of_well_known_text(text)
    } else if text.contains("+proj=") {
        of_proj(text)
    } else {
        Stated::default()
    }
}

/// PROJ: `+units=us-ft` or `+to_meter=0.3048`, of heights `+vunits=`, `+vto_meter=`.
fn of_proj(text: &str) -> Stated {
    let value = |key: &str| text.split_whitespace().find_map(|w| w.strip_prefix(key));
    // PROJ allows fractions.
    let factor = |key: &str| {
        let (over, under) = value(key).map(|v| v.split_once('/').unwrap_or((v, "1")))?;
        LinearUnit::of_metres(over.parse::<f64>().ok()? / under.parse::<f64>().ok()?)
    };
    let unit = |word: &str, key: &str| factor(key).or_else(|| LinearUnit::of_name(value(word)?));
    let plan = match value("+proj=") {
        Some("longlat" | "latlong" | "lonlat" | "latlon") => PlanUnit::Angle(1.0),
        Some("geocent" | "cart") => PlanUnit::Geocentric,
        _ if value("+units=").is_none() && value("+to_meter=").is_none() => {
            PlanUnit::Length(LinearUnit::METRE)
        }
        // A unit that is not known is none.
        _ => match unit("+units=", "+to_meter=") {
            Some(unit) => PlanUnit::Length(unit),
            None => return Stated::default(),
        },
    };
    Stated {
        plan: Some(plan),
        height: unit("+vunits=", "+vto_meter="),
    }
}

/// The unit of a system stands directly in its brackets or in those of its axes; those of
/// parameters and ellipsoids say nothing of coordinates.
fn of_well_known_text(text: &str) -> Stated {
    let mut stated = Stated::default();
    let mut open: Vec<&str> = Vec::new();
    let (mut word, mut is_quoted) = (0, false);
    for (i, c) in text.char_indices() {
        match c {
            '"' => is_quoted = !is_quoted,
            _ if is_quoted => {}
            '[' => {
                let name = text[word..i].trim();
                let is_unit = matches!(name, "UNIT" | "LENGTHUNIT");
                if let Some(unit) = metres_in(&text[i + 1..]).filter(|_| is_unit) {
                    let system = match open[..] {
                        [.., system, "AXIS"] | [.., system] => system,
                        [] => "",
                    };
                    stated.set(system, unit);
                }
                open.push(name);
                word = i + 1;
            }
            ']' => {
                open.pop();
                word = i + 1;
            }
            ',' => word = i + 1,
            _ => {}
        }
    }
    stated
}

impl Stated {
    /// The first unit of each counts.
    fn set(&mut self, system: &str, unit: LinearUnit) {
        if is_map(system) {
            self.plan = self.plan.or(Some(PlanUnit::Length(unit)));
        }
        if is_vertical(system) {
            self.height = self.height.or(Some(unit));
        }
    }
}

fn is_map(system: &str) -> bool {
    let names = ["PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS"];
    names.contains(&system)
}

fn is_vertical(system: &str) -> bool {
    ["VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"].contains(&system)
}

/// The second field of a unit's brackets: metres of one.
fn metres_in(inside: &str) -> Option<LinearUnit> {
    let (_, after) = inside.trim_start().strip_prefix('"')?.split_once('"')?;
    let number = after.trim_start().strip_prefix(',')?;
    let end = number.find([',', ']'])?;
    LinearUnit::of_metres(number[..end].trim().parse().ok()?)
}
