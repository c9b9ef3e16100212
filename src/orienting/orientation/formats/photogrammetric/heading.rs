//! The columns that the heading of a list names, in the words of programs and languages.

use super::fields::{Separator, cells};
use crate::orienting::orientation::formats::text::is_number;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    Name,
    X,
    Y,
    Z,
    Omega,
    Phi,
    Kappa,
    Yaw,
    Pitch,
    Roll,
}

/// How the angles of a list turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AngleKind {
    OmegaPhiKappa,
    YawPitchRoll,
}

/// Where a list holds what, as its heading names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Columns {
    /// Number of columns that the heading names.
    pub count: usize,
    pub name: usize,
    pub center: [usize; 3],
    pub angles: [usize; 3],
    pub kind: AngleKind,
}

/// What a line of words says about the columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Heading {
    /// All columns that are needed.
    Columns(Columns),
    /// Some of them, and this one is missing.
    Lacks(&'static str),
    /// Nothing that is understood.
    Other,
}

/// Reads a line as a heading. Programs separate it otherwise than the data (Metashape: commas over
/// tabs), so that the separator is the one which gives the most columns.
pub(crate) fn heading(text: &str) -> Heading {
    let text = text.trim_start_matches(['#', '!', '%', '/']).trim();
    let named = |separator: &Separator| {
        let columns: Vec<(Option<Column>, bool)> =
            cells(text, *separator).iter().map(|c| column(c)).collect();
        let known = columns.iter().filter(|(c, _)| c.is_some()).count();
        (known, columns)
    };
    let all = [
        Separator::Comma,
        Separator::Tab,
        Separator::Semicolon,
        Separator::Blank,
    ];
    // Of equally good ones the first: a comma in "X, Y" is no part of a name.
    let best = (all.iter().map(named)).reduce(|a, b| if b.0 > a.0 { b } else { a });
    let Some((known, columns)) = best else {
        return Heading::Other;
    };
    // Sentences may hold a word or two that are names of columns.
    if known < 4 || text.split([' ', ',', ';', '\t']).any(is_number) {
        return Heading::Other;
    }
    // Adjusted values (Metashape's "_est") stand beside those before the adjustment.
    match of_columns(&columns, true) {
        Heading::Columns(found) => Heading::Columns(found),
        _ => of_columns(&columns, false),
    }
}

fn of_columns(columns: &[(Option<Column>, bool)], estimated: bool) -> Heading {
    let find = |wanted: Column| (columns.iter()).position(|c| *c == (Some(wanted), estimated));
    let three = |wanted: [(Column, &'static str); 3]| -> Result<[usize; 3], &'static str> {
        let mut found = [0; 3];
        for (place, (column, name)) in found.iter_mut().zip(wanted) {
            *place = find(column).ok_or(name)?;
        }
        Ok(found)
    };
    let center = three([(Column::X, "X"), (Column::Y, "Y"), (Column::Z, "Z")]);
    let opk = three([
        (Column::Omega, "omega"),
        (Column::Phi, "phi"),
        (Column::Kappa, "kappa"),
    ]);
    let ypr = three([
        (Column::Yaw, "yaw"),
        (Column::Pitch, "pitch"),
        (Column::Roll, "roll"),
    ]);
    let (kind, angles) = match (opk, ypr) {
        (Ok(opk), _) => (AngleKind::OmegaPhiKappa, opk),
        (_, Ok(ypr)) => (AngleKind::YawPitchRoll, ypr),
        (Err(a), Err(b)) => {
            let has_ypr = [Column::Yaw, Column::Pitch, Column::Roll]
                .iter()
                .any(|&c| find(c).is_some());
            return Heading::Lacks(if has_ypr { b } else { a });
        }
    };
    let center = match center {
        Ok(center) => center,
        Err(missing) => return Heading::Lacks(missing),
    };
    let name = (columns.iter()).position(|(c, _)| *c == Some(Column::Name));
    // Without a name for it, the image stands in front.
    let first = center.iter().chain(&angles).all(|&i| i > 0).then_some(0);
    match name.or(first) {
        Some(name) => Heading::Columns(Columns {
            count: columns.len(),
            name,
            center,
            angles,
            kind,
        }),
        None => Heading::Lacks("the image"),
    }
}

/// The column that a word of the heading names, and whether it holds adjusted values.
fn column(word: &str) -> (Option<Column>, bool) {
    let lower = word.to_lowercase();
    let plain = lower.split(['[', '(']).next().unwrap_or_default().trim();
    let (plain, estimated) = match plain
        .strip_suffix("_est")
        .or_else(|| plain.strip_suffix(" est"))
    {
        Some(rest) => (rest, true),
        None => (plain, false),
    };
    let found = plain
        .split('/')
        .find_map(|part| by_word(part.trim_matches(['_', ' ', '.'])));
    (found, estimated)
}

fn by_word(word: &str) -> Option<Column> {
    Some(match word {
        "image" | "imagename" | "image name" | "image_name" | "image id" | "imageid" | "photo"
        | "photoid" | "photo id" | "photo name" | "label" | "name" | "file" | "filename"
        | "file name" | "file_name" | "bild" | "bildname" | "foto" | "luftbild" | "nom"
        | "imagen" | "immagine" | "nome" | "nombre" | "cliché" | "cliche" => Column::Name,
        "x" | "x0" | "xo" | "xc" | "easting" | "east" | "e" | "longitude" | "lon" | "long"
        | "lng" | "rechtswert" | "rechts" | "ost" | "este" | "est" | "geo_x" => Column::X,
        "y" | "y0" | "yo" | "yc" | "northing" | "north" | "n" | "latitude" | "lat" | "hochwert"
        | "hoch" | "nord" | "norte" | "geo_y" => Column::Y,
        "z" | "z0" | "zo" | "zc" | "height" | "altitude" | "alt" | "elevation" | "h" | "höhe"
        | "hoehe" | "hauteur" | "altura" | "quota" | "cota" | "hoogte" | "geo_z" => Column::Z,
        "omega" | "ω" | "omg" | "om" => Column::Omega,
        "phi" | "φ" | "ϕ" | "ph" => Column::Phi,
        "kappa" | "κ" | "kap" | "ka" => Column::Kappa,
        "yaw" | "heading" | "azimuth" => Column::Yaw,
        "pitch" => Column::Pitch,
        "roll" => Column::Roll,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(text: &str) -> (usize, [usize; 3], [usize; 3], AngleKind) {
        match heading(text) {
            Heading::Columns(c) => (c.name, c.center, c.angles, c.kind),
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn the_heading_decides_about_the_columns() {
        let usual = (0, [1, 2, 3], [4, 5, 6], AngleKind::OmegaPhiKappa);
        for text in [
            "imageName X Y Z Omega Phi Kappa",
            "# PhotoID, X, Y, Z, Omega, Phi, Kappa, r11, r12, r13, r21, r22, r23, r31, r32, r33",
            "Bild;Rechtswert;Hochwert;Höhe;Omega [gon];Phi [gon];Kappa [gon]",
            "Photo\tEasting (m)\tNorthing (m)\tHeight (m)\tω\tφ\tκ",
            "! Foto  Este  Norte  Cota  Omega  Phi  Kappa",
        ] {
            assert_eq!(places(text), usual, "{text}");
        }
        assert_eq!(
            places("imageName latitude longitude altitude phi omega kappa"),
            (0, [2, 1, 3], [5, 4, 6], AngleKind::OmegaPhiKappa)
        );
        // Metashape's reference pane: the adjusted values are the orientation.
        let text = "#Label,X/Longitude,Y/Latitude,Z/Altitude,Yaw,Pitch,Roll,Error_(m),X_error,\
                    Y_error,Z_error,Error_(deg),Yaw_error,Pitch_error,Roll_error,X_est,Y_est,\
                    Z_est,Yaw_est,Pitch_est,Roll_est";
        assert_eq!(
            places(text),
            (0, [15, 16, 17], [18, 19, 20], AngleKind::YawPitchRoll)
        );
    }

    #[test]
    fn what_is_missing_is_named_and_sentences_are_no_headings() {
        assert_eq!(heading("name,x,y,z,omega,phi"), Heading::Lacks("kappa"));
        assert_eq!(heading("name;lat;alt;yaw;pitch;roll"), Heading::Lacks("X"));
        assert_eq!(
            heading("# exterior orientation in metres and gon"),
            Heading::Other
        );
        assert_eq!(
            heading("# X Y Z in EPSG 25832, omega phi kappa"),
            Heading::Other
        );
    }
}
