//! Commands of the program.

mod bench;
mod compete;
mod help;
mod perception;
mod setup;

use apex_sim::experiment::Command;
use help::HELP;

pub const COMMANDS: [Command; 3] = [
    Command { name: "compete", help: HELP, run: compete::compete },
    Command { name: "bench", help: HELP, run: bench::bench },
    Command { name: "perception", help: HELP, run: perception::perception },
];
