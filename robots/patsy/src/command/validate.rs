use super::args::{Seeds, next, number, path, seeds_option};
use apex_sim::say;
use lexopt::{Parser, prelude::Long};
use patsy::validate::{Data, validate as cross_validate};
use std::process::ExitCode;

/// Cross-validates the limits of the search for pallets on a recording.
pub fn validate(parser: &mut Parser) -> Result<ExitCode, String> {
    let (mut seeds, mut folds) = (Seeds::new(1), 5);
    let (mut with, mut labels, mut without) = (None, None, None);
    while let Some(arg) = next(parser)? {
        match arg {
            Long("with") => with = Some(path(parser)?),
            Long("labels") => labels = Some(path(parser)?),
            Long("without") => without = Some(path(parser)?),
            Long("folds") => folds = number(parser, "--folds", 2..=100)? as usize,
            Long("jobs") => seeds.read(parser, Some("jobs"), String::new())?,
            other => return Err(seeds_option(other).1),
        }
    }
    let (Some(with), Some(labels), Some(without)) = (with, labels, without) else {
        return Err("`validate` needs `--with`, `--labels` and `--without`".to_owned());
    };
    let data = Data::read(&with, &labels, &without)?;
    say(&cross_validate(&data, folds, seeds.jobs)?.to_string())?;
    Ok(ExitCode::SUCCESS)
}
