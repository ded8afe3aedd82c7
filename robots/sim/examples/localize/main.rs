//! Localization on plans, measured: on recordings with `localize MAP LOG…`, and in simulated buildings with
//! `localize --building`. `--help` describes all options.

mod building;
mod draw;
mod log;
mod options;
mod replay;

use apex_nodes::localize::{TableSettings, VisibilityTable};
use apex_sim::in_order;
use options::{Options, Task};
use std::{path::Path, process::ExitCode, time::Instant};

fn main() -> ExitCode {
    let done = Options::read().and_then(|options| match &options.task {
        Task::Logs { map, logs } => replay::run(&options, map, logs),
        Task::Building { plan } => building::run(&options, plan),
        Task::Speed { plan } => building::speed(&options, plan),
        Task::Draw { plan, file } => building::draw(&options, plan, file),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}

/// Runs `work` for each seed. The results are in the order of the seeds.
fn for_each_seed<R: Send>(options: &Options, work: impl Fn(u64) -> R + Sync) -> Result<Vec<R>, String> {
    let seeds: Vec<u64> = (0..options.seeds).map(|i| options.first_seed + i).collect();
    let mut done = 0;
    let show = |_: &R| {
        done += 1;
        eprint!("\r{done} of {}  ", seeds.len());
    };
    let results = in_order(&seeds, options.jobs, |seed| work(*seed), show).map_err(|e| e.to_string());
    eprint!("\r                    \r");
    results
}

/// Loads or builds the table of a map, and prints its size.
fn table(map: &apex_nodes::map::VectorMap, settings: TableSettings) -> Result<VisibilityTable, String> {
    let start = Instant::now();
    let progress = |share: f32| eprint!("\rtable {:3.0} %", 100.0 * share);
    let cached = VisibilityTable::cached(map, settings, Path::new("target/visible"), progress);
    let cached = cached.map_err(|e| e.to_string())?;
    eprint!("\r           \r");
    if let Some(note) = &cached.note {
        eprintln!("note: {note}");
    }
    let (width, height) = cached.table.size();
    println!(
        "map: {} segments; table: {width} x {height} cells, {:.1} segments per cell and sector, {} in {:.2?}",
        map.segments().len(),
        cached.table.mean_length(),
        if cached.loaded { "loaded" } else { "built" },
        start.elapsed(),
    );
    Ok(cached.table)
}
