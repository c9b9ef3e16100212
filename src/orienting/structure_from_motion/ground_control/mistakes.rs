//! The usual mistakes of control lists: each is tried where the list as it stands cannot be true,
//! and named where the points agree under it.

use nalgebra::Point2;

use super::fit::{Fit, fitted, meeting};
use super::gcp_list::GroundControl;
use super::marks::Marks;
use crate::orienting::orientation::{LinearUnit, PlanUnit, SystemUnits};
use crate::orienting::structure_from_motion::block::Block;

/// A mistake that a list may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Mistake {
    AxesExchanged,
    HeightBeforeNorthing,
    HeightSign,
    ZonePrefix,
    LongitudeSign,
    LatitudeSign,
    OtherUnit(LinearUnit),
    RowsFromBelow,
    RowBeforeColumn,
    /// Marked in photographs so many times as large.
    MarksOfOriginals(f64),
}

impl Mistake {
    /// What the list has, in words.
    pub(super) fn words(self) -> String {
        match self {
            Self::AxesExchanged => {
                "x and y exchanged (northing before easting, latitude before longitude)".into()
            }
            Self::HeightBeforeNorthing => "the height before the northing".into(),
            Self::HeightSign => "heights of the other sign".into(),
            Self::ZonePrefix => "the number of the zone before the easting".into(),
            Self::LongitudeSign => "longitudes of the other sign (W without a minus)".into(),
            Self::LatitudeSign => "latitudes of the other sign (S without a minus)".into(),
            Self::OtherUnit(unit) => format!("coordinates in {}", unit.words()),
            Self::RowsFromBelow => "rows of the marks counted from the lower edge".into(),
            Self::RowBeforeColumn => "row and column of the marks exchanged".into(),
            Self::MarksOfOriginals(factor) => {
                format!("marks that fit photographs {factor:.2} times as large")
            }
        }
    }

    /// The list and its marks as they were meant.
    pub(super) fn mended(
        self,
        control: &GroundControl,
        marks: &Marks,
        block: &Block,
    ) -> (GroundControl, Marks) {
        let stated =
            |change: fn(&mut [f64; 3])| (control.changed(|p| change(&mut p.stated)), marks.clone());
        let moved = |change: &dyn Fn(Point2<f64>, f64) -> Point2<f64>| {
            let of_photo = |photo: usize| f64::from(block.intrinsics(photo).size[1]);
            let moved = marks.moved(|mark| change(mark.pixel, of_photo(mark.photo)));
            (control.clone(), moved)
        };
        match self {
            Self::AxesExchanged => stated(|p| p.swap(0, 1)),
            Self::HeightBeforeNorthing => stated(|p| p.swap(1, 2)),
            Self::HeightSign => stated(|p| p[2] = -p[2]),
            Self::ZonePrefix => stated(|p| p[0] %= ZONE_M),
            Self::LongitudeSign => stated(|p| p[0] = -p[0]),
            Self::LatitudeSign => stated(|p| p[1] = -p[1]),
            Self::OtherUnit(unit) => {
                let units = SystemUnits {
                    plan: PlanUnit::Length(unit),
                    height: Some(unit),
                };
                (control.in_units(units), marks.clone())
            }
            Self::RowsFromBelow => moved(&|p, height| Point2::new(p.x, height - p.y)),
            Self::RowBeforeColumn => moved(&|p, _| Point2::new(p.y, p.x)),
            Self::MarksOfOriginals(factor) => moved(&|p, _| p / factor),
        }
    }

    /// Those that a list may have at all.
    pub(super) fn possible(control: &GroundControl, marks: &Marks, block: &Block) -> Vec<Self> {
        let mut possible = vec![
            Self::AxesExchanged,
            Self::HeightBeforeNorthing,
            Self::ZonePrefix,
            Self::RowsFromBelow,
            Self::RowBeforeColumn,
        ];
        if control.points.iter().any(|p| p.stated[2] < 0.0) {
            possible.push(Self::HeightSign);
        }
        match control.units.plan {
            PlanUnit::Length(own) => {
                // The two feet differ by what no photograph shows.
                let other = if own.is_metre() {
                    LinearUnit::US_FOOT
                } else {
                    LinearUnit::METRE
                };
                possible.push(Self::OtherUnit(other));
            }
            _ => possible.extend([Self::LongitudeSign, Self::LatitudeSign]),
        }
        possible.extend(factor_of_originals(marks, block).map(Self::MarksOfOriginals));
        possible
    }
}

/// Numbers of zones stand before eastings as multiples of this, metres.
const ZONE_M: f64 = 1e6;

/// Points that tell how much photographs were reduced; more would tell the same.
const ENOUGH_POINTS: usize = 10;

/// How many times as large photographs were when they were marked: the factor under which the rays
/// of the marks meet best, all of them being inside.
fn factor_of_originals(marks: &Marks, block: &Block) -> Option<f64> {
    let width = f64::from(block.cameras.first()?.size[0]);
    let mut of_points = marks.of_points.clone();
    of_points.sort_by_key(|marks| std::cmp::Reverse(marks.len()));
    of_points.truncate(ENOUGH_POINTS);
    let few = marks.only(of_points);
    let met = |factor: f64| meeting(block, &few.moved(|mark| mark.pixel / factor).of_points);
    let best_of = |factors: Vec<f64>| {
        let each = factors.into_iter().map(|factor| (met(factor), factor));
        each.reduce(|best, next| if next.0 > best.0 { next } else { best })
    };
    let mut factors = vec![marks.least_factor()];
    // No side of a JPEG is longer, and so of no original.
    let longest_side = f64::from(u16::MAX);
    // Steps that move a mark at the edge by two pixels, half of the largest residual.
    while let Some(last) = factors.last().copied()
        && last > 0.0
        && last * width < longest_side
    {
        factors.push(last * (1.0 + 2.0 / width));
    }
    let (_, near) = best_of(factors)?;
    let finer = (-8..=8).map(|i| near * (1.0 + f64::from(i) / (4.0 * width)));
    let (met, factor) = best_of(finer.collect())?;
    // Photographs of their own size are no mistake.
    (met > 0.0 && (factor - 1.0).abs() * width > 1.0).then_some(factor)
}

/// A list as it may be meant, and how it fits.
pub(super) fn under(
    mistake: Mistake,
    control: &GroundControl,
    marks: &Marks,
    block: &Block,
) -> Option<(GroundControl, Fit)> {
    let (control, marks) = mistake.mended(control, marks, block);
    let fit = fitted(block, &marks, &control).ok()?;
    Some((control, fit))
}
