//! The part of wasm-bindgen's command line that the page needs: the whole one brings an HTTP server and client for tests in
//! browsers, which take longer to compile than all else.
//!
//! ```text
//! wasm-bindgen FILE.wasm FOLDER NAME     writes FOLDER/NAME.js, NAME.d.ts and NAME_bg.wasm, for `<script type="module">`
//! wasm-bindgen --version                 as wasm-pack asks, before it takes the test runner beside this program
//! ```

use std::env::args;

use anyhow::{Result, bail};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let arguments: Vec<String> = args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["--version"] => println!("wasm-bindgen {}", wasm_bindgen_shared::version()),
        [file, folder, name] => Bindgen::new()
            .input_path(file)
            .web(true)?
            .typescript(true)
            .out_name(name)
            // They say nothing to a browser.
            .remove_name_section(true)
            .remove_producers_section(true)
            .generate(folder)?,
        _ => bail!("usage: wasm-bindgen FILE.wasm FOLDER NAME"),
    }
    Ok(())
}
