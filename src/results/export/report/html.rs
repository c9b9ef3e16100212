//! Text and tables of the page. Lengths, areas and volumes are there in metres and in feet; a
//! switch of the page shows one of them.

use std::fmt::{Display, Write};

use super::svg::escaped;
use crate::results::roof_report::Estimate;

/// Metres in a foot.
const FOOT_M: f64 = 0.3048;

/// A page in the making.
#[derive(Default)]
pub(super) struct Html {
    pub(super) text: String,
    /// Which columns of the table stand on the left.
    left: Vec<bool>,
}

impl Html {
    pub(super) fn push(&mut self, content: std::fmt::Arguments) {
        (self.text.write_fmt(content)).expect("a String takes all that is written");
    }

    /// Begins a table. Columns whose names begin with < stand on the left.
    pub(super) fn head<T: AsRef<str>>(&mut self, names: &[T]) {
        let names = names.iter().map(AsRef::as_ref);
        self.left = names.clone().map(|name| name.starts_with('<')).collect();
        let names = names.map(|name| with_feet(name.trim_start_matches('<')));
        let names: Vec<String> = names.collect();
        self.push(format_args!("<table>\n<thead>"));
        self.cells("th", &names);
        self.push(format_args!("</thead>\n<tbody>\n"));
    }

    /// A row of fields, which are HTML.
    pub(super) fn row<T: AsRef<str>>(&mut self, fields: &[T]) {
        self.cells("td", fields);
    }

    fn cells<T: AsRef<str>>(&mut self, element: &str, fields: &[T]) {
        self.push(format_args!("<tr>"));
        for (i, field) in fields.iter().enumerate() {
            let is_left = self.left.get(i).is_some_and(|left| *left);
            let class = if is_left { " class=\"left\"" } else { "" };
            let field = field.as_ref();
            self.push(format_args!("<{element}{class}>{field}</{element}>"));
        }
        self.push(format_args!("</tr>\n"));
    }

    pub(super) fn end_table(&mut self) {
        self.push(format_args!("</tbody>\n</table>\n"));
    }
}

/// A name as HTML; one that ends with m, m² or m³ with feet, too.
pub(super) fn with_feet(name: &str) -> String {
    let name = escaped(name);
    match name.rsplit_once(", m") {
        Some((words, power @ ("" | "²" | "³"))) => both(&name, &format!("{words}, ft{power}")),
        _ => name,
    }
}

/// Words in metres and in feet.
fn both(metres: &dyn Display, feet: &dyn Display) -> String {
    format!("<span class=\"m\">{metres}</span><span class=\"ft\">{feet}</span>")
}

/// A length (power 1), an area (2) or a volume (3) in metres, with so many decimals, and in feet.
pub(super) fn measure(estimate: Estimate, power: usize, decimals: usize) -> String {
    let feet = |value| in_feet(value, power);
    let of_feet = Estimate {
        value: feet(estimate.value),
        sigma: estimate.sigma.map(feet),
    };
    // A square foot is a tenth of a square metre.
    let coarser = decimals.saturating_sub(power - 1);
    both(
        &with_sigma(estimate, decimals),
        &with_sigma(of_feet, coarser),
    )
}

/// An area with its unit.
pub(super) fn area_with_unit(m2: f64) -> String {
    let feet = in_feet(m2, 2);
    both(&format_args!("{m2:.1} m²"), &format_args!("{feet:.0} ft²"))
}

/// A number of metres, square metres (power 2) or cubic metres (3) in feet.
pub(super) fn in_feet(value: f64, power: usize) -> f64 {
    (0..power).fold(value, |value, _| value / FOOT_M)
}

/// A number with its standard deviation, both with so many decimals; no deviation is shown as none.
pub(super) fn with_sigma(estimate: Estimate, decimals: usize) -> String {
    let Estimate { value, sigma } = estimate;
    match sigma {
        // Half of the last digit, so that nothing is shown as exact.
        Some(sigma) => {
            let unit = (0..decimals).fold(1.0, |unit, _| unit / 10.0);
            let sigma = sigma.max(unit);
            format!("{value:.decimals$} ± {sigma:.decimals$}")
        }
        None => format!("{value:.decimals$}"),
    }
}
