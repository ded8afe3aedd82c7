use super::setup::read_setup;
use apex_sim::{
    OutageTable,
    experiment::{Options, Progress, Seeds, broken_promises, rows},
    say,
};
use sick_robot_day::{
    experiments::{
        bench::{Outages, Score, Summary, Times, Toll, fault_at},
        run::{Setup, Watch},
    },
    world::contest::{Fault, FaultKind},
};
use std::{
    process::ExitCode,
    time::{Duration, Instant},
};

/// Plays competitions with many seeds.
pub fn bench(options: &mut Options) -> Result<ExitCode, String> {
    let mut setup = Setup { duration: Duration::from_secs(600), ..Setup::default() };
    let (mut faults, mut outages, mut times) = (false, false, false);
    let seeds = Seeds::new(20).read_beside(options, |name, options| {
        match name {
            "faults" => faults = true,
            "outages" => outages = true,
            "times" => times = true,
            _ => read_setup(&mut setup, name, options)?,
        }
        Ok(())
    })?;
    if times && seeds.jobs.is_some() {
        return Err("`--times` measures one competition at a time: without `--jobs`".to_owned());
    }
    match (faults, outages, times) {
        (false, false, true) => measure_times(seeds, &setup),
        (false, true, false) => measure_outages(seeds, &setup),
        (_, false, false) => measure_scores(seeds, &setup, faults),
        _ => Err("`--faults`, `--outages` and `--times` are measured one at a time".to_owned()),
    }
}

fn measure_scores(seeds: Seeds, setup: &Setup, faults: bool) -> Result<ExitCode, String> {
    say(&format!("{}\n", Score::HEAD))?;
    let mut kinds = vec![None];
    if faults {
        kinds.extend(FaultKind::ALL.map(Some));
    }
    let all = seeds.all();
    let jobs: Vec<Setup> = kinds.iter().flat_map(|kind| all.iter().map(|seed| job(setup, *seed, *kind))).collect();
    let line = |setup: &Setup, score: &Score| {
        let fault = setup.faults.first().map(|fault| format!("  {fault}")).unwrap_or_default();
        Some(format!("{score}{fault}"))
    };
    let scores = rows("competitions", &jobs, seeds.jobs, |setup| play(setup, &mut ()), line)?;
    let without = &scores[..all.len()];
    say(&format!("\n{}\n", Summary(without)))?;
    if faults {
        say(&format!("\n{}\n", Toll::HEAD))?;
        let tolls =
            kinds.iter().zip(scores.chunks(all.len())).map(|(kind, scores)| Toll { kind: *kind, scores, without });
        tolls.map(|toll| format!("{toll}\n")).try_for_each(|line| say(&line))?;
    }
    let is_fine = scores.iter().all(|score| score.wrong + score.caused + score.failures.len() == 0);
    Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

fn job(setup: &Setup, seed: u64, kind: Option<FaultKind>) -> Setup {
    let faults = kind.map(|kind| fault_at(kind, seed, setup.end()));
    Setup { seed, faults: faults.into_iter().collect(), ..setup.clone() }
}

fn play(setup: &Setup, watch: &mut dyn Watch) -> Result<Score, String> {
    let start = Instant::now();
    let outcome = setup.run(watch, None)?;
    Ok(Score::of(&outcome, start.elapsed()))
}

/// In sequence, as parallel runs would slow one another down.
fn measure_times(seeds: Seeds, setup: &Setup) -> Result<ExitCode, String> {
    let (progress, info) = (Progress::default(), setup.mission.info());
    let mut all = Times::new(info, setup.end());
    for (done, seed) in (1..).zip(seeds.all()) {
        progress.step("competitions", done, seeds.count());
        let mut times = Times::new(info, setup.end());
        play(&job(setup, seed, None), &mut times)?;
        all.add(&times);
    }
    progress.clear();
    say(&format!("{all}\n\n{seeds}\n"))?;
    Ok(ExitCode::SUCCESS)
}

/// Prints what the robot does in outages, and those in which it moved longer than it promises.
fn measure_outages(seeds: Seeds, setup: &Setup) -> Result<ExitCode, String> {
    let all = seeds.all();
    let watches = rows("competitions", &all, seeds.jobs, |seed| Outages::run(setup, *seed), |_, _| None)?;
    say(&format!("{}\n{seeds}\n", OutageTable(&watches)))?;
    broken_promises(&all, &watches, |outage| Fault::of(outage, &FaultKind::ALL).to_string())
}
