//! Commands of the program.

mod bench;
mod compete;
mod help;

use apex_sim::{
    experiment::{Command, Options, Progress},
    say,
};
use help::HELP;
use sick_robot_day::{
    experiments::{
        measure::{ImageWriter, cubes, signs, targets},
        run::{Mission, Setup},
    },
    world::Sensors,
};
use std::process::ExitCode;

pub const COMMANDS: [Command; 3] = [
    Command { name: "compete", help: HELP, run: compete::compete },
    Command { name: "bench", help: HELP, run: bench::bench },
    Command { name: "perception", help: HELP, run: perception },
];

/// Reads the value of an option that all runs have.
fn read_setup(setup: &mut Setup, name: &str, options: &mut Options) -> Result<(), String> {
    match name {
        "mission" => setup.mission = mission(&options.text()?)?,
        "minutes" => setup.duration = options.minutes(name)?,
        "keeps-twist" => setup.keeps_twist = true,
        _ => return Err(Options::unknown(name)),
    }
    Ok(())
}

fn mission(text: &str) -> Result<Mission, String> {
    match text {
        "afg" => Ok(Mission::Graph),
        "sdf" => Ok(Mission::Machine),
        other => Err(format!("`--mission` is `afg` or `sdf`, not `{other}`")),
    }
}

fn perception(options: &mut Options) -> Result<ExitCode, String> {
    let (mut seeds, mut out) = (50, None);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "seeds" => seeds = options.number(&name, 1..)?,
            "out" => out = Some(options.path()?),
            _ => return Err(Options::unknown(&name)),
        }
    }
    let image_writer = out.as_deref().map(ImageWriter::new).transpose()?.unwrap_or_default();
    let mut sensors = Sensors::new().map_err(|e| e.to_string())?;
    let progress = Progress::default();
    let tell = |table: String| {
        progress.clear();
        say(&table)
    };
    tell(format!("{}\n\n", targets(seeds, &mut sensors, &image_writer, &progress)?))?;
    tell(format!("{}\n\n", signs(seeds, &mut sensors, &image_writer, &progress)?))?;
    tell(format!("{}\n\n", cubes(seeds, &image_writer, &progress)?))?;
    say(&format!("seeds 1 to {seeds}\n"))?;
    out.map_or(Ok(()), |folder| say(&format!("pictures: {}\n", folder.display())))?;
    Ok(ExitCode::SUCCESS)
}
