//! Numbers in XMP by the names of their attributes or elements, whatever their namespace.

/// The number of the first attribute or element of a name.
pub(super) fn number(xmp: &str, name: &str) -> Option<f64> {
    let mut rest = xmp;
    while let Some(at) = rest.find(name) {
        let before = rest[..at].chars().next_back();
        rest = &rest[at + name.len()..];
        if !matches!(before, Some(':' | ' ' | '<')) {
            continue;
        }
        let value = rest.trim_start_matches(['=', '"', '\'', '>', ' ']);
        let end = value.find(['"', '\'', '<']).unwrap_or(value.len());
        let value = value[..end].trim();
        let number = value.trim_start_matches('+').parse::<f64>();
        if let Ok(number) = number
            && number.is_finite()
        {
            return Some(number);
        }
    }
    None
}

/// Longitude and latitude as drones write them beside EXIF, degrees with their sign.
pub(super) fn position(xmp: &str) -> Option<[f64; 2]> {
    // One maker's firmware misspells the name.
    let lon = number(xmp, "GpsLongitude").or_else(|| number(xmp, "GpsLongtitude"))?;
    Some([lon, number(xmp, "GpsLatitude")?])
}

/// Angles of the gimbal, or of the camera where it is fixed.
pub(super) fn yaw_pitch_roll(xmp: &str) -> Option<[f64; 3]> {
    let all = |names: [&str; 3]| {
        let [yaw, pitch, roll] = names.map(|name| number(xmp, name));
        // Three zeros are fields that nobody filled.
        Some([yaw?, pitch?, roll?]).filter(|angles| *angles != [0.0; 3])
    };
    let of_gimbal = all(["GimbalYawDegree", "GimbalPitchDegree", "GimbalRollDegree"]);
    // Cameras that look down count their pitch from there.
    let of_camera = || all(["Camera:Yaw", "Camera:Pitch", "Camera:Roll"]);
    of_gimbal.or_else(|| of_camera().map(|[y, p, r]| [y, p - 90.0, r]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_and_elements_are_read() {
        let xmp = "<a drone-dji:GimbalYawDegreeX=\"1\" drone-dji:GimbalYawDegree=\"-12.5\">\
                   <drone-dji:GimbalPitchDegree>-45</drone-dji:GimbalPitchDegree>";
        assert_eq!(number(xmp, "GimbalYawDegree"), Some(-12.5));
        assert_eq!(number(xmp, "GimbalPitchDegree"), Some(-45.0));
        assert_eq!(number(xmp, "GimbalRollDegree"), None);
        assert_eq!(yaw_pitch_roll(xmp), None);
        let level = |yaw: &str| {
            let rest = "GimbalPitchDegree=\"0.0\" GimbalRollDegree=\"+0.00\"";
            yaw_pitch_roll(&format!(" GimbalYawDegree=\"{yaw}\" {rest}"))
        };
        assert_eq!([level("0"), level("-3")], [None, Some([-3.0, 0.0, 0.0])]);
    }
}
