use apex_sim::{
    experiment::{Options, Progress},
    say,
};
use sick_robot_day::{
    experiments::measure::{ImageWriter, cubes, signs, targets},
    world::Sensors,
};
use std::process::ExitCode;

/// Measures the perception of the targets, the signs and the cubes.
pub fn perception(options: &mut Options) -> Result<ExitCode, String> {
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
