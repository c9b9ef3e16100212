//! Runs the tests of one wasm file in Node; wasm-pack calls it.

use std::env::args_os;

use anyhow::Result;
use wasm_bindgen_cli::wasm_bindgen_test_runner::run_cli_with_args;

fn main() -> Result<()> {
    run_cli_with_args(args_os())
}
