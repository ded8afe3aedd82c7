use super::{Bench, Seeds, say};
use apex_sim::{OutageTable, in_order};
use sick_robot_day::{
    bench::{Outages, Score, Summary, Times, Toll, fault_at},
    contest::FaultKind,
    measure::Progress,
    run::{Setup, Watch},
};
use std::{num::NonZero, process::ExitCode, time::Instant};

/// Plays competitions with these seeds.
pub fn bench(seeds: Seeds, setup: &Setup, kind: Bench) -> Result<ExitCode, String> {
    match kind {
        Bench::Times => measure_times(seeds, setup),
        Bench::Outages => measure_outages(seeds, setup),
        Bench::Score | Bench::Faults => measure_scores(seeds, setup, kind == Bench::Faults),
    }
}

fn measure_scores(seeds: Seeds, setup: &Setup, faults: bool) -> Result<ExitCode, String> {
    say(&format!("{}\n", Score::HEAD))?;
    let mut kinds = vec![None];
    if faults {
        kinds.extend(FaultKind::ALL.map(Some));
    }
    let count = usize::try_from(seeds.count).map_err(|_| "so many seeds have no room in memory".to_owned())?;
    let jobs: Vec<Setup> = kinds.iter().flat_map(|kind| seeds.numbers().map(|seed| job(setup, seed, *kind))).collect();
    let scores = scores(&jobs, seeds.jobs)?;
    let without = &scores[..count];
    say(&format!("\n{}\n", Summary(without)))?;
    if faults {
        say(&format!("\n{}\n", Toll::HEAD))?;
        let tolls = kinds.iter().zip(scores.chunks(count)).map(|(kind, scores)| Toll { kind: *kind, scores, without });
        tolls.map(|toll| format!("{toll}\n")).try_for_each(|line| say(&line))?;
    }
    let is_fine = scores.iter().all(|score| score.wrong + score.caused + score.failures.len() == 0);
    Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

fn job(setup: &Setup, seed: u64, kind: Option<FaultKind>) -> Setup {
    let faults = kind.map(|kind| fault_at(kind, seed, setup.end()));
    Setup { seed, faults: faults.into_iter().collect(), ..setup.clone() }
}

/// Plays all competitions, and prints a line for each.
fn scores(jobs: &[Setup], threads: Option<NonZero<usize>>) -> Result<Vec<Score>, String> {
    let (progress, mut done, mut printed) = (Progress::default(), 0, Ok(()));
    let show = |score: &Result<Score, String>| {
        let fault = jobs[done].faults.first().map(|fault| format!("  {fault}")).unwrap_or_default();
        done += 1;
        progress.clear();
        if let (Ok(()), Ok(score)) = (&printed, score) {
            printed = say(&format!("{score}{fault}\n"));
        }
        progress.step("competitions", done as u64, jobs.len() as u64);
    };
    let scores = in_order(jobs, threads, |setup| play(setup, &mut ()), show).map_err(|e| e.to_string())?;
    progress.clear();
    printed?;
    scores.into_iter().collect()
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
    for (done, seed) in (1..).zip(seeds.numbers()) {
        progress.step("competitions", done, seeds.count);
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
    let (progress, mut done) = (Progress::default(), 0);
    let show = |_: &_| {
        done += 1;
        progress.step("competitions", done, seeds.count);
    };
    let all: Vec<u64> = seeds.numbers().collect();
    let runs = in_order(&all, seeds.jobs, |seed| Outages::run(setup, *seed), show).map_err(|e| e.to_string())?;
    progress.clear();
    let watches = runs.into_iter().collect::<Result<Vec<_>, String>>()?;
    say(&format!("{}\n{seeds}\n", OutageTable(&watches)))?;
    let broken = all.iter().zip(&watches).flat_map(|(seed, watch)| watch.broken().into_iter().map(move |b| (seed, b)));
    let mut is_fine = true;
    for (seed, (outage, time)) in broken {
        is_fine = false;
        let fault = Outages::fault(&outage);
        say(&format!("seed {seed}: {fault}: moves for {:.2} s\n", time.as_secs_f64()))?;
    }
    Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(1) })
}
