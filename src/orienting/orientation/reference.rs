//! The coordinate reference system that files name, as its EPSG code.

use super::geodesy::Anchor;

/// What the files of an orientation say about the system of their coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum StatedReference {
    /// Nothing.
    None,
    /// EPSG code of the system.
    System(u32),
    /// East, north, up from a place.
    Place(Anchor),
    /// A frame of their own, for this reason: no system named elsewhere belongs to it.
    Local(String),
}

/// EPSG code of the system of an INPHO project.
pub(crate) fn of_inpho(text: &str) -> StatedReference {
    let after = text.split("$COORDINATE_SYSTEM").nth(1);
    let part = after.and_then(|after| after.split('$').next());
    part.and_then(epsg_of)
        .map_or(StatedReference::None, StatedReference::System)
}

/// EPSG code of a system written as well-known text, as "EPSG:25832", or as the number alone.
///
/// In well-known text only the code of the whole system counts: those of its ellipsoid, its units
/// or its heights name something else. Of a compound system the horizontal part is taken.
pub fn epsg_of(text: &str) -> Option<u32> {
    if let Ok(number) = text.trim().parse::<u32>() {
        return is_plausible(number).then_some(number);
    }
    let text = text.to_ascii_uppercase();
    if text.contains('[') {
        return of_well_known_text(&text);
    }
    let (_, after) = text.rsplit_once("EPSG")?;
    code_in(after)
}

/// The number that follows "EPSG".
fn code_in(after: &str) -> Option<u32> {
    let digits: String = (after.chars().skip_while(|c| "\",: /0".contains(*c)))
        .take_while(char::is_ascii_digit)
        .collect();
    digits.parse().ok().filter(|&n| is_plausible(n))
}

/// The code that stands directly in the outermost brackets, else in those of a compound's
/// horizontal part.
fn of_well_known_text(text: &str) -> Option<u32> {
    let mut open: Vec<&str> = Vec::new();
    let mut of_part = None;
    let (mut word, mut quoted) = (0, false);
    for (i, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '[' => {
                let name = text[word..i].trim();
                let inside = &text[i + 1..];
                if matches!(name, "AUTHORITY" | "ID") && inside.starts_with("\"EPSG\"") {
                    let code = code_in(&inside["\"EPSG\"".len()..]);
                    match open[..] {
                        [_] => return code,
                        [
                            "COMPD_CS" | "COMPOUNDCRS",
                            "PROJCS" | "PROJCRS" | "GEOGCS" | "GEOGCRS",
                        ] => {
                            of_part = code;
                        }
                        _ => {}
                    }
                }
                open.push(name);
                word = i + 1;
            }
            ']' => {
                open.pop();
                word = i + 1;
            }
            ',' => word = i + 1,
            _ => {}
        }
    }
    of_part
}

fn is_plausible(number: u32) -> bool {
    (1024..=32_767).contains(&number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_the_whole_system_is_found() {
        let wkt = r#"PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",AUTHORITY["EPSG","4258"]],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AUTHORITY["EPSG","25832"]]"#;
        assert_eq!(epsg_of(wkt), Some(25832));
        assert_eq!(epsg_of(r#"PROJCRS["x",ID["EPSG",2056]]"#), Some(2056));
        assert_eq!(epsg_of("urn:ogc:def:crs:EPSG::5514"), Some(5514));
        assert_eq!(
            epsg_of("https://www.opengis.net/def/crs/EPSG/0/7415"),
            Some(7415)
        );
        assert_eq!(
            (epsg_of("EPSG:25832"), epsg_of(" 25832 ")),
            (Some(25832), Some(25832))
        );
        assert_eq!(
            (
                epsg_of("EPSG:"),
                epsg_of("LOCAL_CS[\"x\"]"),
                epsg_of("EPSG:99999999999")
            ),
            (None, None, None)
        );
        let project =
            format!("$PROJECT 6\n $COORDINATE_SYSTEM :\n {wkt}\n $UNITS : m\n$END\n EPSG:4326");
        assert_eq!(of_inpho(&project), StatedReference::System(25832));
    }

    #[test]
    fn codes_of_parts_are_not_those_of_the_system() {
        let plane = r#"PROJCS["x",GEOGCS["y",AUTHORITY["EPSG","4258"]],UNIT["metre",1,AUTHORITY["EPSG","9001"]]@]"#;
        let with = |own: &str| plane.replace('@', own);
        let height = r#"VERT_CS["h",UNIT["m",1],AUTHORITY["EPSG","7837"]]"#;
        let compound = |own: &str| format!("COMPD_CS[\"z\",{},{height}]", with(own));
        let own = r#",AUTHORITY["EPSG","25832"]"#;
        assert_eq!(epsg_of(&with(own)), Some(25832));
        assert_eq!(epsg_of(&with("")), None, "that of the unit is none");
        assert_eq!(epsg_of(&compound(own)), Some(25832));
        assert_eq!(epsg_of(&compound("")), None, "that of the heights is none");
        assert_eq!(epsg_of("+init=epsg:31467 +units=m"), Some(31467));
        assert_eq!(epsg_of("EPSG:32636+5773"), Some(32636));
        for broken in [
            "[",
            "]",
            "PROJCS[\"",
            "AUTHORITY[\"EPSG\"",
            "\u{e9}[\"EPSG",
            "][[",
        ] {
            assert_eq!(epsg_of(broken), None);
        }
    }
}
