//! What the headers state: which camera took a photograph, where, and in which direction.

use nalgebra::Point3;

use super::options::OrientOptions;
use super::photo::Photo;
use crate::base::error::listed as names;
use crate::base::geometry::mean_point;
use crate::base::math::{SURE_RESIDUAL_SIGMAS, median};
use crate::orienting::orientation::{Anchor, geocentric_of};
use crate::orienting::structure_from_motion::frame::{
    RECEIVER_SIGMA_M, StatedPose, rotation_of_angles,
};
use crate::orienting::structure_from_motion::ground_control::{GeoList, GeoPlace};
use crate::orienting::structure_from_motion::intrinsics::Intrinsics;
use crate::orienting::structure_from_motion::metadata::PhotoMetadata;

/// The cameras that took the photographs.
#[derive(Clone, Debug, Default)]
pub(super) struct Cameras {
    pub intrinsics: Vec<Intrinsics>,
    pub names: Vec<String>,
    /// Whose focal length is not stated?
    pub is_guessed: Vec<bool>,
    pub of_photo: Vec<usize>,
}

impl Cameras {
    /// What the headers state, and guesses where they state nothing.
    pub(super) fn or_guessed(&self, guesses: &[Intrinsics]) -> Vec<Intrinsics> {
        let both = guesses.iter().zip(&self.intrinsics);
        (both.zip(&self.is_guessed))
            .map(|((guess, stated), &is_guessed)| match is_guessed {
                true => guess.clone(),
                false => stated.clone(),
            })
            .collect()
    }

    /// Photographs of one model, size and focal length share a camera.
    pub(super) fn of(photos: &[Photo], options: &OrientOptions) -> Self {
        let mut cameras = Self::default();
        let mut keys: Vec<(&str, [u32; 2], Option<f64>)> = Vec::new();
        for photo in photos {
            let m = &photo.metadata;
            let key = (m.camera.as_str(), photo.size, m.focal_mm);
            let known = keys.iter().position(|k| *k == key);
            cameras.of_photo.push(known.unwrap_or(keys.len()));
            if known.is_none() {
                let focal = options.focal_px.or(m.focal_px);
                let longest = f64::from(photo.size[0].max(photo.size[1]));
                let intrinsics = Intrinsics::new(focal.unwrap_or(longest), photo.size);
                cameras.intrinsics.push(intrinsics);
                cameras.names.push(m.camera.clone());
                cameras.is_guessed.push(focal.is_none());
                keys.push(key);
            }
        }
        cameras
    }
}

/// What is stated of the photographs, in a frame that touches the Earth.
#[derive(Clone, Debug, Default)]
pub(super) struct Stated {
    pub poses: Vec<StatedPose>,
    /// Zero of the positions.
    pub anchor: Option<Anchor>,
    /// What is doubtful of it.
    pub notes: Vec<String>,
}

/// What the headers state, or a list of places instead.
pub(super) fn stated_of(photos: &[Photo], list: Option<&GeoList>) -> Stated {
    let paths: Vec<&str> = photos.iter().map(|p| p.path.as_str()).collect();
    let (listed, unknown) = list
        .map(|list| list.of_photographs(&paths))
        .unwrap_or_default();
    let place = |i: usize| listed.get(i).copied().flatten();
    let headers: Vec<PhotoMetadata> = (photos.iter().enumerate())
        .map(|(i, photo)| with_place(&photo.metadata, place(i)))
        .collect();
    let mut notes: Vec<String> = list
        .and_then(|list| list.problem.clone())
        .into_iter()
        .collect();
    if !unknown.is_empty() {
        notes.push(format!(
            "{} names photographs that are not there or several of one name: {}",
            GeoList::FILE,
            names(unknown)
        ));
    }
    notes.extend(beside_headers(photos, &headers));
    notes.extend(doubtful_positions(&headers, &paths));
    // A receiver measures no height of exactly 0; what fills an empty field does.
    let height = |m: &PhotoMetadata| m.height_m.filter(|h| *h != 0.0);
    let known = headers.iter().filter(|m| m.position.is_some());
    let mut heights: Vec<f64> = known.filter_map(height).collect();
    // Where a height is not known any near the others does: it does not count.
    let middle = median(&mut heights).unwrap_or(0.0);
    let geocentric = |m: &PhotoMetadata| {
        let [lon, lat] = m.position?;
        Some(geocentric_of(lon, lat, height(m).unwrap_or(middle)))
    };
    let all: Vec<Point3<f64>> = headers.iter().filter_map(geocentric).collect();
    let anchor = (!all.is_empty()).then(|| Anchor::near(&mean_point(&all)));
    let poses = (headers.iter().enumerate())
        .map(|(i, m)| StatedPose {
            position: anchor.and_then(|anchor| Some(anchor.local(&geocentric(m)?))),
            lacks_height: height(m).is_none(),
            sigma_m: place(i).and_then(|place| place.sigma_m),
            taken_s: m.taken.as_deref().and_then(seconds),
            rotation: m.yaw_pitch_roll.map(rotation_of_angles),
            yaw_pitch_roll: m.yaw_pitch_roll,
        })
        .collect();
    Stated {
        poses,
        anchor,
        notes,
    }
}

/// Seconds of "YYYY-MM-DD HH:MM:SS", as if each month had 31 days: a flight is shorter.
fn seconds(taken: &str) -> Option<f64> {
    let parts: Vec<f64> = (taken.split(['-', ' ', ':']))
        .map(|part| part.parse().ok())
        .collect::<Option<_>>()?;
    let &[year, month, day, hour, minute, second] = &parts[..] else {
        return None;
    };
    let days = (year * 12.0 + month) * 31.0 + day;
    Some(((days * 24.0 + hour) * 60.0 + minute) * 60.0 + second)
}

/// A header in which what a list states stands.
fn with_place(header: &PhotoMetadata, place: Option<&GeoPlace>) -> PhotoMetadata {
    let header = header.clone();
    match place {
        Some(place) => PhotoMetadata {
            position: Some(place.position),
            height_m: place.height_m,
            lacks_hemispheres: false,
            yaw_pitch_roll: place.yaw_pitch_roll.or(header.yaw_pitch_roll),
            ..header
        },
        None => header,
    }
}

/// A list that lies further from the positions in the headers than receivers err: it counts, but
/// a wrong zone or another flight's list would, too.
fn beside_headers(photos: &[Photo], listed: &[PhotoMetadata]) -> Option<String> {
    let on_ellipsoid = |m: &PhotoMetadata| {
        let [lon, lat] = m.position.filter(|_| !m.lacks_hemispheres)?;
        Some(geocentric_of(lon, lat, 0.0))
    };
    let both = photos.iter().zip(listed);
    let both = both.filter(|(photo, listed)| photo.metadata.position != listed.position);
    let apart = both.filter_map(|(photo, listed)| {
        Some((on_ellipsoid(&photo.metadata)? - on_ellipsoid(listed)?).norm())
    });
    let metres = median(&mut apart.collect::<Vec<f64>>())?;
    (metres > SURE_RESIDUAL_SIGMAS * RECEIVER_SIGMA_M).then(|| {
        format!(
            "the places in {} lie {metres:.0} m from the positions in the headers of the same \
             photographs: {0} counts; take it away where it is of another system or flight",
            GeoList::FILE
        )
    })
}

/// Positions that lack a part.
fn doubtful_positions(headers: &[PhotoMetadata], paths: &[&str]) -> Vec<String> {
    let with = |is_so: fn(&PhotoMetadata) -> bool| -> Vec<&str> {
        let both = headers.iter().zip(paths);
        both.filter(|(m, _)| m.position.is_some() && is_so(m))
            .map(|(_, path)| *path)
            .collect()
    };
    let all = with(|_| true).len();
    let mut notes = Vec::new();
    let unsigned = with(|m| m.lacks_hemispheres);
    if !unsigned.is_empty() {
        notes.push(format!(
            "{} of {all} positions do not state whether they are north or south, east or west: they \
             count as north and east ({}); write GPSLatitudeRef and GPSLongitudeRef into the headers",
            unsigned.len(),
            names(unsigned)
        ));
    }
    for (lacking, what) in [
        (with(|m| m.height_m.is_none()), "state no height"),
        (
            with(|m| m.height_m == Some(0.0)),
            "state a height of 0, which no receiver measures",
        ),
    ] {
        if !lacking.is_empty() {
            notes.push(format!(
                "{} of {all} positions {what}: of these only the plan counts ({})",
                lacking.len(),
                names(lacking)
            ));
        }
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orienting::structure_from_motion::features::Features;

    #[test]
    fn a_list_of_places_far_from_those_in_the_headers_is_named() {
        let at = |lon: f64, lat: f64| Photo {
            path: "a.jpg".to_owned(),
            size: [100, 80],
            metadata: PhotoMetadata {
                position: Some([lon, lat]),
                height_m: Some(120.0),
                ..PhotoMetadata::default()
            },
            features: Features::default(),
            colours: Vec::new(),
        };
        let list = GeoList::read("geo.txt", "EPSG:4326\na.jpg 19.2 50.1 120\n").unwrap();
        let notes = |lon, lat| stated_of(&[at(lon, lat)], Some(&list)).notes;
        // One 700th of a degree of latitude is 159 m.
        let far = notes(19.2, 50.1 + 1.0 / 700.0);
        assert!(far.len() == 1 && far[0].contains("159 m"), "{far:?}");
        assert_eq!(notes(19.20003, 50.1), Vec::<String>::new());
    }
}
