use super::options::seeds_and_out;
use apex_sim::{
    experiment::{Options, Seeds, write_file},
    say,
};
use patsy::experiments::approach::{approaches, picture, table};
use std::process::ExitCode;

/// Drives beneath a container from all start poses, and draws from where it works.
pub fn approach(options: &mut Options) -> Result<ExitCode, String> {
    let (seeds, out) = seeds_and_out(options, Seeds::new(1), "out/patsy/approach.svg")?;
    let approaches = approaches(&seeds.all(), seeds.jobs).map_err(|e| e.to_string())?;
    say(&table(&approaches))?;
    write_file(&out, &picture(&approaches))?;
    say(&format!("{seeds}; picture: {}\n", out.display()))?;
    Ok(ExitCode::SUCCESS)
}
