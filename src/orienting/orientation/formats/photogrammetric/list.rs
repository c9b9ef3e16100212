//! The exterior orientation as people have it: `image X Y Z omega phi kappa` between tabs,
//! semicolons, commas or blanks, with decimal points or commas, more columns, blanks in names,
//! running numbers and headings in any language.
//!
//! The form is the one in which most lines can be read. A heading that names the columns decides
//! about them; otherwise they stand in the order above.

use std::collections::BTreeSet;

use nalgebra::Point3;

use super::fields::{Separator, cells, is_whole};
use super::heading::{AngleKind, Columns, Heading, heading};
use crate::base::error::{Error, Result};
use crate::orienting::orientation::formats::text::{TextLine, is_number, lines, quoted};

/// What a line should hold.
const EXPECTED: &str = "image X0 Y0 Z0 omega phi kappa";

/// Lines from which the form is found.
const SAMPLE_LINES: usize = 20;

/// How the numbers of a list are written, and where they stand.
#[derive(Clone, Debug)]
struct Form {
    separator: Separator,
    decimal_comma: bool,
    columns: Option<Columns>,
    /// Does a running number stand before the image?
    is_numbered: bool,
}

/// One line of the exterior list; angles in the file's unit.
pub(super) struct ListedPose {
    pub image: String,
    pub source: String,
    pub center: Point3<f64>,
    pub angles: [f64; 3],
}

/// A list of exterior orientations.
pub(super) struct ExteriorList {
    pub poses: Vec<ListedPose>,
    pub kind: AngleKind,
    /// Comments and headings: they may state the unit of the angles.
    pub words: String,
    /// Is the heading one of a program that writes degrees only?
    pub is_of_degrees: bool,
    /// A heading of which nothing is understood.
    pub unknown_heading: Option<String>,
}

/// Reads a list.
pub(super) fn read(path: &str, text: &str) -> Result<ExteriorList> {
    let parts = Parts::of(path, text);
    if parts.data.is_empty() {
        return Err(Error::file(
            path,
            "it lists no image",
            format!("add lines `{EXPECTED}`"),
        ));
    }
    let (columns, unknown) = parts.columns()?;
    let form = parts.form(columns.as_ref());
    if let Some(line) = unknown.filter(|_| !has_no_more(&parts.data[0], &form)) {
        return Err(line.error(
            format!("the heading {} is not understood", quoted(line.text)),
            "columns called image, X, Y, Z, omega, phi, kappa",
        ));
    }
    let mut poses = Vec::new();
    for line in &parts.data {
        poses.extend(pose(line, &form)?);
    }
    refuse_split_decimals(&parts.data[0], &form)?;
    let lower = parts.words.to_lowercase();
    Ok(ExteriorList {
        poses,
        kind: (form.columns.as_ref()).map_or(AngleKind::OmegaPhiKappa, |c| c.kind),
        is_of_degrees: [
            "photoid,",
            "imagename x y z",
            "imagename latitude longitude",
        ]
        .iter()
        .any(|heading| lower.contains(heading)),
        words: parts.words,
        unknown_heading: unknown.map(|line| quoted(line.text)),
    })
}

/// Do the first lines of a text look like such a list?
pub(crate) fn is_list(text: &str) -> bool {
    let parts = Parts::of("", text);
    let Ok((columns, unknown)) = parts.columns() else {
        return false;
    };
    let form = parts.form(columns.as_ref());
    let fit = parts.fitting(&form);
    if 2 * fit <= parts.sample().len() {
        return false;
    }
    // Many tables have a number in front and six behind it: then these must be all.
    let is_named = |line: &TextLine| match pose(line, &form) {
        Ok(Some(pose)) if is_number(&pose.image) => {
            is_whole(&pose.image) && cells(line.text, form.separator).len() == 7
        }
        _ => true,
    };
    let is_plain = unknown.is_none() || has_no_more(&parts.data[0], &form);
    form.columns.is_some() || is_plain && parts.sample().iter().all(is_named)
}

/// Why a text that is no list is none, where it nearly is: lines of a name and three numbers or
/// more.
pub(crate) fn nearly_a_list(path: &str, text: &str) -> Option<Error> {
    let parts = Parts::of(path, text);
    let looks_alike = |line: &&TextLine| {
        let fields = line.text.split([' ', '\t', ',', ';']);
        let numbers = fields.filter(|f| is_number(f)).count();
        (3..40).contains(&numbers) && line.text.contains(char::is_alphabetic)
    };
    let alike = parts.sample().iter().filter(looks_alike).count();
    if alike == 0 || 2 * alike < parts.sample().len() {
        return None;
    }
    read(path, text).err()
}

/// A text as comments, headings and data.
struct Parts<'a> {
    data: Vec<TextLine<'a>>,
    /// Lines that may be a heading: the last comment, and words before the data.
    headings: Vec<TextLine<'a>>,
    words: String,
}

impl<'a> Parts<'a> {
    fn of(path: &'a str, text: &'a str) -> Self {
        let mut parts = Self {
            data: Vec::new(),
            headings: Vec::new(),
            words: String::new(),
        };
        for line in lines(path, text).filter(|l| !l.text.is_empty()) {
            let is_comment = ["#", "!", "%", "//"]
                .iter()
                .any(|sign| line.text.starts_with(sign));
            if is_comment || parts.data.is_empty() && is_words(line.text) {
                parts.words.push_str(line.text);
                parts.words.push('\n');
                if parts.data.is_empty() {
                    parts.headings.push(line);
                }
            } else {
                parts.data.push(line);
            }
        }
        parts
    }

    fn sample(&self) -> &[TextLine<'a>] {
        &self.data[..self.data.len().min(SAMPLE_LINES)]
    }

    /// The columns that a heading names, or the heading that names none.
    fn columns(&self) -> Result<(Option<Columns>, Option<TextLine<'a>>)> {
        let mut unknown = None;
        for line in self.headings.iter().rev() {
            let is_comment = line.text.starts_with(['#', '!', '%', '/']);
            let lower = line.text.to_lowercase();
            // A list of other angles must not be read as omega, phi, kappa.
            let is_of_others = ["yaw", "pitch", "roll"].iter().all(|w| lower.contains(w));
            match heading(line.text) {
                Heading::Columns(columns) => return Ok((Some(columns), None)),
                Heading::Lacks(what) if !is_comment || is_of_others => {
                    return Err(line.error(
                        format!("the heading names no column of {what}"),
                        "columns of the image, X, Y, Z and omega, phi, kappa (or yaw, pitch, roll)",
                    ));
                }
                Heading::Lacks(_) => {}
                Heading::Other if is_comment => {}
                Heading::Other => {
                    let _ = unknown.get_or_insert(*line);
                }
            }
        }
        Ok((None, unknown))
    }

    /// The form in which most lines can be read; of equally good ones the first, so that a comma
    /// separates before it is a decimal sign, and a heading is heeded where it fits.
    fn form(&self, columns: Option<&Columns>) -> Form {
        let separators = [
            Separator::Tab,
            Separator::Semicolon,
            Separator::Comma,
            Separator::Blank,
        ];
        let mut best: Option<((usize, usize, bool), Form)> = None;
        for decimal_comma in [false, true] {
            for separator in separators {
                for columns in [columns, None] {
                    for is_numbered in [true, false] {
                        let form = Form {
                            separator,
                            decimal_comma,
                            columns: columns.cloned(),
                            is_numbered,
                        };
                        let fitting = self.fitting(&form);
                        // A damaged line is explained as one without a running number.
                        let is_plain = fitting == 0 && !is_numbered;
                        let rank = (fitting, self.numbers(&form), is_plain);
                        if best.as_ref().is_none_or(|(most, _)| rank > *most) {
                            best = Some((rank, form));
                        }
                    }
                }
            }
        }
        best.expect("there are forms").1
    }

    /// Lines of the sample that can be read; none where running numbers cannot be told from names.
    fn fitting(&self, form: &Form) -> usize {
        let read: Vec<Option<ListedPose>> = (self.sample().iter())
            .filter_map(|line| pose(line, form).ok())
            .collect();
        if form.is_numbered {
            let poses = || read.iter().flatten();
            let names: BTreeSet<&str> = poses().map(|p| &*p.image).collect();
            if names.len() < poses().count() {
                return 0;
            }
        }
        read.len()
    }

    /// Numbers in the first line: where no line can be read, the nearest form explains why.
    fn numbers(&self, form: &Form) -> usize {
        let Some(line) = self.data.first() else {
            return 0;
        };
        (cells(line.text, form.separator).iter())
            .filter(|c| number(c, form.decimal_comma).is_some())
            .count()
    }
}

/// One line; `None` where it names an image and leaves its orientation blank.
fn pose(line: &TextLine, form: &Form) -> Result<Option<ListedPose>> {
    let cells = cells(line.text, form.separator);
    let (image, numbers) = match &form.columns {
        Some(columns) => by_columns(line, &cells, form, columns)?,
        None => by_order(line, &cells, form)?,
    };
    if image.is_empty() {
        return Err(line.error("no image is named", EXPECTED));
    }
    if numbers.iter().all(|field| field.is_empty()) {
        return Ok(None);
    }
    let mut values = [0.0; 6];
    for (i, (value, field)) in values.iter_mut().zip(numbers).enumerate() {
        let what = if i < 3 { "a coordinate" } else { "an angle" };
        let found = number(field, form.decimal_comma).filter(|v| v.is_finite());
        *value = found.ok_or_else(|| {
            let sign = if form.decimal_comma { "comma" } else { "point" };
            let expected = format!("a finite number with a decimal {sign}");
            line.error(format!("{what} is {}", quoted(field)), expected)
        })?;
    }
    let [x, y, z, a, b, c] = values;
    Ok(Some(ListedPose {
        image: image.to_owned(),
        source: line.place(),
        center: Point3::new(x, y, z),
        angles: [a, b, c],
    }))
}

/// Does a line hold nothing but the image and six numbers, so that no heading is needed?
fn has_no_more(line: &TextLine, form: &Form) -> bool {
    let by_form = || cells(line.text, form.separator).len() == 7 + usize::from(form.is_numbered);
    form.separator == Separator::Blank || form.columns.is_some() || by_form()
}

/// The image and the six numbers where the heading says.
fn by_columns<'a>(
    line: &TextLine<'a>,
    cells: &[&'a str],
    form: &Form,
    columns: &Columns,
) -> Result<(&'a str, [&'a str; 6])> {
    let wrong = || {
        let expected = format!("{} fields as the heading names them", columns.count);
        line.miscounted(cells.len(), expected)
    };
    let begin = usize::from(form.is_numbered);
    if form.is_numbered && !cells.first().is_some_and(|c| is_whole(c)) {
        return Err(wrong());
    }
    let places = [columns.center, columns.angles].concat();
    let last = places.iter().max().max(Some(&columns.name));
    // Blanks in a name make more fields of it.
    let more = match form.separator {
        Separator::Blank => (cells.len().checked_sub(columns.count + begin)).ok_or_else(wrong)?,
        _ => 0,
    };
    if last.is_none_or(|last| last + more + begin >= cells.len()) {
        return Err(wrong());
    }
    let name = columns.name + begin;
    if form.is_numbered && is_number(cells[name]) {
        return Err(wrong());
    }
    let image = span(line.text, cells[name], cells[name + more]);
    let at = |i: usize| cells[i + begin + if i > columns.name { more } else { 0 }];
    Ok((image, std::array::from_fn(|i| at(places[i]))))
}

/// The image and the six numbers behind it.
fn by_order<'a>(
    line: &TextLine<'a>,
    cells: &[&'a str],
    form: &Form,
) -> Result<(&'a str, [&'a str; 6])> {
    let wrong = || line.miscounted(cells.len(), EXPECTED);
    let is_number = |c: &&str| number(c, form.decimal_comma).is_some();
    let begin = usize::from(form.is_numbered);
    let end = match form.separator {
        Separator::Blank => end_of_name(line, cells, begin, &is_number)?,
        _ => begin,
    };
    let Some(numbers) = cells.get(end + 1..end + 7) else {
        return Err(wrong());
    };
    if form.is_numbered && (!is_whole(cells[0]) || is_number(&cells[end])) {
        return Err(wrong());
    }
    let image = span(line.text, cells[begin], cells[end]);
    Ok((image, std::array::from_fn(|i| numbers[i])))
}

/// The last field of a name that may hold blanks, between blanks.
fn end_of_name(
    line: &TextLine,
    cells: &[&str],
    begin: usize,
    is_number: &dyn Fn(&&str) -> bool,
) -> Result<usize> {
    let by_extension = cells.iter().skip(begin).position(|c| is_image_name(c));
    if let Some(i) = by_extension {
        return Ok(begin + i);
    }
    if cells.len() == 7 + begin {
        return Ok(begin);
    }
    let last_word = cells.iter().rposition(|c| !is_number(c));
    let Some(end) = last_word.filter(|&i| i >= begin) else {
        return Err(line.miscounted(cells.len(), EXPECTED));
    };
    // Six numbers, or nine more of the rotation matrix. Else a number may belong to the name.
    match cells.len() - end - 1 {
        6 | 15 => Ok(end),
        n if n < 6 => Err(line.miscounted(cells.len(), EXPECTED)),
        n => Err(line.error(
            format!("{n} numbers stand behind the name, which may end with a number of its own"),
            format!("{EXPECTED}, the image with its extension, in quotation marks or before a tab"),
        )),
    }
}

/// Decimal commas between commas: every number falls into two.
fn refuse_split_decimals(line: &TextLine, form: &Form) -> Result<()> {
    if form.separator != Separator::Comma || form.decimal_comma || form.columns.is_some() {
        return Ok(());
    }
    let cells = cells(line.text, form.separator);
    let is_part = |c: &&str| is_whole(c.trim_start_matches('-'));
    if cells.len() >= 13 && cells[1..].iter().all(is_part) {
        return Err(line.error(
            format!("{} whole numbers between commas", cells.len() - 1),
            format!("{EXPECTED} with decimal points, or semicolons between the fields"),
        ));
    }
    Ok(())
}

/// The text from one field to another.
fn span<'a>(text: &'a str, first: &'a str, last: &'a str) -> &'a str {
    let begin = first.as_ptr() as usize - text.as_ptr() as usize;
    let end = last.as_ptr() as usize - text.as_ptr() as usize + last.len();
    text.get(begin..end).unwrap_or(first)
}

/// The number that a field holds.
fn number(field: &str, decimal_comma: bool) -> Option<f64> {
    // Word processors turn a hyphen into a minus.
    let plain = field.replace('\u{2212}', "-");
    let plain = match (decimal_comma, plain.split_once(',')) {
        (false, None) => plain,
        (false, Some(_)) => without_groups(&plain, ',', '.')?,
        (true, None) if plain.contains('.') => return None,
        (true, None) => plain,
        (true, Some(_)) => without_groups(&plain, '.', ',')?.replace(',', "."),
    };
    plain.parse().ok().or_else(|| {
        // Fortran writes exponents of double precision with a D.
        let is_fortran = plain.starts_with(|c: char| "+-.0123456789".contains(c));
        is_fortran.then(|| plain.replace(['D', 'd'], "e").parse().ok())?
    })
}

/// A number without the signs between groups of three digits, where it has a decimal sign.
fn without_groups(text: &str, group: char, decimal: char) -> Option<String> {
    let (whole, fraction) = text.split_once(decimal)?;
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let unsigned = whole.trim_start_matches(['-', '+']);
    let groups: Vec<&str> = unsigned.split(group).collect();
    let is_grouped = groups.len() == 1
        || groups.iter().all(|g| digits(g))
            && groups[1..].iter().all(|g| g.len() == 3)
            && groups[0].len() <= 3;
    (is_grouped && !fraction.contains([group, decimal]))
        .then(|| format!("{}{decimal}{fraction}", whole.replace(group, "")))
}

fn is_image_name(field: &str) -> bool {
    let extension = field.rsplit_once('.').map_or("", |(_, e)| e);
    let known = ["jpg", "jpeg", "png", "tif", "tiff", "dng", "bmp", "jp2"];
    known.iter().any(|e| extension.eq_ignore_ascii_case(e))
}

/// Is there no number in a line, so that it may be a heading?
fn is_words(text: &str) -> bool {
    let fields = || text.split([' ', '\t', ',', ';']).filter(|f| !f.is_empty());
    fields().all(|f| !is_number(f) && !f.starts_with(|c: char| c.is_ascii_digit()))
}
