//! A finished model in: its roof report, what differs from another one, or the same corrected.

use std::fs;
use std::path::{Path, PathBuf};

use ridgeline::base::params::{Params, corrections_from_json};
use ridgeline::pipeline::Run;
use ridgeline::results::export::ReportedModel;
use ridgeline::results::roof_report::SetbackRule;

use super::args::{CompareArgs, CorrectArgs, ReportArgs};
use super::failure::Failure;
use super::files;

/// The model in a folder of results.
const MODEL: &str = "model.city.json";

/// Why something that was read cannot be used.
fn refused(path: &Path) -> impl Fn(String) -> Failure {
    move |problem| Failure::Input(format!("{}: {problem}", path.display()))
}

/// The CityJSON file that a folder of results or a path names, and its bytes.
fn city_json(named: &Path) -> Result<(PathBuf, Vec<u8>), Failure> {
    let path = match named.is_dir() {
        true => named.join(MODEL),
        false => named.to_owned(),
    };
    let advice = "give the folder of a reconstruction, or a CityJSON file";
    let bytes =
        fs::read(&path).map_err(|e| refused(&path)(format!("cannot be read: {e}; {advice}")))?;
    Ok((path, bytes))
}

/// The model of a CityJSON file.
fn model_of(named: &Path) -> Result<(PathBuf, ReportedModel), Failure> {
    let (path, bytes) = city_json(named)?;
    let read = ReportedModel::read(&bytes).map_err(refused(&path))?;
    Ok((path, read))
}

/// Reads the model, writes the report and names its files.
pub(super) fn report(args: &ReportArgs) -> Result<(), Failure> {
    let (path, read) = model_of(&args.model)?;
    let setbacks = match &args.setbacks {
        Some(path) => {
            let text = fs::read_to_string(path);
            let text = text.map_err(|e| refused(path)(format!("cannot be read: {e}")))?;
            SetbackRule::with(&text).map_err(refused(path))?
        }
        None => SetbackRule::built_in(),
    };
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

/// Prints what two models have in common, and what differs.
pub(super) fn compare(args: &CompareArgs) -> Result<(), Failure> {
    let (_, first) = model_of(&args.first)?;
    let (path, second) = model_of(&args.second)?;
    let compared = first.compare(&second).map_err(refused(&path))?;
    match args.json {
        true => println!("{}", compared.to_json()),
        false => print!("{}", compared.to_text()),
    }
    Ok(())
}

/// Writes the corrected model in all formats, and names the corrections that are not applied.
pub(super) fn correct(args: &CorrectArgs) -> Result<(), Failure> {
    let (path, bytes) = city_json(&args.model)?;
    let text = fs::read_to_string(&args.corrections);
    let text = text.map_err(|e| refused(&args.corrections)(format!("cannot be read: {e}")))?;
    let params = Params {
        corrections: corrections_from_json(&text)
            .map_err(|problem| refused(&args.corrections)(problem.to_string()))?,
        ..Params::default()
    };
    let mut run = Run::of_model(bytes, params).map_err(refused(&path))?;
    run.run_all();
    for warning in run.summaries().iter().flat_map(|summary| &summary.warnings) {
        eprintln!("warning: {warning}");
    }
    fs::create_dir_all(&args.out)
        .map_err(|e| Failure::Output(format!("{}: cannot be made: {e}", args.out.display())))?;
    let written = run.files(&[]);
    files::write_all(&args.out, &written)?;
    for (name, _) in &written {
        println!("{}", args.out.join(name).display());
    }
    Ok(())
}
