use super::*;

/// Blobs and bars of many sizes, drawn at any scale and turn about the middle.
fn scene(size: usize, scale: f64, turn: f64) -> Gray {
    let (sin, cos) = crate::base::math::sin_cos(turn);
    let middle = size as f64 / 2.0;
    let mut random = super::super::random::Random::new(11);
    let blobs: Vec<[f64; 5]> = (0..220)
        .map(|_| {
            let place = 0.55 * size as f64;
            let width = 1.5 + 2.5 * (1.0 + random.signed());
            let long = width * (1.5 + 0.5 * random.signed());
            [
                place * random.signed(),
                place * random.signed(),
                width,
                long,
                random.signed(),
            ]
        })
        .collect();
    Gray::from_fn(size, size, |x, y| {
        let (dx, dy) = (x as f64 + 0.5 - middle, y as f64 + 0.5 - middle);
        let (u, v) = ((cos * dx + sin * dy) / scale, (cos * dy - sin * dx) / scale);
        let mut value = 0.5;
        for [bx, by, width, long, sign] in &blobs {
            let (p, q) = ((u - bx) / width, (v - by) / long);
            let square = p * p + q * q;
            if square < 16.0 {
                value += 0.35 * sign * crate::base::math::exp(-0.5 * square);
            }
        }
        value as f32
    })
}

#[test]
fn keypoints_and_descriptors_follow_a_turn_and_a_change_of_scale() {
    let options = FeatureOptions::default();
    let first = detect_features(&scene(240, 1.0, 0.0), &options);
    assert!(first.keypoints.len() > 150, "{}", first.keypoints.len());
    for (scale, turn) in [(1.0, 0.6), (1.3, -2.2), (0.8, 1.6)] {
        let second = detect_features(&scene(240, scale, turn), &options);
        let matches = super::super::matching::mutual_matches(&first, &second);
        let (sin, cos) = crate::base::math::sin_cos(turn);
        let mut offsets: Vec<f64> = (matches.iter())
            .map(|&(i, j)| {
                let [x, y] = first.keypoints[i].position.map(|p| (p - 120.0) * scale);
                let [u, v] = second.keypoints[j].position.map(|p| p - 120.0);
                crate::base::math::hypot(cos * x - sin * y - u, sin * x + cos * y - v)
            })
            .collect();
        let right = offsets.iter().filter(|o| **o < 2.0).count();
        let share = right as f64 / offsets.len() as f64;
        assert!(right > 60 && share > 0.9, "{scale} {turn}: {right} {share}");
        let median = crate::base::math::median(&mut offsets).unwrap();
        assert!(median < 0.15, "{scale} {turn}: {median} px");
    }
}

#[test]
fn an_image_without_texture_has_no_features() {
    let flat = Gray::from_fn(200, 150, |_, _| 0.4);
    assert_eq!(
        detect_features(&flat, &FeatureOptions::default()),
        Features::default()
    );
    let tiny = Gray::new(8, 8);
    assert_eq!(
        detect_features(&tiny, &FeatureOptions::default()),
        Features::default()
    );
}

#[test]
fn few_keypoints_are_the_strong_ones_and_lie_everywhere() {
    let image = scene(240, 1.0, 0.0);
    let options = FeatureOptions {
        most: 80,
        ..FeatureOptions::default()
    };
    let features = detect_features(&image, &options);
    assert_eq!(features.keypoints.len(), 80);
    for quarter in 0..4 {
        let is_in = |k: &&Keypoint| {
            let [right, below] = k.position.map(|p| usize::from(p > 120.0));
            right + 2 * below == quarter
        };
        let count = features.keypoints.iter().filter(is_in).count();
        assert!(count > 8, "{quarter}: {count}");
    }
}
