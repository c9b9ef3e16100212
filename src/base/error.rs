//! Why an input is refused: which file, which line, what was expected, what to do.

use crate::base::agreement::AgreementReport;

/// A refusal. Every message names the file and says what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A line of a text file does not follow the format.
    #[error("{}, line {line}: {}; expected {expected}", one_line(.file), one_line(.problem))]
    Line {
        /// File name.
        file: String,
        /// Line number, from 1.
        line: usize,
        /// What the line says.
        problem: String,
        /// What it should say.
        expected: String,
    },
    /// A file as a whole cannot be used.
    #[error("{}: {}; {}", one_line(.file), one_line(.problem), one_line(.advice))]
    File {
        /// File name.
        file: String,
        /// What is wrong.
        problem: String,
        /// What to do.
        advice: String,
    },
    /// The files do not make a scene.
    #[error("{}; {}", one_line(.problem), one_line(.advice))]
    Scene {
        /// What is wrong.
        problem: String,
        /// What to do.
        advice: String,
    },
    /// The images contradict their orientation.
    #[error("{}; {}", one_line(.problem), one_line(.advice))]
    Contradiction {
        /// What is wrong.
        problem: String,
        /// What to do.
        advice: String,
        /// The report of the orientation check.
        report: Box<AgreementReport>,
    },
}

impl Error {
    /// A line of a text file does not follow the format; its number is from 1.
    pub fn line(
        file: impl Into<String>,
        line: usize,
        problem: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        Self::Line {
            file: file.into(),
            line,
            problem: problem.into(),
            expected: expected.into(),
        }
    }

    /// A file as a whole cannot be used.
    pub fn file(
        file: impl Into<String>,
        problem: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self::File {
            file: file.into(),
            problem: problem.into(),
            advice: advice.into(),
        }
    }

    /// The files do not make a scene.
    pub fn scene(problem: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::Scene {
            problem: problem.into(),
            advice: advice.into(),
        }
    }

    /// The kind of refusal, for programs.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Line { .. } => "line",
            Self::File { .. } => "file",
            Self::Scene { .. } => "scene",
            Self::Contradiction { .. } => "contradiction",
        }
    }
}

/// Names and contents of files may hold anything: control characters become blanks, long texts are
/// shortened.
fn one_line(text: &str) -> String {
    // Assumption: some ten lines of a terminal.
    const MOST_CHARACTERS: usize = 600;
    let mut line: String = (text.chars().take(MOST_CHARACTERS))
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if line.len() < text.len() {
        line.push_str("...");
    }
    line
}

/// Names in a row; long lists are cut short.
pub(crate) fn listed(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let names: Vec<String> = names.into_iter().map(|n| n.as_ref().to_owned()).collect();
    cut_short(&names)
}

fn cut_short(names: &[String]) -> String {
    // Assumption: whoever reads eight knows what kind they are.
    const MOST_NAMES: usize = 8;
    let mut text = names[..names.len().min(MOST_NAMES)].join(", ");
    if names.len() > MOST_NAMES {
        text.push_str(&format!(" and {} more", names.len() - MOST_NAMES));
    }
    text
}

/// Result of reading.
pub type Result<T> = std::result::Result<T, Error>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut() {
        assert_eq!(listed(["a", "b"].iter()), "a, b");
        assert!(listed((0..20).map(|i| i.to_string())).ends_with("7 and 12 more"));
    }
}
