//! The fields of a line, and what looks like a number.

/// What separates the fields of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Tab,
    Semicolon,
    Comma,
    Blank,
}

/// The fields of a line; what stands in quotation marks is one field.
pub(super) fn cells(text: &str, separator: Separator) -> Vec<&str> {
    let is_separator = |c: char| match separator {
        Separator::Tab => c == '\t',
        Separator::Semicolon => c == ';',
        Separator::Comma => c == ',',
        Separator::Blank => c.is_whitespace(),
    };
    let trimmed = |text| str::trim_matches(text, |c: char| c.is_whitespace() && !is_separator(c));
    let mut found = Vec::new();
    let mut rest = text.trim();
    loop {
        rest = trimmed(rest);
        if separator == Separator::Blank {
            rest = rest.trim_start();
            if rest.is_empty() {
                break;
            }
        }
        let (cell, after) = match in_quotes(rest, &is_separator) {
            Some(parts) => parts,
            None => rest.split_at(rest.find(is_separator).unwrap_or(rest.len())),
        };
        found.push(cell.trim());
        let mut after = trimmed(after).chars();
        if after.next().is_none() {
            break;
        }
        rest = after.as_str();
    }
    found
}

pub(super) fn is_whole(field: &str) -> bool {
    !field.is_empty() && field.bytes().all(|b| b.is_ascii_digit())
}

/// What stands in quotation marks at the beginning, and what follows them.
fn in_quotes<'a>(text: &'a str, is_separator: &dyn Fn(char) -> bool) -> Option<(&'a str, &'a str)> {
    let mark = text.chars().next().filter(|c| ['"', '\''].contains(c))?;
    let (inside, after) = text[1..].split_once(mark)?;
    let next = after.trim_start_matches(|c: char| c == ' ' && !is_separator(c));
    let ends = next.chars().next().is_none_or(is_separator);
    ends.then_some((inside, after))
}
