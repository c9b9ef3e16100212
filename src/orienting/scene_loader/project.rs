//! Project files: a zip that holds everything of a run, and opens again to the same state.
//!
//! ```text
//! project.json      version, options and parameters
//! input/...         images and orientation files, at their own paths
//! results/...       what was written
//! ```
//!
//! Results are for users and other programs; opening reads the input, from which the same
//! parameters give the same bytes. What the page shows of a run is among them ([`SHOWN`]), so that
//! the same version shows it again without a run.

use std::io::{Cursor, Write};

use serde::{Deserialize, Serialize};
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, ZipWriter};

use super::input::LoadOptions;
use crate::base::error::{Error, Result};
use crate::base::params::Params;
use crate::orienting::orientation::{FileKind, InputFile, detect};

/// Name of the file by which an archive is a project.
const PROJECT_FILE: &str = "project.json";

/// Folders of a project.
const INPUT: &str = "input/";
const RESULTS: &str = "results/";

/// What the page shows of a run, in the page's own form.
pub(crate) const SHOWN: &str = "page.json";

/// Options and parameters of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Project {
    /// Version of the program that wrote it.
    pub ridgeline: String,
    /// Choice of views, orientation, region...
    pub options: LoadOptions,
    /// Parameters of the stages.
    pub params: Params,
    /// What the page showed when this version wrote it; empty where it showed nothing.
    #[serde(skip)]
    pub shown: Vec<u8>,
}

impl Project {
    /// A project of this version.
    pub fn new(options: LoadOptions, params: Params) -> Self {
        Self {
            ridgeline: env!("CARGO_PKG_VERSION").to_owned(),
            options,
            params,
            shown: Vec::new(),
        }
    }

    /// The project as a zip file: the same content gives the same bytes. Files that are not used
    /// are left out.
    pub fn pack(&self, files: &[InputFile], results: &[(String, Vec<u8>)]) -> Result<Vec<u8>> {
        let json =
            serde_json::to_vec_pretty(self).expect("options and parameters have string keys only");
        let is_used =
            |f: &&InputFile| !matches!(detect(f), FileKind::Ignored | FileKind::UnreadImage);
        let used = files.iter().filter(is_used);
        let inputs = used.map(|f| (format!("{INPUT}{}", f.path), &f.bytes[..]));
        let results = results
            .iter()
            .map(|(name, bytes)| (format!("{RESULTS}{name}"), &bytes[..]));
        let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
        for (path, bytes) in std::iter::once((PROJECT_FILE.to_owned(), &json[..]))
            .chain(inputs)
            .chain(results)
        {
            // Photographs do not get smaller.
            let method = match crate::photographs::raster::image_format(bytes) {
                Some(_) => CompressionMethod::Stored,
                None => CompressionMethod::Deflated,
            };
            let options = SimpleFileOptions::default()
                .compression_method(method)
                .large_file(bytes.len() as u64 > u64::from(u32::MAX));
            let written = zip
                .start_file(path, options)
                .and_then(|()| Ok(zip.write_all(bytes)?));
            written.map_err(|e| refuse(&format!("it cannot be packed: {e}")))?;
        }
        let done = zip
            .finish()
            .map_err(|e| refuse(&format!("it cannot be packed: {e}")))?;
        Ok(done.into_inner())
    }
}

/// If the files are those of a project, its input files at their own paths and the project; else
/// the files as they are.
pub fn open_project(files: Vec<InputFile>) -> Result<(Vec<InputFile>, Option<Project>)> {
    let is_project =
        |f: &&InputFile| f.name() == PROJECT_FILE && f.text().contains("\"ridgeline\"");
    let Some(file) = files.iter().find(is_project) else {
        return Ok((files, None));
    };
    let mut project: Project = crate::base::json::read(&file.text()).map_err(|e| Error::Line {
        file: file.path.clone(),
        line: e.line().unwrap_or(1),
        problem: e
            .to_string()
            .replace("; ", ", ")
            .chars()
            .take(200)
            .collect(),
        expected: "a project of this program".to_owned(),
    })?;
    let base = file
        .path
        .strip_suffix(PROJECT_FILE)
        .unwrap_or_default()
        .to_owned();
    let input = format!("{base}{INPUT}");
    let shown = format!("{base}{RESULTS}{SHOWN}");
    let is_ours = project.ridgeline == env!("CARGO_PKG_VERSION");
    let inputs: Vec<InputFile> = (files.into_iter())
        .filter_map(|f| {
            if is_ours && f.path == shown {
                project.shown = f.bytes;
                return None;
            }
            let path = f.path.strip_prefix(&input)?.to_owned();
            Some(f.renamed(&path))
        })
        .collect();
    Ok((inputs, Some(project)))
}

fn refuse(problem: &str) -> Error {
    Error::file("the project", problem, "write it without large files")
}

#[cfg(test)]
mod tests {
    use super::super::archive::unpack;
    use super::super::load_scene;
    use super::*;
    use crate::base::params::Correction;
    use crate::orienting::synthetic::{gable_scene, to_files};
    use nalgebra::Point3;

    fn project() -> (Project, Vec<InputFile>) {
        let files = to_files(&gable_scene(48).0);
        let mut files: Vec<InputFile> = files
            .iter()
            .map(|(path, bytes)| InputFile::new(path, bytes.clone()))
            .collect();
        files.push(InputFile::new(
            "notes.txt",
            b"nothing that is used".to_vec(),
        ));
        let mut params = Params::default();
        params.sweep.min_similarity = 0.47;
        params.corrections.push(Correction::SetGround {
            building: Point3::new(0.1, 0.2, 7.0 / 3.0),
            height: -0.3,
        });
        let options = LoadOptions {
            views: Some(vec!["s1_01".into(), "s1_02".into(), "s2_01".into()]),
            ..LoadOptions::default()
        };
        (Project::new(options, params), files)
    }

    #[test]
    fn a_project_opens_to_the_same_state() {
        let (project, files) = project();
        let results = [("model.obj".to_owned(), b"v 1 2 3".to_vec())];
        let packed = project.pack(&files, &results).unwrap();
        assert_eq!(packed, project.pack(&files, &results).unwrap());
        let unpacked = unpack(InputFile::new("somewhere/my.zip", packed)).unwrap();
        assert!(
            unpacked
                .iter()
                .any(|f| f.path == "somewhere/my/results/model.obj")
        );
        let (inputs, opened) = open_project(unpacked).unwrap();
        assert_eq!(opened.as_ref(), Some(&project));
        assert!(project.shown.is_empty());
        let used: Vec<_> = files
            .iter()
            .filter(|f| f.path != "notes.txt")
            .cloned()
            .collect();
        let mut sorted = used.clone();
        sorted.sort_by(|a, b| a.path.cmp(&b.path));
        assert_eq!(inputs, sorted);
        let (a, b) = (
            load_scene(&inputs, &project.options).unwrap(),
            load_scene(&files, &project.options).unwrap(),
        );
        assert_eq!(
            (a.views.len(), a.views[2].camera.clone()),
            (3, b.views[2].camera.clone())
        );
    }

    #[test]
    fn what_the_page_showed_is_there_again_in_the_same_version() {
        let (mut project, files) = project();
        let results = [(SHOWN.to_owned(), b"{}".to_vec())];
        let opened = |project: &Project| {
            let packed = project.pack(&files, &results).unwrap();
            let (inputs, opened) =
                open_project(unpack(InputFile::new("a.zip", packed)).unwrap()).unwrap();
            assert!(inputs.iter().all(|f| !f.path.contains(SHOWN)));
            opened.unwrap().shown
        };
        assert_eq!(opened(&project), b"{}");
        project.ridgeline = "0.0.1".to_owned();
        assert!(opened(&project).is_empty());
    }

    #[test]
    fn what_is_no_project_stays_and_a_damaged_one_is_refused() {
        let (_, files) = project();
        assert_eq!(open_project(files.clone()).unwrap(), (files, None));
        let damaged = InputFile::new(
            "a/project.json",
            br#"{"ridgeline": "1", "parms": {}}"#.to_vec(),
        );
        let message = open_project(vec![damaged]).unwrap_err().to_string();
        assert!(
            message.contains("a/project.json, line 1") && message.contains("parms"),
            "{message}"
        );
    }
}
