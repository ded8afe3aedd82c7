//! Commands of the program.

mod args;

use apex_sim::{in_order, say};
use args::{Args, Seeds};
use follow::{
    field::{Ending, Options},
    runs::{Accuracy, HEAD, Row, Run, accuracy, picture, summary},
};
use lexopt::Parser;
use std::{env, ffi::OsString, fs, path::Path, process::ExitCode};

const HELP: &str = "\
A skid-steered robot follows a runner outdoors, in simulation: over hills, between trees, rocks, ditches and people.

Usage: follow [follow] [--seed N] [--metres N] [--no-people] [--out FILE]
       follow missions [--first-seed N] [--seeds N] [--jobs N] [--metres N] [--no-people] [--out FILE]
       follow perception [--first-seed N] [--seeds N] [--jobs N]

`follow` runs the robot on the track of one seed and tells what became of it, and which nodes were active. It draws the
track into out/follow/track.svg: the runner in orange, the robot in blue, contacts as red circles, places where the
robot lost the runner as violet ones.

  --seed N          seed of the country, the runner, the passers-by and all noise (default 1)
  --metres N        length of the track (default 1700)
  --no-people       without people who cross the track and stand beside it
  --out FILE        the picture (default out/follow/track.svg)

`missions` does so for many seeds, with a line for each, and draws the first run.

  --first-seed N    first seed (default 1)
  --seeds N         number of seeds (default 1)
  --jobs N          number of threads (default: as many as there are cores)

What the columns are, by the true state of the simulation:
  ran, driven       distances of the runner and of the robot
  lost, longest     spells of more than 1 s in which the robot did not know to within 1.5 m where the runner is, after it
                    had known it, and the longest of all spells
  contacts, people  contacts with anything while the robot drove, and those of them with people
  tips, falls       the robot tipped over, or a wheel was in a ditch: the run then ends
  distance kept     from the runner
  slow              share of the time of following in which the robot followed slowly
  took              computing time of the simulation and the robot on one core

`perception` measures how many points are taken for ground and for obstacles, on 60 turns of the scanner on the track of
each seed, and the computing time of perception for a turn of 28,800 points.

Exit codes: 0 fine, 1 the robot lost the runner for longer than 5 s, touched something, tipped or fell, or a node
failed; for `perception`, a rate below 95 %; 2 nothing could be done.
";

/// Runs the command that the arguments of the program name.
pub fn run() -> Result<ExitCode, String> {
    let mut args = env::args_os().skip(1).peekable();
    let is_name = |arg: &OsString| !arg.as_encoded_bytes().starts_with(b"-");
    let name = args.next_if(is_name);
    let rest: Vec<OsString> = args.collect();
    if rest.iter().any(|arg| arg == "--help" || arg == "-h") {
        return say(HELP).map(|()| ExitCode::SUCCESS);
    }
    let parser = Parser::from_args(rest);
    match name.as_ref().map(|name| name.to_string_lossy()).as_deref() {
        None | Some("follow") => follow_one(&Args::read(parser, &["seed", "metres", "no-people", "out"])?),
        Some("missions") => {
            missions(&Args::read(parser, &["first-seed", "seeds", "jobs", "metres", "no-people", "out"])?)
        }
        Some("perception") => perception(&Args::read(parser, &["first-seed", "seeds", "jobs"])?.seeds),
        Some(other) => {
            Err(format!("`{other}` is not a command; there are `follow`, `missions`, `perception`, and `--help`"))
        }
    }
}

fn follow_one(args: &Args) -> Result<ExitCode, String> {
    let run = follow::runs::run(&options(args, args.seed))?;
    say(&format!("{HEAD}\n{}\n\nActive nodes:\n", Row(&run)))?;
    let mut activity = run.activity.clone();
    activity.sort_by_key(|(_, time)| std::cmp::Reverse(*time));
    for (name, time) in activity {
        say(&format!("{name:<40}{:>8.1} s\n", time.as_secs_f32()))?;
    }
    for loss in &run.report.losses {
        say(&format!("lost at {} for {:.2} s\n", loss.from, loss.lasted))?;
    }
    for contact in &run.report.contacts {
        let what = if contact.is_person { "a person" } else { "a thing" };
        say(&format!("touched {what} at {} with {:.2} m/s\n", contact.at, contact.speed))?;
    }
    draw(&run, &args.out)?;
    Ok(verdict(&[run]))
}

fn missions(args: &Args) -> Result<ExitCode, String> {
    say(&format!("{HEAD}\n"))?;
    let jobs: Vec<Options> = args.seeds.all().into_iter().map(|seed| options(args, seed)).collect();
    let mut said = Ok(());
    let show = |run: &Result<Run, String>| {
        if let (Ok(run), Ok(())) = (run, &said) {
            said = say(&format!("{}\n", Row(run)));
        }
    };
    let runs = in_order(&jobs, args.seeds.jobs, follow::runs::run, show).map_err(|e| e.to_string())?;
    said?;
    let runs = runs.into_iter().collect::<Result<Vec<Run>, String>>()?;
    say(&format!("\n{}", summary(&runs)))?;
    draw(&runs[0], &args.out)?;
    Ok(verdict(&runs))
}

fn perception(seeds: &Seeds) -> Result<ExitCode, String> {
    say("        precision and recall of ground, of obstacles          time of a turn\n")?;
    say("  seed    ground                 obstacles                  median     most\n")?;
    let mut said = Ok(());
    let show = |accuracy: &Accuracy| {
        if said.is_ok() {
            said = say(&format!("{accuracy}\n"));
        }
    };
    let all = in_order(&seeds.all(), seeds.jobs, |seed| accuracy(*seed), show).map_err(|e| e.to_string())?;
    said?;
    let mut sum = Accuracy::default();
    all.iter().for_each(|one| sum.add(one));
    say(&format!("\n{}", sum.table()))?;
    let is_fine = all.iter().all(|one| one.rates().iter().all(|rate| *rate >= 0.95));
    Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

fn options(args: &Args, seed: u64) -> Options {
    Options { seed, length: args.metres as f32, people: args.people }
}

fn draw(run: &Run, out: &Path) -> Result<(), String> {
    let cannot = |e: std::io::Error| format!("cannot write {}: {e}", out.display());
    if let Some(folder) = out.parent() {
        fs::create_dir_all(folder).map_err(cannot)?;
    }
    fs::write(out, picture(run)).map_err(cannot)?;
    say(&format!("picture: {}\n", out.display()))
}

/// Exit code: 0 if each run met the goals.
fn verdict(runs: &[Run]) -> ExitCode {
    let is_fine = |run: &Run| {
        let report = &run.report;
        let ends_well = report.ending == Some(Ending::Arrived);
        ends_well && report.contacts.is_empty() && report.longest_loss() <= 5.0 && run.failures.is_empty()
    };
    if runs.iter().all(is_fine) { ExitCode::SUCCESS } else { ExitCode::from(1) }
}
