//! The table of the stages as the page reads it: a file of TypeScript that is checked in and kept
//! current.

use std::fmt::Debug;

use super::Stage;
use crate::base::params::Method;

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/www/src/shared/stages.ts");

fn page_table() -> String {
    let method_names: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
    let without: Vec<&str> = Stage::WITHOUT_VIEWS.iter().map(|s| s.name()).collect();
    let rows: Vec<String> = Stage::ALL.iter().map(|stage| row(*stage)).collect();
    format!(
        "/** The stages and methods of the core. Written by `make golden` from src/pipeline/stages. */\n\n\
         export const METHODS = {method_names:?} as const;\n\
         export type Method = (typeof METHODS)[number];\n\n\
         /** In their order; each with the methods that have it, and the parameters that it reads. */\n\
         export const STAGES = [\n{}] as const;\n\
         export type StageName = (typeof STAGES)[number][\"name\"];\n\n\
         /** Those of a model that is there already. */\n\
         export const STAGES_WITHOUT_VIEWS: readonly StageName[] = {without:?};\n",
        rows.concat()
    )
}

fn row(stage: Stage) -> String {
    let row = stage.row();
    let has = |method: &Method| Stage::of(method.sources()).contains(&stage);
    let methods: Vec<&str> = (Method::ALL.into_iter().filter(has))
        .map(Method::name)
        .collect();
    let fields: [(&str, &dyn Debug); 5] = [
        ("name", &stage.name()),
        ("title", &stage.title()),
        ("section", &stage.section()),
        ("methods", &methods),
        ("reads", &row.reads),
    ];
    let lines = fields.map(|(name, value)| format!("    {name}: {value:?},\n"));
    format!("  {{\n{}  }},\n", lines.concat())
}

#[test]
fn the_page_has_the_table_of_the_stages() {
    if std::env::var_os("RIDGELINE_REWRITE").is_some() {
        std::fs::write(PATH, page_table()).unwrap();
    }
    let written = std::fs::read_to_string(PATH).unwrap_or_default();
    assert!(
        written == page_table(),
        "{PATH} is out of date: make golden"
    );
}
