//! The summary that is printed after a run.

use std::fmt::Write;
use std::path::Path;

use ridgeline::pipeline::{Run, Stage, counted};

/// Counts and times per stage, warnings, files.
pub(super) fn summary(
    run: &Run,
    load_seconds: f64,
    seconds: &[(Stage, f64)],
    files: &[(String, Vec<u8>)],
    folder: &Path,
) -> String {
    let mut text = format!("{:<12}{:>9}\n", "stage", "seconds");
    let views = run.scene().views.len();
    add(&mut text, "load", load_seconds, &counted(views, "views"));
    for (summary, (stage, time)) in run.summaries().iter().zip(seconds) {
        let counts: Vec<_> = summary
            .counts
            .iter()
            .map(|&(name, count)| counted(count, name))
            .collect();
        add(&mut text, stage.name(), *time, &counts.join(", "));
    }
    let total = load_seconds + seconds.iter().map(|(_, s)| s).sum::<f64>();
    add(&mut text, "total", total, "");
    let stage_warnings = run.summaries().iter().flat_map(|s| &s.warnings);
    for warning in run.scene().warnings.iter().chain(stage_warnings) {
        line(&mut text, &format!("warning: {warning}"));
    }
    line(&mut text, &format!("written to {}:", folder.display()));
    for (name, bytes) in files {
        line(&mut text, &format!("  {name:<20}{:>12}", size(bytes.len())));
    }
    text
}

fn add(text: &mut String, name: &str, seconds: f64, found: &str) {
    line(
        text,
        format!("{name:<12}{seconds:>9.2}  {found}").trim_end(),
    );
}

fn line(text: &mut String, content: &str) {
    writeln!(text, "{content}").expect("a String takes all that is written");
}

fn size(bytes: usize) -> String {
    match bytes {
        0..10_000 => format!("{bytes} B"),
        10_000..10_000_000 => format!("{} kB", bytes / 1000),
        _ => format!("{} MB", bytes / 1_000_000),
    }
}
