//! Writes the generated graphs into `graphs/`.

use std::{fs, io, path::Path};

fn main() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs");
    for (name, text) in text::all() {
        fs::write(folder.join(name), text)?;
    }
    Ok(())
}

// Not through the library, which cannot be built before the graphs are there.
#[path = "../text.rs"]
mod text;
