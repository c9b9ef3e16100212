//! Receivers that state positions late along the flight, and what a frame is worth.

use super::*;

/// Seconds between photographs, and the order in which a lawn-mower flight takes them.
const STEP_S: f64 = 4.0;
const ORDER: [usize; 9] = [0, 1, 2, 5, 4, 3, 6, 7, 8];

/// Positions of a flight that are so many seconds late, with this noise.
fn late(truth: &Block, lag_s: f64, noise_m: f64, seed: u64) -> Vec<StatedPose> {
    let center = |i: usize| truth.photos[i].pose.as_ref().unwrap().center;
    let mut random = Random::new(seed);
    let mut stated = vec![StatedPose::default(); 9];
    for (k, &photo) in ORDER.iter().enumerate() {
        let from = k.saturating_sub(1);
        let path = center(ORDER[from + 1]) - center(ORDER[from]);
        let velocity = path / STEP_S;
        let noise = Vector3::from_fn(|_, _| noise_m * random.normal());
        stated[photo] = StatedPose {
            position: Some(center(photo) - velocity * lag_s + noise),
            taken_s: Some(1000.0 + STEP_S * k as f64),
            sigma_m: Some(noise_m),
            rotation: Some(truth.photos[photo].pose.as_ref().unwrap().rotation),
            ..StatedPose::default()
        };
    }
    stated
}

fn lag_of(basis: &FrameBasis) -> (&Lag, &FrameSigma) {
    match basis {
        FrameBasis::Positions {
            lag: Some(lag),
            sigma: Some(sigma),
            ..
        } => (lag, sigma),
        _ => panic!("{basis:?}"),
    }
}

#[test]
fn a_lag_is_found_with_its_sigma_and_taken_out() {
    for lag_s in [0.7, -0.5] {
        let (truth, mut block, _) = moved();
        let stated = late(&truth, lag_s, 0.2, 8);
        let (basis, notes) = framed(&mut block, &stated, Some(ANCHOR));
        let (lag, _) = lag_of(&basis);
        assert!(lag.is_applied && lag.unit == "s", "{lag:?} {notes:?}");
        assert!((lag.lag - lag_s).abs() < 3.0 * lag.sigma, "{lag:?}");
        assert!(lag.sigma < 0.05 && lag.after_m[0] < 0.4, "{lag:?}");
        assert!(lag.before_m[0] > 3.0 * lag.after_m[0], "{lag:?}");
        let side = if lag_s > 0.0 {
            "behind the"
        } else {
            "ahead of the"
        };
        assert!(lag.words().contains(side), "{}", lag.words());
        let (plan, tilt) = off(&block, &truth);
        assert!(plan < 0.5 && tilt < 0.02, "{plan} {tilt}");
    }
}

#[test]
fn without_times_the_lag_is_metres_and_without_a_lag_none_is_taken_out() {
    let (truth, block, _) = moved();
    let mut stated = late(&truth, 0.7, 0.2, 8);
    for one in &mut stated {
        one.taken_s = None;
    }
    // The names are in the order of the strips, all of which lead east then: of the middle one the
    // path is another, so that its photographs change places.
    let swapped = |i: usize| if i / 3 == 1 { 8 - i } else { i };
    let mut by_name = block.clone();
    by_name.photos = (0..9).map(|i| block.photos[swapped(i)].clone()).collect();
    for o in by_name.tracks.iter_mut().flat_map(|t| &mut t.observations) {
        o.photo = swapped(o.photo);
    }
    let named: Vec<StatedPose> = (0..9).map(|i| stated[swapped(i)].clone()).collect();
    let (basis, _) = framed(&mut by_name, &named, Some(ANCHOR));
    let (lag, _) = lag_of(&basis);
    assert!(lag.is_applied && lag.unit == "m", "{lag:?}");
    // 20 m in 4 s.
    assert!((lag.lag - 0.7 * 5.0).abs() < 0.5, "{lag:?}");
    for seed in 0..5 {
        let stated = late(&truth, 0.0, 0.3, seed);
        let (basis, _) = framed(&mut block.clone(), &stated, Some(ANCHOR));
        let (lag, _) = lag_of(&basis);
        assert!(!lag.is_applied && lag.after_m == lag.before_m, "{lag:?}");
        assert!(lag.words().contains("too little"), "{}", lag.words());
    }
}

#[test]
fn a_flight_that_tells_no_lag_says_none() {
    let (truth, mut block, _) = moved();
    let mut stated = late(&truth, 0.7, 0.2, 8);
    for (i, one) in stated.iter_mut().enumerate() {
        one.position = one.position.filter(|_| i < 3);
        one.sigma_m = None;
    }
    let (basis, _) = framed(&mut block, &stated, Some(ANCHOR));
    let FrameBasis::Positions { lag, sigma, .. } = basis else {
        panic!("{basis:?}")
    };
    assert!(lag.is_none_or(|lag| !lag.is_applied));
    // A strip is levelled by the angles, whose own noise is a degree.
    let sigma = sigma.unwrap();
    assert!(sigma.tilt() > 0.9f64.to_radians(), "{sigma:?}");
}

#[test]
fn scale_and_level_are_worth_what_they_scatter_by() {
    let (truth, block, _) = moved();
    let apart = |b: &Block| {
        let [a, c] = [0, 8].map(|i| b.photos[i].pose.as_ref().unwrap().center);
        (a - c).norm()
    };
    let (mut scales, mut stated_sigmas) = (Vec::new(), Vec::new());
    for seed in 0..100 {
        let stated = late(&truth, 0.0, 0.5, seed);
        let mut block = block.clone();
        let (basis, _) = framed(&mut block, &stated, Some(ANCHOR));
        let (_, sigma) = lag_of(&basis);
        scales.push(math::ln(apart(&block) / apart(&truth)));
        stated_sigmas.push(sigma.scale());
    }
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let square = |s: &f64| (s - mean(&scales)) * (s - mean(&scales));
    let squares: Vec<f64> = scales.iter().map(square).collect();
    let ratio = mean(&stated_sigmas) / mean(&squares).sqrt();
    assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
}
