//! The language server as seen from an editor.

mod client;
mod completing;
mod edits;
mod fixing;
mod half_written;
mod navigating;
mod package;
mod renaming;
mod showing;
mod speed;
mod talking;
