//! The language server, seen from an editor.

mod client;
mod completing;
mod half_written;
mod navigating;
mod renaming;
mod showing;
mod speed;
mod talking;
