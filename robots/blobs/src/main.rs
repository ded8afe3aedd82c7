//! Makes the recording `belt.mcap`, with the argument `film`; or finds the parts in it, again and again.

use apex_rt::prelude::*;
use blobs::{Prototype, film};
use std::{env, io, path::Path};

fn main() -> io::Result<()> {
    if env::args().any(|argument| argument == "film") {
        return film(Path::new("belt.mcap"), 10.0);
    }
    run(Prototype::new(), WallClock::new());
    Ok(())
}
