use apex_sim::experiment::Options;
use sick_robot_day::experiments::run::{Mission, Setup};

/// Reads the value of an option that all runs have.
pub fn read_setup(setup: &mut Setup, name: &str, options: &mut Options) -> Result<(), String> {
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
