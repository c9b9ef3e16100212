//! buildings::model_lines

mod contradicted;
mod duplicates;
mod new_lines;
mod surfaces;

pub use contradicted::judge_lines;
