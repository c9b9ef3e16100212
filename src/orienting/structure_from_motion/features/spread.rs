//! The strongest extrema, spread over the photograph: half of them by strength alone, the others
//! one from each cell of a grid in turn.

use super::extrema::Extremum;

/// Cells along the longer side.
const CELLS: f64 = 16.0;

/// At most `most` of the extrema of an image of `size` pixels, the strongest first.
pub(super) fn strongest(mut extrema: Vec<Extremum>, most: usize, size: [f64; 2]) -> Vec<Extremum> {
    // A stable sort: equally strong ones stay in the order of their places.
    extrema.sort_by(|a, b| b.response.total_cmp(&a.response));
    if extrema.len() <= most {
        return extrema;
    }
    let cell_px = size[0].max(size[1]) / CELLS;
    let [columns, rows] = size.map(|side| (side / cell_px).ceil() as usize + 1);
    let mut in_cell = vec![0usize; columns * rows];
    let mut turns: Vec<(usize, usize)> = (extrema.iter().enumerate())
        .map(|(i, e)| {
            let [column, row] = e.position.map(|p| (p / cell_px).max(0.0) as usize);
            let cell = row.min(rows - 1) * columns + column.min(columns - 1);
            in_cell[cell] += 1;
            // The strongest half have their places anyway.
            (if i < most / 2 { 0 } else { in_cell[cell] }, i)
        })
        .collect();
    turns.sort_unstable();
    turns.truncate(most);
    let mut chosen: Vec<usize> = turns.into_iter().map(|(_, i)| i).collect();
    chosen.sort_unstable();
    chosen.into_iter().map(|i| extrema[i]).collect()
}
