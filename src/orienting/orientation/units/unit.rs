//! Units of coordinates, and their names.

/// A unit of length; the metre unless another is stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearUnit {
    /// Metres of one.
    pub metres: f64,
}

/// What coordinates in plan count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanUnit {
    /// Lengths on a map.
    Length(LinearUnit),
    /// Longitude and latitude; degrees of one.
    Angle(f64),
    /// Metres from the centre of the Earth.
    Geocentric,
}

/// The units of a coordinate system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemUnits {
    /// Those of the coordinates in plan.
    pub plan: PlanUnit,
    /// That of heights, where the system has any.
    pub height: Option<LinearUnit>,
}

/// Names of units, in one word of PROJ's and in words, and their metres (EPSG's, exact to the last
/// digit of a double).
const NAMED: [(&str, &str, f64); 11] = [
    ("m", "metres", 1.0),
    ("us-ft", "US survey feet", 1200.0 / 3937.0),
    ("ft", "international feet", 0.3048),
    ("km", "kilometres", 1000.0),
    ("mm", "millimetres", 0.001),
    ("cm", "centimetres", 0.01),
    ("dm", "decimetres", 0.1),
    ("us-yd", "US survey yards", 3600.0 / 3937.0),
    ("yd", "yards", 0.9144),
    ("us-mi", "US survey miles", 5280.0 * 1200.0 / 3937.0),
    ("mi", "miles", 1609.344),
];

/// Factors that differ by less than this share are one unit with other digits: the international
/// foot and that of the US survey differ by 2e-6, and files state seven digits or more.
const SAME_UNIT: f64 = 1e-7;

impl SystemUnits {
    /// Metres on a map, and no heights.
    pub(crate) const METRES: Self = Self {
        plan: PlanUnit::Length(LinearUnit::METRE),
        height: None,
    };
}

impl Default for LinearUnit {
    fn default() -> Self {
        Self::METRE
    }
}

impl LinearUnit {
    /// The metre.
    pub const METRE: Self = Self { metres: 1.0 };
    /// The foot of surveys in the United States.
    pub const US_FOOT: Self = Self {
        metres: 1200.0 / 3937.0,
    };
    /// The international foot.
    pub const FOOT: Self = Self { metres: 0.3048 };

    /// By what a file says one is in metres; `None` where that is no length.
    pub fn of_metres(metres: f64) -> Option<Self> {
        (metres.is_finite() && metres > 0.0).then_some(Self { metres })
    }

    /// By PROJ's word (`us-ft`) or a name (`US survey foot`, `Foot_US`, `metre`).
    pub fn of_name(name: &str) -> Option<Self> {
        let letters = name.chars().filter(char::is_ascii_alphanumeric);
        let plain = letters.collect::<String>().to_ascii_lowercase();
        let metres = match &*plain.replace("feet", "foot").replace("ft", "foot") {
            "m" | "metre" | "meter" | "metres" | "meters" => 1.0,
            "usfoot" | "footus" | "ussurveyfoot" | "surveyfoot" | "sfoot" => Self::US_FOOT.metres,
            "foot" | "internationalfoot" | "footinternational" | "footintl" | "footint" => 0.3048,
            _ => NAMED.iter().find(|(word, ..)| *word == name)?.2,
        };
        Some(Self { metres })
    }

    /// Is it the metre?
    pub fn is_metre(&self) -> bool {
        self.is(Self::METRE.metres)
    }

    fn is(&self, metres: f64) -> bool {
        (self.metres / metres - 1.0).abs() < SAME_UNIT
    }

    /// In words: "US survey feet".
    pub fn words(&self) -> String {
        let named = NAMED.iter().find(|(_, _, metres)| self.is(*metres));
        named.map_or_else(
            || format!("units of {} m", self.metres),
            |(_, words, _)| (*words).to_owned(),
        )
    }
}
