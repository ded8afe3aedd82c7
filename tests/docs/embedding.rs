//! The programs of `docs/embedding.md`.

mod driven;
mod ends;
mod first;
mod own_loop;
mod parameters;
#[allow(dead_code)]
mod parts;
mod ports;
mod remote;
mod watching;

/// Sources of the programs, in the order of the page.
pub const BLOCKS: [&str; 9] = [
    include_str!("embedding/first.rs"),
    include_str!("embedding/own_loop.rs"),
    include_str!("embedding/driven.rs"),
    include_str!("embedding/ends.rs"),
    include_str!("embedding/ports.rs"),
    include_str!("embedding/parts.rs"),
    include_str!("embedding/parameters.rs"),
    include_str!("embedding/remote.rs"),
    include_str!("embedding/watching.rs"),
];

/// Runs all programs.
pub fn main() {
    first::main();
    own_loop::main();
    driven::main();
    ends::main();
    ports::main();
    parts::main();
    parameters::main();
    remote::main();
    watching::main();
}
