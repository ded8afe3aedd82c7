use apex_sim::experiment::{Options, Seeds};
use std::path::PathBuf;

/// Reads the options of a measurement that draws: those of [`Seeds`], and `--out` for the file, which is `out` without
/// it.
pub fn seeds_and_out(options: &mut Options, mut seeds: Seeds, out: &str) -> Result<(Seeds, PathBuf), String> {
    let mut out = PathBuf::from(out);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "out" => out = options.path()?,
            _ => seeds.read(&name, options)?,
        }
    }
    Ok((seeds, out))
}
