//! Writes the generated files: graphs into `graphs/`, and the longest hand-written program.

use std::{fs, io, path::Path};

fn main() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, text) in text::files() {
        fs::write(folder.join(name), text)?;
    }
    Ok(())
}

// Included as a file, because the library cannot be built before the graphs exist.
#[path = "../text.rs"]
mod text;
