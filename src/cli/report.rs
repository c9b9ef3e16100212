//! `ridgeline report`: a finished model in, its roof report out.

use std::fs;
use std::path::Path;

use ridgeline::results::export::ReportedModel;
use ridgeline::results::roof_report::SetbackRule;

use super::args::ReportArgs;
use super::failure::Failure;
use super::files;

/// The model in a folder of results.
const MODEL: &str = "model.city.json";

/// Reads the model, writes the report and names its files.
pub(super) fn report(args: &ReportArgs) -> Result<(), Failure> {
    let path = match args.model.is_dir() {
        true => args.model.join(MODEL),
        false => args.model.clone(),
    };
    let bytes = fs::read(&path).map_err(|e| {
        let advice = "give the folder of a reconstruction, or a CityJSON file";
        Failure::Input(format!("{}: cannot be read: {e}; {advice}", path.display()))
    })?;
    let setbacks = match &args.setbacks {
        Some(path) => {
            let failure =
                |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
            let text = fs::read_to_string(path);
            let text = text.map_err(|e| failure(format!("cannot be read: {e}")))?;
            SetbackRule::with(&text).map_err(failure)?
        }
        None => SetbackRule::built_in(),
    };
    let read = ReportedModel::read(&bytes);
    let read = read.map_err(|problem| Failure::Input(format!("{}: {problem}", path.display())))?;
    let written = read.files(&setbacks);
    let beside = path.parent().unwrap_or(Path::new("."));
    let out = args.out.as_deref().unwrap_or(beside);
    let failure = |e| Failure::Output(format!("{}: cannot be made: {e}", out.display()));
    if !out.as_os_str().is_empty() {
        fs::create_dir_all(out).map_err(failure)?;
    }
    files::write_all(out, &written)?;
    for (name, _) in &written {
        println!("{}", out.join(name).display());
    }
    Ok(())
}
