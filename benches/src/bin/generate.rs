//! Writes what is generated: graphs into `graphs/`, and the longest program by hand.

use std::{fs, io, path::Path};

fn main() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, text) in text::files() {
        fs::write(folder.join(name), text)?;
    }
    Ok(())
}

// Not through the library, which cannot be built before the graphs are there.
#[path = "../text.rs"]
mod text;
