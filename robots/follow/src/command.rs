//! Commands of the program.

use apex_sim::{
    experiment::{Command, Options, Seeds, activity_table, rows, write_file},
    say,
};
use follow::{
    experiments::{Accuracy, HEAD, Localisation, Row, Run, accuracy, localisation, picture, run, summary},
    world::{self, Ending, Fault},
};
use std::{path::PathBuf, process::ExitCode};

const HELP: &str = "\
A skid-steered robot follows a runner outdoors, in simulation: over hills, between trees, rocks, ditches and people.

Usage: follow [follow] [--seed N] [--metres N] [--no-people] [--fault FAULT] [--out FILE] [--record FILE]
                       [--timeline FILE]
       follow missions [--first-seed N] [--seeds N] [--jobs N] [--metres N] [--no-people] [--fault FAULT] [--out FILE]
                       [--record FILE] [--timeline FILE]
       follow localisation [--first-seed N] [--seeds N] [--jobs N] [--metres N]
       follow perception [--first-seed N] [--seeds N] [--jobs N]

`follow` runs the robot on the track of one seed and tells what became of it, and which nodes were active. It draws the
track into out/follow/track.svg: the runner in orange, the robot in blue, contacts as red circles, places where the
robot lost the runner as violet ones.

  --seed N          seed of the country, the runner, the passers-by and all noise (default 1)
  --metres N        length of the track (default 1700)
  --no-people       without people who cross the track and stand beside it
  --fault FAULT     fault of a sensor of the pose in the world, such as gnss-silent@100s..160s; kinds are
                    gnss-silent (no positions), gnss-jump (20 m too far to the east), gyro-nan and wheels-silent
  --out FILE        the picture (default out/follow/track.svg)
  --record FILE     recording of the (first) run, for Foxglove, Rerun and `apex bag`: clouds, scans, maps, paths, poses
  --timeline FILE   what happened in the (first) run, and when: active nodes, losses, contacts

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

The last line of `follow` is the error of the pose in the world (RMS) while the robot knew it.

`perception` measures how many points are taken for ground and for obstacles, on 60 turns of the scanner on the track of
each seed, and the computing time of perception for a turn of 28,800 points.

`localisation` drives behind the runner of each seed by the true pose, and tells the error of the pose by
wheels, gyroscope and satellites (GNSS): in all, and in the minute in which two of the rows have no positions. *NEES*
is the mean squared error, normalised by the covariance: 3 if the errors are as large as the filter says.

Exit codes: 0 fine, 1 the robot lost the runner for longer than 5 s, touched something, tipped or fell, or a node
failed; for `perception`, a rate below 95 %; 2 nothing could be done.
";

pub const COMMANDS: [Command; 4] = [
    Command { name: "follow", help: HELP, run: follow_one },
    Command { name: "missions", help: HELP, run: missions },
    Command { name: "localisation", help: HELP, run: localise },
    Command { name: "perception", help: HELP, run: perception },
];

/// Options of the world, and the files of the picture and the recording.
struct World {
    metres: u64,
    people: bool,
    fault: Option<Fault>,
    out: PathBuf,
    record: Option<PathBuf>,
    timeline: Option<PathBuf>,
}

impl World {
    fn new() -> Self {
        let out = PathBuf::from("out/follow/track.svg");
        Self { metres: 1700, people: true, fault: None, out, record: None, timeline: None }
    }

    /// Reads the value of the option `name`.
    fn read(&mut self, name: &str, options: &mut Options) -> Result<(), String> {
        match name {
            "metres" => self.metres = options.number(name, 100..=5000)?,
            "no-people" => self.people = false,
            "fault" => self.fault = Some(options.text()?.parse()?),
            "out" => self.out = options.path()?,
            "record" => self.record = Some(options.path()?),
            "timeline" => self.timeline = Some(options.path()?),
            _ => return Err(Options::unknown(name)),
        }
        Ok(())
    }

    /// Runs the robot. Only the run with the seed `first` is recorded.
    fn run(&self, seed: u64, first: u64) -> Result<Run, String> {
        let options = world::Options { seed, length: self.metres as f32, people: self.people, fault: self.fault };
        run(&options, self.record.as_deref().filter(|_| seed == first))
    }

    /// Writes the files about the first run.
    fn write(&self, run: &Run) -> Result<(), String> {
        if let Some(path) = &self.timeline {
            write_file(path, &run.timeline())?;
        }
        write_file(&self.out, &picture(run))?;
        say(&format!("picture: {}\n", self.out.display()))
    }
}

fn follow_one(options: &mut Options) -> Result<ExitCode, String> {
    let (mut seed, mut world) = (1, World::new());
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "seed" => seed = options.number(&name, 0..)?,
            _ => world.read(&name, options)?,
        }
    }
    let run = world.run(seed, seed)?;
    say(&format!("{HEAD}\n{}\n\nActive nodes:\n{}", Row(&run), activity_table(&run.activity)))?;
    for loss in &run.report.losses {
        say(&format!("lost at {} for {:.2} s\n", loss.from, loss.lasted))?;
    }
    for contact in &run.report.contacts {
        let what = contact.what();
        say(&format!("touched {what} at {} with {:.2} m/s\n", contact.at, contact.speed))?;
    }
    let located = run.report.located().map_or("the robot did not know it".to_owned(), |[position, heading]| {
        format!("{position:.2} m, {:.1}°", heading.to_degrees())
    });
    say(&format!("error of the pose in the world: {located}\n"))?;
    world.write(&run)?;
    Ok(verdict(&[run]))
}

fn missions(options: &mut Options) -> Result<ExitCode, String> {
    let mut world = World::new();
    let seeds = Seeds::new(1).read_beside(options, |name, options| world.read(name, options))?;
    say(&format!("{HEAD}\n"))?;
    let all = seeds.all();
    let work = |seed: &u64| world.run(*seed, all[0]);
    let runs = rows("runs", &all, seeds.jobs, work, |_, run| Some(Row(run).to_string()))?;
    say(&format!("\n{}", summary(&runs)))?;
    world.write(&runs[0])?;
    Ok(verdict(&runs))
}

fn localise(options: &mut Options) -> Result<ExitCode, String> {
    let mut metres = 1700;
    let read = |name: &str, options: &mut Options| match name {
        "metres" => options.number(name, 100..=5000).map(|number| metres = number),
        _ => Err(Options::unknown(name)),
    };
    let seeds = Seeds::new(1).read_beside(options, read)?;
    let work = |seed: &u64| Ok(localisation(*seed, metres as f32));
    let all = rows("seeds", &seeds.all(), seeds.jobs, work, |_, _| None)?;
    let mut sum = Localisation::default();
    all.iter().for_each(|one| sum.add(one));
    say(&sum.to_string())?;
    Ok(ExitCode::SUCCESS)
}

fn perception(options: &mut Options) -> Result<ExitCode, String> {
    let seeds = Seeds::new(1).read_all(options)?;
    say("        precision and recall of ground, of obstacles          time of a turn\n")?;
    say("  seed    ground                 obstacles                  median     most\n")?;
    let all = rows("seeds", &seeds.all(), seeds.jobs, |seed| Ok(accuracy(*seed)), |_, all| Some(all.to_string()))?;
    let mut sum = Accuracy::default();
    all.iter().for_each(|one| sum.add(one));
    say(&format!("\n{}", sum.table()))?;
    let is_fine = all.iter().all(|one| one.rates().iter().all(|rate| *rate >= 0.95));
    Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(1) })
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
