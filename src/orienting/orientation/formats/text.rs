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

    /// Its file and number, for messages.
    pub(crate) fn place(&self) -> String {
        format!("{}, line {}", self.file, self.number)
    }

    /// The text up to the end of one of its fields: a name may hold blanks.
    pub(crate) fn up_to(&self, field: &str) -> &'a str {
        let end = field.as_ptr() as usize - self.text.as_ptr() as usize + field.len();
        self.text.get(..end).unwrap_or(self.text)
    }

    /// An error about the number of fields.
    pub(crate) fn miscounted(&self, fields: usize, expected: impl Into<String>) -> Error {
        self.error(format!("{fields} fields"), expected)
    }

    pub(crate) fn error(&self, problem: impl Into<String>, expected: impl Into<String>) -> Error {
        Error::line(self.file, self.number, problem, expected)
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

    /// As many finite numbers as are wanted, one a field.
    pub(crate) fn exactly<const N: usize>(
        &self,
        fields: &[&str],
        expected: impl Into<String>,
    ) -> Result<[f64; N]> {
        let numbers = self.numbers(fields, "a number")?;
        let wrong = |numbers: Vec<f64>| self.miscounted(numbers.len(), expected);
        numbers.try_into().map_err(wrong)
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
    raw_lines(file, text).map(|line| TextLine {
        text: line.text.trim_start(),
        ..line
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

/// Is a field a number with a decimal point?
pub(super) fn is_number(field: &str) -> bool {
    field.parse::<f64>().is_ok()
}

/// The refusal of a file whose end is missing.
pub(super) fn ends_early(file: &str, problem: &str) -> Error {
    Error::file(file, problem, "copy the whole file: its end is missing")
}

/// A longer text from elsewhere in one line, shortened.
pub(crate) fn quoted_long(text: &str) -> String {
    // Assumption: some three lines of a message.
    const MOST_CHARACTERS: usize = 200;
    // A semicolon would end the problem and begin the advice.
    shortened(text, MOST_CHARACTERS)
        .replace(['\n', '\r'], " ")
        .replace("; ", ", ")
}

/// A field in quotation marks, shortened: files may hold anything.
pub(crate) fn quoted(field: &str) -> String {
    format!("\"{}\"", shortened(field, 40))
}

fn shortened(text: &str, most_characters: usize) -> String {
    let short: String = text.chars().take(most_characters).collect();
    let dots = if short.len() < text.len() { "..." } else { "" };
    format!("{short}{dots}")
}
