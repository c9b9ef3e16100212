//! The coordinate reference system that files name, as its EPSG code.

use super::format::Format;

/// EPSG code of the reference system that a file of this format states, if any.
pub(crate) fn stated(format: Format, text: &str) -> Option<u32> {
    let part = match format {
        Format::Inpho => {
            let after = text.split("$COORDINATE_SYSTEM").nth(1)?;
            after.split('$').next()?
        }
        Format::Blocks => {
            let after = text.split("<Definition>").nth(1)?;
            after.split("</Definition>").next()?
        }
        _ => return None,
    };
    epsg_of(part)
}

/// EPSG code of a system written as well-known text, as "EPSG:25832", or as the number alone. The
/// last code is that of the whole system; those before belong to its parts (ellipsoid, datum,
/// units).
pub fn epsg_of(text: &str) -> Option<u32> {
    if let Ok(number) = text.trim().parse::<u32>() {
        return is_plausible(number).then_some(number);
    }
    let (_, after) = text.rsplit_once("EPSG")?;
    let digits: String = (after.chars().skip_while(|c| "\",: /0".contains(*c)))
        .take_while(char::is_ascii_digit)
        .collect();
    digits.parse().ok().filter(|&n| is_plausible(n))
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
        assert_eq!(stated(Format::Inpho, &project), Some(25832));
    }
}
