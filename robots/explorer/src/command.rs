//! Commands of the program.

use apex_sim::{
    OutageTable,
    experiment::{Command, Options, Seeds, activity_table, broken_promises, rows, write_file},
    say,
};
use explorer::{
    experiments::{HEAD, Row, Run, picture, run, run_with_outages, summary},
    world::{self, Fault, FaultKind},
};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    time::Duration,
};

const HELP: &str = "\
A robot explores an unknown field with rocks, finds objects by colour and shape, and charges its battery at a base
station, in simulation.

Usage: explorer [explore] [--seed N] [--minutes N] [--battery N] [--fault FAULT]... [--out FILE] [--record FILE]
       explorer missions [--first-seed N] [--seeds N] [--jobs N] [--minutes N] [--battery N] [--fault FAULT]...
                         [--out FILE] [--record FILE]
       explorer outages [--first-seed N] [--seeds N] [--jobs N] [--minutes N] [--battery N]

`explore` runs the robot on the field of one seed and tells what became of it, and which nodes were active. It draws the
map of the robot into out/explorer/map.svg, with the way of the robot in blue, the base station in green, and in brown
the outlines of what is on the field in truth. Cups are blue and batteries yellow: the true ones are dots, those that
the robot knows circles.

  --seed N          seed of the field and all noise (default 1)
  --minutes N       longest time of the run (default 20)
  --battery N       minutes in which a full battery is empty (default 6)
  --fault FAULT     fault of a device, such as laser-silent@100s..103s: laser-silent, laser-repeated, beams-infinite,
                    wheels-silent, wheels-nan, wheels-stopped, charge-silent, eye-black
  --out FILE        the picture (default out/explorer/map.svg)
  --record FILE     recording of the (first) run, for Foxglove, Rerun and `apex bag`: scans, images, maps, paths, poses

`missions` does so for many seeds, with a line for each, and draws the first run.

  --first-seed N    first seed (default 1)
  --seeds N         number of seeds (default 10)
  --jobs N          number of threads (default: as many as there are cores)

What the columns are, by the true state of the simulation:
  explored          share of the ground on which the robot has room that its map shows as free at the end
  objects           cups and batteries that the robot knows, by at least four sightings, of those that there are
  wrong             objects that the robot knows, but which are not there, or known twice
  greatest error    distance of a known object from the true one
  charged           times that the battery was charged
  home again        time at which the robot was at the base station with nothing left to explore, and its distance from
                    the place where it began
  took              computing time of the simulation and the robot

`outages` lets the sensors fail one after the other in each run, with motors that keep the last twist, and tells how
long the robot moves without them.

Exit codes: 0 fine; 1 the robot explored less than 95 %, did not find all objects within 0.2 m, was not home again in
time, touched something, or a node failed; for `outages`, the robot moved longer than it promises, or touched something;
2 nothing could be done.
";

pub const COMMANDS: [Command; 3] = [
    Command { name: "explore", help: HELP, run: explore },
    Command { name: "missions", help: HELP, run: missions },
    Command { name: "outages", help: HELP, run: measure_outages },
];

/// Share of the ground that has to be explored, and greatest error of the place of an object, in m.
const EXPLORED: f32 = 0.95;
const ERROR: f32 = 0.2;

/// Options of a run, and the files of the picture and the recording.
struct Setup {
    longest: Duration,
    world: world::Options,
    out: PathBuf,
    record: Option<PathBuf>,
}

impl Setup {
    fn new() -> Self {
        let out = PathBuf::from("out/explorer/map.svg");
        Self { longest: Duration::from_secs(1200), world: world::Options::default(), out, record: None }
    }

    /// Reads the value of the option `name`.
    fn read(&mut self, name: &str, options: &mut Options) -> Result<(), String> {
        match name {
            "minutes" => self.longest = options.minutes(name)?,
            "battery" => self.world.life = options.minutes(name)?,
            "fault" => self.world.faults.push(options.text()?.parse::<Fault>()?),
            "out" => self.out = options.path()?,
            "record" => self.record = Some(options.path()?),
            _ => return Err(Options::unknown(name)),
        }
        Ok(())
    }

    fn of(&self, seed: u64) -> world::Options {
        world::Options { seed, ..self.world.clone() }
    }

    /// Runs the robot. Only the run with the seed `first` is recorded.
    fn run(&self, seed: u64, first: u64) -> Result<Run, String> {
        run(&self.of(seed), self.longest, self.record.as_deref().filter(|_| seed == first))
    }
}

fn explore(options: &mut Options) -> Result<ExitCode, String> {
    let (mut seed, mut setup) = (1, Setup::new());
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "seed" => seed = options.number(&name, 0..)?,
            _ => setup.read(&name, options)?,
        }
    }
    let run = setup.run(seed, seed)?;
    say(&format!("{HEAD}\n{}\n\nActive nodes:\n{}", Row(&run), activity_table(&run.activity)))?;
    draw(&run, &setup.out)?;
    Ok(verdict(&[run]))
}

fn missions(options: &mut Options) -> Result<ExitCode, String> {
    let mut setup = Setup::new();
    let seeds = Seeds::new(10).read_beside(options, |name, options| setup.read(name, options))?;
    say(&format!("{HEAD}\n"))?;
    let all = seeds.all();
    let work = |seed: &u64| setup.run(*seed, all[0]);
    let runs = rows("runs", &all, seeds.jobs, work, |_, run| Some(Row(run).to_string()))?;
    say(&format!("\n{}", summary(&runs)))?;
    draw(&runs[0], &setup.out)?;
    Ok(verdict(&runs))
}

/// Prints what the robot does in outages, and those in which it moved longer than it promises.
fn measure_outages(options: &mut Options) -> Result<ExitCode, String> {
    let mut setup = Setup::new();
    let seeds = Seeds::new(10).read_beside(options, |name, options| match name {
        "minutes" | "battery" => setup.read(name, options),
        _ => Err(Options::unknown(name)),
    })?;
    say(&format!("{HEAD}\n"))?;
    let all = seeds.all();
    let work = |seed: &u64| run_with_outages(&setup.of(*seed), setup.longest);
    let (runs, watches): (Vec<Run>, Vec<_>) =
        rows("runs", &all, seeds.jobs, work, |_, (run, _)| Some(Row(run).to_string()))?.into_iter().unzip();
    say(&format!("\n{}\n{seeds}\n", OutageTable(&watches)))?;
    let code = broken_promises(&all, &watches, |outage| Fault::of(outage, &FaultKind::ALL).to_string())?;
    let is_fine = runs.iter().all(|run| run.report.contacts.is_empty() && run.failures.is_empty());
    Ok(if is_fine { code } else { ExitCode::from(1) })
}

fn draw(run: &Run, out: &Path) -> Result<(), String> {
    write_file(out, &picture(run))?;
    say(&format!("picture: {}\n", out.display()))
}

/// Exit code: 0 if each run met the goals.
fn verdict(runs: &[Run]) -> ExitCode {
    let is_fine = |run: &Run| {
        let report = &run.report;
        let is_home = report.finished.is_some() && run.explored >= EXPLORED;
        let finds = &run.finds;
        let is_exact = finds.greatest_error().is_none_or(|error| error <= ERROR) && finds.wrong() == 0;
        let has_all = finds.found == finds.objects && is_exact;
        is_home && has_all && report.contacts.is_empty() && run.failures.is_empty()
    };
    if runs.iter().all(is_fine) { ExitCode::SUCCESS } else { ExitCode::from(1) }
}
