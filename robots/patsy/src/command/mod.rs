//! Commands of the program.

mod accuracy;
mod approach;
mod help;
mod missions;
mod obstacles;
mod options;
mod simulate;
mod times;
mod validate;

use apex_sim::experiment::Command;
use help::HELP;

pub const COMMANDS: [Command; 7] = [
    Command { name: "", help: HELP, run: simulate::simulate_or_replay },
    Command { name: "obstacles", help: obstacles::HELP, run: obstacles::obstacles },
    Command { name: "accuracy", help: HELP, run: accuracy::accuracy },
    Command { name: "approach", help: HELP, run: approach::approach },
    Command { name: "missions", help: HELP, run: missions::missions },
    Command { name: "times", help: HELP, run: times::times },
    Command { name: "validate", help: HELP, run: validate::validate },
];
