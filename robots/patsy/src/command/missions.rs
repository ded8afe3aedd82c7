use super::args::{Seeds, next, number, path, seeds_option};
use apex_sim::{OutageTable, in_order, say};
use lexopt::{Parser, prelude::Long};
use patsy::{
    clinic::{FaultKind, Options, PEOPLE},
    missions::{
        BudgetTable, Row, Run, activity_table, fault_at, fault_of, faults_table, picture, run, run_with_outages,
        summary, timeline,
    },
    write_file,
};
use std::{path::PathBuf, process::ExitCode, time::Duration};

/// Options of the command.
struct Missions {
    seeds: Seeds,
    duration: Duration,
    people: usize,
    faults: bool,
    keeps_twist: bool,
    outages: bool,
    out: PathBuf,
    record: Option<PathBuf>,
    timeline: Option<PathBuf>,
}

/// Runs the vehicle in many clinics, also with faults, and counts what came of it.
pub fn missions(parser: &mut Parser) -> Result<ExitCode, String> {
    let missions = read(parser)?;
    if missions.outages {
        return missions.outages();
    }
    let seeds = missions.seeds.all();
    let mut jobs: Vec<Options> = seeds.iter().map(|seed| missions.options(*seed, None)).collect();
    if missions.faults {
        let kinds = FaultKind::MEASURED.into_iter();
        jobs.extend(
            kinds
                .flat_map(|kind| seeds.iter().map(move |seed| (*seed, kind)))
                .map(|(seed, kind)| missions.options(seed, Some(kind))),
        );
    }
    say(&format!("{}\n", Row::HEAD))?;
    let mut said = Ok(());
    let show = |run: &Result<Run, String>| {
        if let (Ok(run), Ok(())) = (run, &said) {
            said = say(&format!("{}\n", Row(run)));
        }
    };
    let record = |options: &Options| missions.record.as_deref().filter(|_| *options == jobs[0]);
    let work = |options: &Options| run(options, missions.duration, record(options));
    let runs = in_order(&jobs, missions.seeds.jobs, work, show).map_err(|e| e.to_string())?;
    said?;
    let runs = runs.into_iter().collect::<Result<Vec<Run>, String>>()?;
    let (without, with) = runs.split_at(seeds.len());
    say(&format!("\n{}\n{}\nActive nodes:\n{}\n", summary(without), BudgetTable(without), activity_table(without)))?;
    if missions.faults {
        say(&format!("{}\n", faults_table(without, with)))?;
    }
    write_file(&missions.out, &picture(&without[0]))?;
    if let Some(path) = &missions.timeline {
        write_file(path, &timeline(&without[0]))?;
    }
    let (first, last) = (seeds[0], seeds[seeds.len() - 1]);
    say(&format!("seeds {first} to {last}; picture: {}\n", missions.out.display()))?;
    Ok(if runs.iter().all(|run| run.failures.is_empty()) { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

impl Missions {
    /// Prints what the vehicle does in outages, and those in which it moved longer than it promises.
    fn outages(&self) -> Result<ExitCode, String> {
        let seeds = self.seeds.all();
        let work = |seed: &u64| run_with_outages(&self.options(*seed, None), self.duration);
        let runs = in_order(&seeds, self.seeds.jobs, work, |_| ()).map_err(|e| e.to_string())?;
        let watches = runs.into_iter().collect::<Result<Vec<_>, String>>()?;
        say(&format!("{}", OutageTable(&watches)))?;
        let mut is_fine = true;
        for (seed, (outage, time)) in
            seeds.iter().zip(&watches).flat_map(|(s, w)| w.broken().into_iter().map(move |b| (s, b)))
        {
            is_fine = false;
            say(&format!("seed {seed}: {}: moves for {:.2} s\n", fault_of(&outage), time.as_secs_f64()))?;
        }
        Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(1) })
    }

    fn options(&self, seed: u64, kind: Option<FaultKind>) -> Options {
        let faults = kind.map(|kind| fault_at(kind, seed, self.duration)).into_iter().collect();
        let command_timeout = Options::default().command_timeout.filter(|_| !self.keeps_twist);
        Options { seed, people: self.people, faults, command_timeout }
    }
}

fn read(parser: &mut Parser) -> Result<Missions, String> {
    let mut missions = Missions {
        seeds: Seeds::new(1),
        duration: Duration::from_secs(600),
        people: PEOPLE,
        faults: false,
        keeps_twist: false,
        outages: false,
        out: PathBuf::from("out/patsy/clinic.svg"),
        record: None,
        timeline: None,
    };
    while let Some(arg) = next(parser)? {
        match arg {
            Long("minutes") => missions.duration = Duration::from_secs(60 * number(parser, "--minutes", 1..=600)?),
            Long("people") => missions.people = number(parser, "--people", 0..=100)? as usize,
            Long("faults") => missions.faults = true,
            Long("keeps-twist") => missions.keeps_twist = true,
            Long("outages") => missions.outages = true,
            Long("out") => missions.out = path(parser)?,
            Long("record") => missions.record = Some(path(parser)?),
            Long("timeline") => missions.timeline = Some(path(parser)?),
            arg => {
                let (option, message) = seeds_option(arg);
                missions.seeds.read(parser, option, message)?;
            }
        }
    }
    Ok(missions)
}
