//! The blocks of INPHO's project file, with the values of their keys.

use std::collections::BTreeMap;

use super::super::text::{TextLine, data_lines};
use crate::error::Result;

/// `$PHOTO` or `$CAMERA`, with the values of its keys: the rest of the line and those below.
pub(crate) struct ProjectBlock<'a> {
    pub is_camera: bool,
    pub start: TextLine<'a>,
    pub values: BTreeMap<&'a str, Vec<TextLine<'a>>>,
}

/// The blocks of a project, in the order of the file.
pub(crate) fn project_blocks<'a>(path: &'a str, text: &'a str) -> Vec<ProjectBlock<'a>> {
    let mut blocks: Vec<ProjectBlock> = Vec::new();
    let (mut inside, mut key) = (false, None);
    for line in data_lines(path, text) {
        let Some(named) = line.text.strip_prefix('$') else {
            if let (true, Some(key), Some(block)) = (inside, key, blocks.last_mut()) {
                block.values.entry(key).or_default().push(line);
            }
            continue;
        };
        let (name, value) = named.split_once(':').unwrap_or((named, ""));
        let name = name.split_whitespace().next().unwrap_or_default();
        key = None;
        match name {
            "PHOTO" | "CAMERA" | "CAMERA_DEFINITION" => {
                inside = true;
                blocks.push(ProjectBlock {
                    is_camera: name != "PHOTO",
                    start: line,
                    values: BTreeMap::new(),
                });
            }
            "PROJECT" | "CONTROL_POINTS" | "STRIP" | "STATION" | "MULTIHEADSYSTEM" => {
                inside = false
            }
            _ => {
                let Some(block) = blocks.last_mut().filter(|_| inside) else {
                    continue;
                };
                // Nested blocks repeat keys ($ID): the first one counts.
                if !block.values.contains_key(name) {
                    let text = value.trim();
                    block.values.insert(name, vec![TextLine { text, ..line }]);
                    key = Some(name);
                }
            }
        }
    }
    blocks
}

impl ProjectBlock<'_> {
    /// The value beside a key.
    pub(super) fn word(&self, key: &str) -> Option<&str> {
        let text = self.values.get(key)?.first()?.text;
        (!text.is_empty()).then_some(text)
    }

    /// All numbers of a key and below it; none where it is missing.
    pub(super) fn all_numbers(&self, key: &str) -> Result<Vec<f64>> {
        let mut values = Vec::new();
        for line in self.values.get(key).map_or(&[][..], |lines| lines) {
            values.extend(line.numbers(&line.fields(), "a number")?);
        }
        Ok(values)
    }

    /// The numbers of a key.
    pub(super) fn numbers<const N: usize>(&self, key: &str) -> Result<[f64; N]> {
        let lines = self.values.get(key);
        let lines = lines.ok_or_else(|| {
            self.start
                .error(format!("${key} is missing"), format!("a line ${key} :"))
        })?;
        numbers(lines, key)
    }
}

/// Exactly so many numbers on lines that follow each other; the first line may hold a date.
pub(crate) fn numbers<const N: usize>(lines: &[TextLine], key: &str) -> Result<[f64; N]> {
    let mut values = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        // $EXT_ORI is followed by the time of its adjustment.
        if i == 0 && key == "EXT_ORI" {
            continue;
        }
        values.extend(line.numbers(&line.fields(), "a number")?);
    }
    let count = values.len();
    values.try_into().map_err(|_| {
        lines[0].error(
            format!("${key} has {count} numbers"),
            format!("{N} numbers"),
        )
    })
}
