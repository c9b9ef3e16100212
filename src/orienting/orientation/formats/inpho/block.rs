//! The blocks of INPHO's project file, with the values of their keys.

use std::collections::BTreeMap;

use super::super::text::{TextLine, data_lines, quoted};
use crate::base::error::Result;

/// `$PHOTO` or `$CAMERA`, with the values of its keys: the rest of the line and those below.
#[derive(Clone)]
pub(crate) struct ProjectBlock<'a> {
    pub is_camera: bool,
    pub start: TextLine<'a>,
    pub values: Values<'a>,
    /// Those of each `$CALIBRATION_SET` of a camera.
    pub calibrations: Vec<Values<'a>>,
}

/// Keys with the rest of their line and those below.
type Values<'a> = BTreeMap<&'a str, Vec<TextLine<'a>>>;

/// The blocks of a project, in the order of the file.
pub(crate) fn project_blocks<'a>(path: &'a str, text: &'a str) -> Vec<ProjectBlock<'a>> {
    let mut blocks: Vec<ProjectBlock> = Vec::new();
    let (mut inside, mut in_set, mut key) = (false, false, None);
    for line in data_lines(path, text) {
        let Some(named) = line.text.strip_prefix('$') else {
            if let (true, Some(key), Some(block)) = (inside, key, blocks.last_mut()) {
                let values = block.place(in_set);
                values.entry(key).or_default().push(line);
            }
            continue;
        };
        let (name, value) = named.split_once(':').unwrap_or((named, ""));
        let name = name.split_whitespace().next().unwrap_or_default();
        key = None;
        match name {
            "PHOTO" | "CAMERA" | "CAMERA_DEFINITION" => {
                (inside, in_set) = (true, false);
                blocks.push(ProjectBlock {
                    is_camera: name != "PHOTO",
                    start: line,
                    values: BTreeMap::new(),
                    calibrations: Vec::new(),
                });
            }
            "CALIBRATION_SET" => {
                if let Some(block) = blocks.last_mut().filter(|_| inside) {
                    block.calibrations.push(BTreeMap::new());
                    in_set = true;
                }
            }
            "END" => in_set = false,
            "PROJECT" | "CONTROL_POINTS" | "STRIP" | "STATION" | "MULTIHEADSYSTEM" => {
                inside = false
            }
            _ => {
                let Some(block) = blocks.last_mut().filter(|_| inside) else {
                    continue;
                };
                // Other nested blocks repeat keys: the first one counts.
                let values = block.place(in_set);
                if !values.contains_key(name) {
                    let text = value.trim();
                    values.insert(name, vec![TextLine { text, ..line }]);
                    key = Some(name);
                }
            }
        }
    }
    blocks
}

impl<'a> ProjectBlock<'a> {
    /// Where the next key belongs.
    fn place(&mut self, in_set: bool) -> &mut Values<'a> {
        match self.calibrations.last_mut() {
            Some(set) if in_set => set,
            _ => &mut self.values,
        }
    }

    /// The camera with the values of its active calibration.
    pub(super) fn calibrated(&self) -> Result<Self> {
        let active = self.word("ACTIVE_CALIBRATION");
        let set = match (&self.calibrations[..], active) {
            ([], _) => return Ok(self.clone()),
            ([one], active) if active.is_none() || id_of(one).is_none() => one,
            (sets, active) => {
                let named = sets
                    .iter()
                    .find(|set| id_of(set) == active && active.is_some());
                named.ok_or_else(|| {
                    let ids: Vec<&str> = sets.iter().filter_map(id_of).collect();
                    self.start.error(
                        format!(
                            "its $ACTIVE_CALIBRATION is {}, but its $CALIBRATION_SETs are {}",
                            active.map_or("missing".to_owned(), quoted),
                            quoted(&ids.join(", "))
                        ),
                        "the $ID of one of its calibrations",
                    )
                })?
            }
        };
        let mut camera = self.clone();
        // The camera's own $ID is the one that photos name.
        let of_set = set.iter().filter(|(key, _)| **key != "ID");
        camera
            .values
            .extend(of_set.map(|(key, lines)| (*key, lines.clone())));
        Ok(camera)
    }
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

fn id_of<'a>(set: &Values<'a>) -> Option<&'a str> {
    Some(set.get("ID")?.first()?.text)
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
