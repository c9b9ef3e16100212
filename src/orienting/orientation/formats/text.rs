//! Lines of a text file with their position, so that every error can name it.

use crate::base::error::{Error, Result};

/// A line with its position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextLine<'a> {
    pub file: &'a str,
    /// From 1.
    pub number: usize,
    /// Without surrounding blanks.
    pub text: &'a str,
}

impl<'a> TextLine<'a> {
    /// Blank-separated fields.
    pub(crate) fn fields(&self) -> Vec<&'a str> {
        self.text.split_whitespace().collect()
    }

    /// Is there nothing but a comment or blanks?
    pub(crate) fn is_empty(&self) -> bool {
        self.text.is_empty() || self.text.starts_with('#')
    }

    pub(crate) fn error(&self, problem: impl Into<String>, expected: impl Into<String>) -> Error {
        Error::Line {
            file: self.file.to_owned(),
            line: self.number,
            problem: problem.into(),
            expected: expected.into(),
        }
    }

    /// A finite number.
    pub(crate) fn number(&self, field: &str, what: &str) -> Result<f64> {
        match field.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.error(
                format!("{what} is {}", quoted(field)),
                "a finite number with a decimal point",
            )),
        }
    }

    /// Finite numbers, one a field.
    pub(crate) fn numbers(&self, fields: &[&str], what: &str) -> Result<Vec<f64>> {
        fields.iter().map(|f| self.number(f, what)).collect()
    }

    /// A whole number that fits 32 bits.
    pub(crate) fn whole(&self, field: &str, what: &str) -> Result<u32> {
        field.parse().map_err(|_| {
            self.error(
                format!("{what} is {}", quoted(field)),
                "a whole number that is not negative",
            )
        })
    }
}

/// All lines of a file, empty ones and comments included.
pub(crate) fn lines<'a>(file: &'a str, text: &'a str) -> impl Iterator<Item = TextLine<'a>> {
    text.trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(move |(i, line)| TextLine {
            file,
            number: i + 1,
            text: line.trim(),
        })
}

/// Lines as they are, for files whose columns count.
pub(crate) fn raw_lines<'a>(file: &'a str, text: &'a str) -> impl Iterator<Item = TextLine<'a>> {
    text.trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(move |(i, line)| TextLine {
            file,
            number: i + 1,
            text: line.trim_end(),
        })
}

/// Lines that hold data: neither empty nor a comment.
pub(crate) fn data_lines<'a>(file: &'a str, text: &'a str) -> impl Iterator<Item = TextLine<'a>> {
    lines(file, text).filter(|line| !line.is_empty())
}

/// A longer text from elsewhere in one line, shortened.
pub(crate) fn quoted_long(text: &str) -> String {
    // Assumption: some three lines of a message.
    const MOST_CHARACTERS: usize = 200;
    let short: String = text.chars().take(MOST_CHARACTERS).collect();
    let dots = if short.len() < text.len() { "..." } else { "" };
    // A semicolon would end the problem and begin the advice.
    format!("{short}{dots}")
        .replace(['\n', '\r'], " ")
        .replace("; ", ", ")
}

/// A field in quotation marks, shortened: files may hold anything.
pub(crate) fn quoted(field: &str) -> String {
    let short: String = field.chars().take(40).collect();
    let dots = if short.len() < field.len() { "..." } else { "" };
    format!("\"{short}{dots}\"")
}
