//! The command line.

use std::path::PathBuf;

/// Output of `--help`.
pub const HELP: &str = "Random inputs for everything that reads files: no panic, no hang, no more memory than 2 GiB.

Usage: cargo run --release -- [OPTIONS]

  --seconds N    how long, shared by the targets (60)
  --target NAME  only this one, of those in README.md
  --seed N       where random numbers begin (1)
  --from N       the first input (0)
  --count N      so many inputs and no more
  --out FOLDER   where inputs that fail are kept (failures)
";

/// Options of the command line.
pub struct Args {
    /// Time for all targets, in s.
    pub seconds: u64,
    /// The only target.
    pub target: Option<String>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Number of the first input.
    pub from: u64,
    /// Maximum number of inputs.
    pub count: Option<u64>,
    /// Folder for inputs that fail.
    pub out: PathBuf,
    /// `true` for a process that runs one target.
    pub worker: bool,
}

impl Args {
    /// Reads the command line. Returns `None` for `--help`.
    pub fn parse(mut words: impl Iterator<Item = String>) -> Result<Option<Self>, String> {
        let mut args =
            Self { seconds: 60, target: None, seed: 1, from: 0, count: None, out: "failures".into(), worker: false };
        while let Some(word) = words.next() {
            if word == "--help" {
                return Ok(None);
            }
            if word == "--worker" {
                args.worker = true;
                continue;
            }
            let value = words.next().ok_or_else(|| format!("`{word}` needs a value"))?;
            let number = || value.parse::<u64>().map_err(|_| format!("`{word}` needs a number, not `{value}`"));
            match word.as_str() {
                "--seconds" => args.seconds = number()?,
                "--seed" => args.seed = number()?,
                "--from" => args.from = number()?,
                "--count" => args.count = Some(number()?),
                "--out" => args.out = value.into(),
                "--target" if crate::TARGETS.iter().any(|(name, _)| *name == value) => args.target = Some(value),
                "--target" => return Err(format!("there is no target `{value}`")),
                _ => return Err(format!("there is no option `{word}`")),
            }
        }
        Ok(Some(args))
    }
}
