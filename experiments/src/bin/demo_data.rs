//! Writes the data that `trimtab demo` embeds into the library's `src/study/demo`.
//! A test compares the committed files with its output; it changes no other file.

use std::path::Path;

use clap::Parser;

/// Writes the data that `trimtab demo` embeds into src/study/demo.
#[derive(Parser)]
struct Arguments {}

fn main() -> std::io::Result<()> {
    Arguments::parse();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/study/demo");
    std::fs::create_dir_all(folder.join("trials"))?;
    let concealed = trimtab_experiments::demo_concealed::files().into_iter().flatten();
    for (name, text) in trimtab_experiments::demo::files().into_iter().chain(concealed) {
        std::fs::write(folder.join(name), &text)?;
        println!("{name}: {} bytes", text.len());
    }
    Ok(())
}
