use super::{Bench, Command, Seeds};
use lexopt::{
    Arg, Parser,
    prelude::{Long, Short},
};
use sick_robot_day::run::{Mission, Recording, Setup};
use std::{ffi::OsString, num::NonZero, path::PathBuf, str::FromStr, time::Duration};

pub const HELP: &str = "\
The robot of the SICK Robot Day 2014, in simulation: it fetches cubes and takes them to the stations that they name.

Usage: sick-robot-day [compete] [--seed N] [--mission afg|sdf] [--minutes M] [--fault KIND@FROM..UNTIL]...
                      [--keeps-twist] [--out FOLDER] [--film FILE] [--record FILE [--record-images]]
       sick-robot-day bench [--first-seed N] [--seeds N] [--jobs N] [--mission afg|sdf] [--minutes M]
                      [--keeps-twist] [--faults] [--outages] [--times]
       sick-robot-day perception [--seeds N] [--out FOLDER]

`compete`, which is meant if nothing is named, plays a competition against three rivals. It shows it on a terminal, and
leaves a table of what the robot did and pictures: its map, its phases, and what its camera saw.

  --seed N        which hall: its walls, its light, the cubes, the rivals (default 1)
  --mission KIND  what decides: afg, an activity flow graph (default), or sdf, a state machine
  --minutes M     how long it lasts (default 10)
  --fault FAULT   breaks something for a while, as in laser-frozen@100s..103s; may be said several times. There are
                  laser-frozen, camera-black, camera-torn, beams-nan, beams-infinite, beams-zero, beams-missing,
                  odometry-stopped, laser-repeated, rear-frozen, odometry-silent, odometry-nan
  --keeps-twist   motors without a command time-out: they keep the last twist until the next one
  --out FOLDER    a new or empty folder for the pictures (default out/sick-robot-day; if it is not empty,
                  out/sick-robot-day-2, and so on)
  --film FILE     a moving picture of the run, as SVG, which browsers play; a file that is there is replaced
  --record FILE   records what the sensors send, and the poses, maps and speeds of the robot, as MCAP: 9 MB a minute.
                  A file that is there is not overwritten: the next one is FILE-2
  --record-images with the images of the cameras: 220 MB a minute

`bench` plays one competition for each of many seeds, and says how they went.

  --first-seed N  the first seed (default 1)
  --seeds N       how many seeds (default 20; of `perception` 50)
  --jobs N        how many competitions at once (default: as many as there are cores); the table does not depend on it,
                  but for the computing times
  --faults        each of them also with each kind of fault, at a time that the seed draws
  --outages       sensors fail one after the other, at times that the seed draws, and the motors keep the last twist: how
                  long the robot moves without them, and whether that is longer than it promises
  --times         where the time goes, by part of the robot; one competition after the other

`perception` measures how well the robot finds targets, reads number signs and sees cubes, on rendered images; --out is
for pictures of what was seen with seed 1.

Examples:
  sick-robot-day --seed 7 --minutes 3
  sick-robot-day --minutes 3 --film film.svg
  sick-robot-day --mission sdf --fault camera-black@60s..70s --record dark.mcap
  sick-robot-day bench --seeds 8 --faults

Exit codes: 0 fine; 1 in a competition something failed in the robot, it caused a collision, or it took a cube to another
station; 2 it could not be done.
";

/// Default folder of the pictures.
pub const PICTURES: &str = "out/sick-robot-day";

/// Maximum number of threads.
const MOST_JOBS: usize = 1024;

/// Maximum duration of a run, in minutes: a day. Longer runs are typing errors.
const MOST_MINUTES: f64 = 1440.0;

impl Command {
    /// Reads the arguments after the name of the program.
    pub fn read(args: impl IntoIterator<Item = OsString>) -> Result<Self, String> {
        let mut args = args.into_iter().peekable();
        let is_name = |arg: &OsString| !arg.as_encoded_bytes().starts_with(b"-");
        let name = args.next_if(is_name);
        let mut parser = Parser::from_args(args);
        match name.as_ref().map(|name| name.to_str()) {
            None | Some(Some("compete")) => compete(&mut parser),
            Some(Some("bench")) => bench(&mut parser),
            Some(Some("perception")) => perception(&mut parser),
            Some(_) => {
                let name = name.unwrap_or_default();
                let name = name.display();
                Err(format!("`{name}` is no command; there are `compete`, `bench` and `perception`, and `--help`"))
            }
        }
    }
}

fn compete(parser: &mut Parser) -> Result<Command, String> {
    let mut setup = Setup { seed: 1, duration: Duration::from_secs(600), ..Setup::default() };
    let (mut out, mut film, mut file, mut images) = (None, None, None, false);
    while let Some(arg) = next(parser)? {
        match arg {
            Long("help") | Short('h') => return Ok(Command::Help),
            Long("seed") => setup.seed = number(parser, "--seed", 0)?,
            Long("mission") => setup.mission = mission(parser)?,
            Long("minutes") => setup.duration = minutes(parser)?,
            Long("keeps-twist") => setup.keeps_twist = true,
            Long("fault") => setup.faults.push(text(parser)?.parse()?),
            Long("out") => out = Some(path(parser)?),
            Long("film") => film = Some(path(parser)?),
            Long("record") => file = Some(path(parser)?),
            Long("record-images") => images = true,
            other => return Err(unknown(other)),
        }
    }
    if images && file.is_none() {
        return Err("`--record-images` needs `--record`, which says where".to_owned());
    }
    setup.record = file.map(|path| Recording { path, images });
    Ok(Command::Compete { setup, out, film })
}

fn bench(parser: &mut Parser) -> Result<Command, String> {
    let mut setup = Setup { duration: Duration::from_secs(600), ..Setup::default() };
    let mut seeds = Seeds { first: 1, count: 20, jobs: None };
    let (mut faults, mut outages, mut times) = (false, false, false);
    while let Some(arg) = next(parser)? {
        match arg {
            Long("help") | Short('h') => return Ok(Command::Help),
            Long("first-seed") => seeds.first = number(parser, "--first-seed", 0)?,
            Long("seeds") => seeds.count = number(parser, "--seeds", 1)?,
            Long("jobs") => seeds.jobs = jobs(parser)?,
            Long("mission") => setup.mission = mission(parser)?,
            Long("minutes") => setup.duration = minutes(parser)?,
            Long("keeps-twist") => setup.keeps_twist = true,
            Long("faults") => faults = true,
            Long("outages") => outages = true,
            Long("times") => times = true,
            other => return Err(unknown(other)),
        }
    }
    let kind = match (faults, outages, times) {
        (false, false, false) => Bench::Score,
        (true, false, false) => Bench::Faults,
        (false, true, false) => Bench::Outages,
        (false, false, true) => Bench::Times,
        _ => return Err("`--faults`, `--outages` and `--times` are measured one at a time".to_owned()),
    };
    if times && seeds.jobs.is_some() {
        return Err("`--times` measures one competition at a time: without `--jobs`".to_owned());
    }
    if seeds.first.checked_add(seeds.count - 1).is_none() {
        return Err("the last seed is too large".to_owned());
    }
    Ok(Command::Bench { seeds, setup, kind })
}

fn perception(parser: &mut Parser) -> Result<Command, String> {
    let (mut seeds, mut out) = (50, None);
    while let Some(arg) = next(parser)? {
        match arg {
            Long("help") | Short('h') => return Ok(Command::Help),
            Long("seeds") => seeds = number(parser, "--seeds", 1)?,
            Long("out") => out = Some(path(parser)?),
            other => return Err(unknown(other)),
        }
    }
    Ok(Command::Perception { seeds, out })
}

fn next(parser: &mut Parser) -> Result<Option<Arg<'_>>, String> {
    parser.next().map_err(|e| e.to_string())
}

fn unknown(arg: Arg<'_>) -> String {
    format!("{}; `--help` lists the options", arg.unexpected())
}

fn path(parser: &mut Parser) -> Result<PathBuf, String> {
    parser.value().map(PathBuf::from).map_err(|e| e.to_string())
}

fn text(parser: &mut Parser) -> Result<String, String> {
    parser.value().map(|value| value.to_string_lossy().into_owned()).map_err(|e| e.to_string())
}

fn number(parser: &mut Parser, option: &str, least: u64) -> Result<u64, String> {
    let value = text(parser)?;
    let number = u64::from_str(&value).ok().filter(|number| *number >= least);
    number.ok_or_else(|| format!("`{option}` is a whole number from {least}, not `{value}`"))
}

fn jobs(parser: &mut Parser) -> Result<Option<NonZero<usize>>, String> {
    let value = text(parser)?;
    let jobs = usize::from_str(&value).ok().and_then(NonZero::new).filter(|jobs| jobs.get() <= MOST_JOBS);
    jobs.map(Some).ok_or_else(|| format!("`--jobs` is a whole number from 1 to {MOST_JOBS}, not `{value}`"))
}

fn minutes(parser: &mut Parser) -> Result<Duration, String> {
    let value = text(parser)?;
    let minutes = f64::from_str(&value).ok().filter(|minutes| *minutes > 0.0 && *minutes <= MOST_MINUTES);
    let duration = minutes.map(|minutes| Duration::from_secs_f64(60.0 * minutes));
    duration.ok_or_else(|| format!("`--minutes` is a number above 0, at most {MOST_MINUTES}, not `{value}`"))
}

fn mission(parser: &mut Parser) -> Result<Mission, String> {
    match text(parser)?.as_str() {
        "afg" => Ok(Mission::Graph),
        "sdf" => Ok(Mission::Machine),
        other => Err(format!("`--mission` is `afg` or `sdf`, not `{other}`")),
    }
}
