use apex_sim::{
    experiment::{Options, Seeds},
    say,
};
use patsy::experiments::validate::{Data, validate as cross_validate};
use std::process::ExitCode;

/// Cross-validates the limits of the search for pallets on a recording.
pub fn validate(options: &mut Options) -> Result<ExitCode, String> {
    let (mut seeds, mut folds) = (Seeds::new(1), 5);
    let (mut with, mut labels, mut without) = (None, None, None);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "with" => with = Some(options.path()?),
            "labels" => labels = Some(options.path()?),
            "without" => without = Some(options.path()?),
            "folds" => folds = options.number(&name, 2..=100)? as usize,
            "jobs" => seeds.read(&name, options)?,
            _ => return Err(Options::unknown(&name)),
        }
    }
    let (Some(with), Some(labels), Some(without)) = (with, labels, without) else {
        return Err("`validate` needs `--with`, `--labels` and `--without`".to_owned());
    };
    let data = Data::read(&with, &labels, &without)?;
    say(&cross_validate(&data, folds, seeds.jobs)?.to_string())?;
    Ok(ExitCode::SUCCESS)
}
