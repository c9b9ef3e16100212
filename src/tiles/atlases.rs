//! The atlases of all cells in one image.

/// Longest side of the joined atlas, pixels. Assumption: what graphics processors take as one
/// texture; a JPEG may have 65535.
const LONGEST_SIDE_PX: u32 = 16384;

/// Where the atlases stand in the joined one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AtlasPlaces {
    /// Width and height of the joined one, pixels.
    pub size: [u32; 2],
    /// The whole factor by which all are reduced, so that they fit.
    pub reduction: u32,
    /// Column and row of each.
    pub corners: Vec<[u32; 2]>,
}

impl AtlasPlaces {
    /// Of atlases of these widths and heights.
    pub(super) fn of(sizes: &[[u32; 2]]) -> Self {
        (1..)
            .map(|reduction| Self::reduced(sizes, reduction))
            .find(|places| places.size.iter().all(|side| *side <= LONGEST_SIDE_PX))
            .expect("reduced far enough, all are nothing")
    }

    /// In rows from left to right, about as wide as high.
    fn reduced(sizes: &[[u32; 2]], reduction: u32) -> Self {
        let sizes = || sizes.iter().map(|size| size.map(|side| side / reduction));
        let area: f64 = sizes().map(|[w, h]| f64::from(w) * f64::from(h)).sum();
        let widest = sizes().map(|[w, _]| w).max().unwrap_or(0);
        let width = widest.max((area.sqrt().ceil() as u32).min(LONGEST_SIDE_PX));
        let [mut column, mut row, mut height] = [0, 0, 0];
        let mut right = 0;
        let corner = |[w, h]: [u32; 2]| {
            if column + w > width {
                row += height;
                [column, height] = [0, 0];
            }
            let corner = [column, row];
            column += w;
            height = height.max(h);
            right = right.max(column);
            corner
        };
        let corners = sizes().map(corner).collect();
        Self {
            size: [right.max(1), (row + height).max(1)],
            reduction,
            corners,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn atlases_stand_beside_each_other_without_overlap() {
        let sizes = [[8, 4], [8, 4], [3, 9], [5, 5], [0, 0], [8, 1]];
        let places = AtlasPlaces::of(&sizes);
        assert_eq!(places.reduction, 1);
        let mut taken = vec![false; (places.size[0] * places.size[1]) as usize];
        for ([x, y], [w, h]) in places.corners.iter().zip(sizes) {
            for i in 0..w * h {
                let at = (y + i / w) * places.size[0] + x + i % w;
                assert!(!std::mem::replace(&mut taken[at as usize], true));
            }
        }
        assert_eq!(AtlasPlaces::of(&[]).size, [1, 1]);
    }

    #[test]
    fn a_flight_of_many_squares_has_an_atlas_that_can_be_written_and_drawn() {
        // Below each other they would be 800000 pixels high.
        let places = AtlasPlaces::of(&[[1024, 2000]; 400]);
        assert_eq!(places.reduction, 2);
        assert!(places.size.iter().all(|side| *side <= LONGEST_SIDE_PX));
        let [w, h] = places.size;
        assert!(w.abs_diff(h) < 2000, "{w} x {h}");
    }
}
