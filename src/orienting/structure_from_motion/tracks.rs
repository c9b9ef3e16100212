//! Tracks: matches of pairs joined over all photographs.

use super::block::{Observation, Track};

/// Matches of two photographs.
pub(super) struct PairMatches {
    pub photos: [usize; 2],
    /// Keypoints of the first and of the second.
    pub matches: Vec<(usize, usize)>,
}

/// Connected keypoints. A track with two keypoints of one photograph is wrong somewhere, and is
/// left out.
pub(super) fn join(keypoints: &[usize], pairs: &[PairMatches]) -> Vec<Track> {
    let mut starts = vec![0usize];
    for count in keypoints {
        starts.push(starts[starts.len() - 1] + count);
    }
    let total = starts[keypoints.len()];
    let mut parents: Vec<usize> = (0..total).collect();
    for pair in pairs {
        for &(i, j) in &pair.matches {
            let a = root(&mut parents, starts[pair.photos[0]] + i);
            let b = root(&mut parents, starts[pair.photos[1]] + j);
            // The smaller index is the root, whatever the order of the matches.
            parents[a.max(b)] = a.min(b);
        }
    }
    let mut of_root: Vec<Vec<Observation>> = vec![Vec::new(); total];
    for (photo, &count) in keypoints.iter().enumerate() {
        for keypoint in 0..count {
            let root = root(&mut parents, starts[photo] + keypoint);
            of_root[root].push(Observation {
                photo,
                keypoint,
                is_used: false,
            });
        }
    }
    let is_sound = |track: &Vec<Observation>| {
        track.len() >= 2 && track.windows(2).all(|pair| pair[0].photo != pair[1].photo)
    };
    (of_root.into_iter())
        .filter(is_sound)
        .map(|observations| Track {
            observations,
            point: None,
        })
        .collect()
}

fn root(parents: &mut [usize], mut i: usize) -> usize {
    while parents[i] != i {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matches_are_joined_and_contradictions_left_out() {
        let pairs = [
            ([0, 1], vec![(0, 0), (1, 1)]),
            ([1, 2], vec![(0, 2), (1, 0)]),
            // Joins keypoints 1 and 2 of the first photograph.
            ([0, 2], vec![(2, 0)]),
        ];
        let pairs = pairs.map(|(photos, matches)| PairMatches { photos, matches });
        let tracks = join(&[3, 2, 3], &pairs);
        assert_eq!(tracks.len(), 1);
        let found: Vec<_> = (tracks[0].observations.iter())
            .map(|o| (o.photo, o.keypoint))
            .collect();
        assert_eq!(found, [(0, 0), (1, 0), (2, 2)]);
    }
}
