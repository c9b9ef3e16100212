//! Shiftable windows: the support of a position whose own window lies across an edge.
//!
//! Within half a window of an edge every plane through it correlates alike, on the roof as well as
//! beyond the eave, for the edge is all that such windows see. The shiftable windows of stereo
//! matching (Bobick and Intille 1999) tell the sides apart: a position is supported by a window
//! that holds it and stays on its side of the line. Here that window replaces the position's own
//! as far as it has texture: where the sides are bare, the edge is still the best evidence, but
//! with less weight, since it supports what is beyond the roof as well.
//!
//! All planes share the same windows, wherever their own lines are. If each were shifted from its
//! own lines only, a plane with fewer lines would be tested less strictly.

use super::box_sum::{HALF_WINDOW, WINDOW};
use super::consistency_map::ConsistencyMap;
use super::plan_grid::PlanGrid;
use crate::base::evidence::WindowEvidenceTable;
use crate::base::geometry::Segment3;

/// Share of the edge's texture weight that counts on a bare side. Assumption: most of it, for there
/// are as many bare roofs as bare streets. Measured: 0.6 and 0.7 give the same models, from 0.8 on
/// roofs reach out over shaded gaps.
const EDGE_SHARE: f64 = 0.6;
/// In place of a shift: the position's own window, for there is no line in it, or no room beside
/// the line.
const STAYS: u8 = (HALF_WINDOW * WINDOW + HALF_WINDOW) as u8;

/// For every cell of a plan grid the nearest window that holds it and no line.
pub(crate) struct ShiftableWindows {
    grid: PlanGrid,
    /// Row by row: `(dy + 2) * 5 + dx + 2` for a window whose middle is dx columns and dy rows
    /// away.
    shifts: Vec<u8>,
}

/// Correlation and texture weight of the window that supports a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WindowEvidence {
    /// Texture weight, 0 to 1; 0 where fewer than two views see it.
    pub weight: f64,
    /// How well the views agree, -1 to 1.
    pub correlation: f64,
    /// What the images say of the plane, nats; negative against it.
    pub nats: f64,
}

impl WindowEvidence {
    fn of(map: &ConsistencyMap, k: usize) -> Self {
        let table = WindowEvidenceTable::fitted();
        Self {
            weight: f64::from(map.weight(k)),
            correlation: f64::from(map.correlation(k)),
            nats: table.nats(map.weight[k], map.correlation[k]),
        }
    }

    /// The evidence of a side of a line, with that of the edge as far as the side is bare.
    fn with_share_of(&self, edge: &Self) -> Self {
        let of_edge = EDGE_SHARE * (edge.weight - self.weight).max(0.0);
        let weight = self.weight + of_edge;
        let correlations = self.weight * self.correlation + of_edge * edge.correlation;
        let share = if of_edge > 0.0 {
            of_edge / edge.weight
        } else {
            0.0
        };
        Self {
            weight,
            correlation: correlations / weight,
            nats: self.nats + share * edge.nats,
        }
    }

    /// What it says with the odds before, nats.
    pub(crate) fn nats_with_prior(&self) -> f64 {
        self.nats + self.weight * WindowEvidenceTable::fitted().prior
    }
}

impl ShiftableWindows {
    /// The windows of `grid` beside the lines, in plan.
    pub(crate) fn new(lines: impl IntoIterator<Item = Segment3>, grid: &PlanGrid) -> Self {
        let on_line = cells_on(lines, grid);
        let mut windows = Self {
            grid: *grid,
            shifts: vec![STAYS; grid.width * grid.height],
        };
        let crossed = windows_with(&on_line, grid);
        windows.shift(&on_line, crossed);
        windows
    }

    /// The window evidence at a cell of `map`.
    pub(crate) fn evidence_at(
        &self,
        map: &ConsistencyMap,
        [column, row]: [usize; 2],
    ) -> WindowEvidence {
        let of = |k| WindowEvidence::of(map, k);
        let own = of(row * map.grid.width + column);
        let beside = self.window_of(&map.grid, [column, row]).map(of);
        match beside.filter(|beside| beside.weight > 0.0) {
            Some(beside) => beside.with_share_of(&own),
            None => own,
        }
    }

    /// The cell of `part`, a window of the plan, in the middle of the shifted window of another;
    /// `None` where it stays.
    fn window_of(&self, part: &PlanGrid, [column, row]: [usize; 2]) -> Option<usize> {
        let (dc, dr) = part.offset_in(&self.grid);
        let inside = |at: usize, d: isize, size: usize| {
            at.checked_add_signed(d).filter(|moved| *moved < size)
        };
        let c = inside(column, dc, self.grid.width)?;
        let r = inside(row, dr, self.grid.height)?;
        let shift = self.shifts[r * self.grid.width + c];
        if shift == STAYS {
            return None;
        }
        let [dx, dy] = unpacked(shift);
        Some(inside(row, dy, part.height)? * part.width + inside(column, dx, part.width)?)
    }

    /// Gives the windows in `crossed` the shift to the nearest that is not, from neighbour to
    /// neighbour so that none is found across a line.
    fn shift(&mut self, on_line: &[bool], mut crossed: Vec<bool>) {
        let (w, h) = (self.grid.width, self.grid.height);
        let mut open: Vec<usize> = (0..w * h).filter(|&k| crossed[k] && !on_line[k]).collect();
        for _ in 0..=HALF_WINDOW {
            let found: Vec<Option<u8>> = (open.iter())
                .map(|&k| self.shift_by_neighbour(k, &crossed))
                .collect();
            for (k, shift) in open.iter().zip(&found) {
                if let Some(shift) = shift {
                    self.shifts[*k] = *shift;
                    crossed[*k] = false;
                }
            }
            let mut found = found.iter();
            open.retain(|_| found.next().is_some_and(Option::is_none));
        }
    }

    /// The shift to the window of a neighbour that has one.
    fn shift_by_neighbour(&self, k: usize, crossed: &[bool]) -> Option<u8> {
        const AROUND: [[isize; 2]; 8] = [
            [-1, 0],
            [1, 0],
            [0, -1],
            [0, 1],
            [-1, -1],
            [1, -1],
            [-1, 1],
            [1, 1],
        ];
        let (w, h) = (self.grid.width, self.grid.height);
        AROUND.into_iter().find_map(|[x, y]| {
            let column = (k % w).checked_add_signed(x).filter(|c| *c < w)?;
            let row = (k / w).checked_add_signed(y).filter(|r| *r < h)?;
            let beside = row * w + column;
            if crossed[beside] {
                return None;
            }
            let [dx, dy] = unpacked(self.shifts[beside]);
            packed([x + dx, y + dy])
        })
    }
}

/// A shift in one byte; `None` where the window would not hold its position.
fn packed(shift: [isize; 2]) -> Option<u8> {
    let [x, y] = shift.map(|d| d + HALF_WINDOW as isize);
    let side = 0..WINDOW as isize;
    (side.contains(&x) && side.contains(&y)).then_some((y * WINDOW as isize + x) as u8)
}

fn unpacked(shift: u8) -> [isize; 2] {
    let shift = usize::from(shift);
    [shift % WINDOW, shift / WINDOW].map(|d| d as isize - HALF_WINDOW as isize)
}

/// The cells that lines pass through.
fn cells_on(lines: impl IntoIterator<Item = Segment3>, grid: &PlanGrid) -> Vec<bool> {
    let mut on_line = vec![false; grid.width * grid.height];
    for line in lines {
        let count = (line.length() / (0.5 * grid.step)).ceil().max(1.0);
        for i in 0..=count as usize {
            let at = line.at(i as f64 / count).xy();
            if let Some((column, row)) = grid.cell(&at) {
                on_line[row * grid.width + column] = true;
            }
        }
    }
    on_line
}

/// The windows, by their middles, that hold one of some cells.
fn windows_with(cells: &[bool], grid: &PlanGrid) -> Vec<bool> {
    let (w, h) = (grid.width, grid.height);
    let mut along_rows = vec![false; w * h];
    for k in (0..w * h).filter(|&k| cells[k]) {
        let (first, column) = (k - k % w, k % w);
        let last = (column + HALF_WINDOW).min(w - 1);
        along_rows[first + column.saturating_sub(HALF_WINDOW)..=first + last].fill(true);
    }
    let mut windows = vec![false; w * h];
    for k in (0..w * h).filter(|&k| along_rows[k]) {
        let (column, row) = (k % w, k / w);
        for row in row.saturating_sub(HALF_WINDOW)..=(row + HALF_WINDOW).min(h - 1) {
            windows[row * w + column] = true;
        }
    }
    windows
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point2, Point3};
    use proptest::prelude::*;

    /// 60 by 50 cells of 0.1 m.
    fn grid() -> PlanGrid {
        PlanGrid {
            origin: Point2::new(-1.0, 4.0),
            step: 0.1,
            width: 60,
            height: 50,
        }
    }

    /// A line between the middles of two cells of the grid.
    fn line(from: [usize; 2], to: [usize; 2]) -> Segment3 {
        let [p0, p1] = [from, to].map(|[column, row]| {
            let at = grid().center(column, row);
            Point3::new(at.x, at.y, 7.0)
        });
        Segment3::new(p0, p1)
    }

    /// How the views agree on a plane, given for each cell; textured everywhere.
    fn map(part: PlanGrid, correlation: impl Fn(usize, usize) -> f64) -> ConsistencyMap {
        let cells = part.width * part.height;
        let at = |k: usize| (127.0 * correlation(k % part.width, k / part.width)) as i8;
        ConsistencyMap {
            grid: part,
            correlation: (0..cells).map(at).collect(),
            weight: vec![200; cells],
            common_weight: vec![200; cells],
        }
    }

    fn correlation_at(windows: &ShiftableWindows, map: &ConsistencyMap, at: [usize; 2]) -> f64 {
        windows.evidence_at(map, at).correlation
    }

    /// A roof in the rows below 20 with an eave along row 20: windows across the eave agree on both
    /// sides of it.
    fn roof_with_eave(row: usize) -> f64 {
        if row < 20 + HALF_WINDOW { 0.9 } else { 0.1 }
    }

    proptest! {
        #[test]
        fn a_shifted_window_holds_its_position_and_no_line(
            ends in proptest::collection::vec(((0usize..60, 0usize..50), (0usize..60, 0usize..50)), 1..6),
        ) {
            let lines: Vec<Segment3> = ends.iter()
                .map(|((a, b), (c, d))| line([*a, *b], [*c, *d]))
                .collect();
            let on_line = cells_on(lines.iter().copied(), &grid());
            let windows = ShiftableWindows::new(lines, &grid());
            let near = |a: usize, b: usize| a.abs_diff(b) <= HALF_WINDOW;
            for k in 0..60 * 50 {
                let at = [k % 60, k / 60];
                if let Some(middle) = windows.window_of(&grid(), at) {
                    let middle = [middle % 60, middle / 60];
                    prop_assert!(near(middle[0], at[0]) && near(middle[1], at[1]));
                    let held = (0..60 * 50).filter(|j| near(j % 60, middle[0]) && near(j / 60, middle[1]));
                    prop_assert!(held.into_iter().all(|j| !on_line[j]));
                }
            }
        }
    }

    #[test]
    fn a_plane_ends_at_the_line_that_its_windows_see_from_both_sides() {
        let roof = map(grid(), |_, row| roof_with_eave(row));
        let none = ShiftableWindows::new([], &grid());
        let eave = ShiftableWindows::new([line([0, 20], [59, 20])], &grid());
        for column in [0, 30, 59] {
            assert!(
                correlation_at(&none, &roof, [column, 21]) > 0.8,
                "by its edge"
            );
            for row in 21..=22 {
                assert!(
                    correlation_at(&eave, &roof, [column, row]) < 0.2,
                    "beyond, {row}"
                );
            }
            for row in 10..=19 {
                assert!(
                    correlation_at(&eave, &roof, [column, row]) > 0.8,
                    "the roof, {row}"
                );
            }
        }
    }

    #[test]
    fn a_bare_side_is_judged_by_the_edge() {
        let mut roof = map(grid(), |_, row| {
            if row.abs_diff(20) <= HALF_WINDOW {
                0.9
            } else {
                0.33
            }
        });
        let eave = ShiftableWindows::new([line([0, 20], [59, 20])], &grid());
        assert!(
            correlation_at(&eave, &roof, [30, 18]) < 0.4,
            "texture contradicts"
        );
        for row in (0..50).filter(|row: &usize| row.abs_diff(20) > HALF_WINDOW) {
            roof.weight[row * 60..(row + 1) * 60].fill(10);
        }
        let by_edge = eave.evidence_at(&roof, [30, 18]);
        assert!(by_edge.correlation > 0.8, "nothing does");
        // 10 of 255 are its side's own, 190 the edge's.
        assert!((by_edge.weight - (10.0 + 0.6 * 190.0) / 255.0).abs() < 1e-6);
    }

    #[test]
    fn between_two_lines_without_room_windows_stay() {
        let gap = |rows: usize| {
            let lines = [20, 20 + rows].map(|row| line([0, row], [59, row]));
            ShiftableWindows::new(lines, &grid()).window_of(&grid(), [30, 20 + rows / 2 + 1])
        };
        assert_eq!(
            gap(2 * HALF_WINDOW + 1),
            None,
            "not across one of the lines"
        );
        let middle = gap(2 * HALF_WINDOW + 2).expect("there is room for one");
        assert_eq!(middle / 60, 20 + HALF_WINDOW + 1);
    }

    #[test]
    fn a_map_of_a_part_of_the_plan_uses_the_same_windows() {
        let part = PlanGrid {
            origin: grid().center(7, 12) - nalgebra::Vector2::new(0.05, 0.05),
            width: 30,
            height: 30,
            ..grid()
        };
        let roof = map(part, |_, row| roof_with_eave(row + 12));
        let eave = ShiftableWindows::new([line([0, 20], [59, 20])], &grid());
        assert!(correlation_at(&eave, &roof, [15, 21 - 12]) < 0.2);
        assert!(correlation_at(&eave, &roof, [15, 19 - 12]) > 0.8);
        // The window beside the line lies outside of a lower map.
        let low = PlanGrid { height: 11, ..part };
        let roof = map(low, |_, row| roof_with_eave(row + 12));
        assert!(correlation_at(&eave, &roof, [15, 21 - 12]) > 0.8);
    }
}
