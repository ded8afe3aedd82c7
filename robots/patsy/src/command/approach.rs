use super::args::{Seeds, seeds_and_out};
use apex_sim::say;
use lexopt::Parser;
use patsy::{
    approach::{approaches, picture, table},
    write_file,
};
use std::process::ExitCode;

/// Drives beneath a container from all start poses, and draws from where it works.
pub fn approach(parser: &mut Parser) -> Result<ExitCode, String> {
    let (seeds, out) = seeds_and_out(parser, Seeds::new(1), "out/patsy/approach.svg")?;
    let all = seeds.all();
    let approaches = approaches(&all, seeds.jobs).map_err(|e| e.to_string())?;
    say(&table(&approaches))?;
    write_file(&out, &picture(&approaches))?;
    say(&format!("seeds {} to {}; picture: {}\n", all[0], all[all.len() - 1], out.display()))?;
    Ok(ExitCode::SUCCESS)
}
