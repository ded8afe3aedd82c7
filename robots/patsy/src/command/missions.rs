use apex_sim::{
    OutageTable,
    experiment::{Options, Seeds, broken_promises, rows, write_file},
    say,
};
use patsy::{
    experiments::missions::{
        Budget, BudgetTable, Row, activity_table, fault_at, faults_table, picture, prices, prices_table, run,
        run_with_outages, summary, timeline,
    },
    world::clinic::{self, Conditions, Fault, FaultKind, PEOPLE, words},
};
use std::{path::PathBuf, process::ExitCode, time::Duration};

/// Options of the command.
struct Missions {
    seeds: Seeds,
    duration: Duration,
    people: usize,
    faults: bool,
    fault: Option<FaultKind>,
    keeps_twist: bool,
    outages: bool,
    world: Option<Conditions>,
    prices: bool,
    out: PathBuf,
    record: Option<PathBuf>,
    timeline: Option<PathBuf>,
}

/// Runs the vehicle in many clinics, also with faults, and counts what came of it.
pub fn missions(options: &mut Options) -> Result<ExitCode, String> {
    let missions = read(options)?;
    if missions.outages {
        return missions.outages();
    }
    let seeds = missions.seeds.all();
    let mut jobs: Vec<clinic::Options> = seeds.iter().map(|seed| missions.options(*seed, missions.fault)).collect();
    if missions.prices {
        for (_, conditions) in prices(&missions.conditions()) {
            jobs.extend(seeds.iter().map(|seed| clinic::Options { conditions, ..missions.options(*seed, None) }));
        }
    }
    if missions.faults {
        let kinds = FaultKind::MEASURED.into_iter();
        jobs.extend(
            kinds
                .flat_map(|kind| seeds.iter().map(move |seed| (*seed, kind)))
                .map(|(seed, kind)| missions.options(seed, Some(kind))),
        );
    }
    say(&format!("{}\n", Row::HEAD))?;
    let record = |options: &clinic::Options| missions.record.as_deref().filter(|_| *options == jobs[0]);
    let work = |options: &clinic::Options| run(options, missions.duration, record(options));
    let runs = rows("runs", &jobs, missions.seeds.jobs, work, |_, run| Some(Row(run).to_string()))?;
    let (without, with) = runs.split_at(seeds.len());
    let budgets: Vec<&Budget> = without.iter().map(|run| &run.budget).collect();
    let (summary, budget) = (summary(without), BudgetTable(&budgets));
    say(&format!("\n{summary}\n{budget}\nActive nodes:\n{}\n", activity_table(without)))?;
    if missions.faults {
        say(&format!("{}\n", faults_table(without, with)))?;
    }
    if missions.prices {
        say(&format!("{}\n", prices_table(&prices(&missions.conditions()), &runs)))?;
    }
    write_file(&missions.out, &picture(&without[0]))?;
    if let Some(path) = &missions.timeline {
        write_file(path, &timeline(&without[0]))?;
    }
    say(&format!("{}; picture: {}\n", missions.seeds, missions.out.display()))?;
    Ok(if runs.iter().all(|run| run.failures.is_empty()) { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

impl Missions {
    /// Prints what the vehicle does in outages, and those in which it moved longer than it promises.
    fn outages(&self) -> Result<ExitCode, String> {
        let seeds = self.seeds.all();
        let work = |seed: &u64| run_with_outages(&self.options(*seed, None), self.duration);
        let watches = rows("runs", &seeds, self.seeds.jobs, work, |_, _| None)?;
        say(&format!("{}", OutageTable(&watches)))?;
        broken_promises(&seeds, &watches, |outage| words(&Fault::of(outage, &FaultKind::OF_SENSORS)))
    }

    /// Conditions of the world; of `harder` if its prices are asked for, and of `kind` else.
    fn conditions(&self) -> Conditions {
        self.world.unwrap_or(if self.prices { Conditions::HARDER } else { Conditions::KIND })
    }

    fn options(&self, seed: u64, kind: Option<FaultKind>) -> clinic::Options {
        let conditions = if self.prices { Conditions::KIND } else { self.conditions() };
        let faults = kind.map(|kind| fault_at(kind, seed, self.duration)).into_iter().collect();
        let command_timeout = clinic::Options::default().command_timeout.filter(|_| !self.keeps_twist);
        clinic::Options { seed, people: self.people, faults, command_timeout, conditions }
    }
}

fn read(options: &mut Options) -> Result<Missions, String> {
    let mut missions = Missions {
        seeds: Seeds::new(1),
        duration: Duration::from_secs(600),
        people: PEOPLE,
        faults: false,
        fault: None,
        keeps_twist: false,
        outages: false,
        world: None,
        prices: false,
        out: PathBuf::from("out/patsy/clinic.svg"),
        record: None,
        timeline: None,
    };
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "minutes" => missions.duration = options.minutes(&name)?,
            "people" => missions.people = options.number(&name, 0..=100)? as usize,
            "faults" => missions.faults = true,
            "fault" => missions.fault = Some(options.text()?.parse()?),
            "keeps-twist" => missions.keeps_twist = true,
            "outages" => missions.outages = true,
            "world" => missions.world = Some(Conditions::named(&options.text()?)?),
            "prices" => missions.prices = true,
            "out" => missions.out = options.path()?,
            "record" => missions.record = Some(options.path()?),
            "timeline" => missions.timeline = Some(options.path()?),
            _ => missions.seeds.read(&name, options)?,
        }
    }
    if missions.faults && missions.fault.is_some() {
        return Err("`--faults` runs with faults of all kinds: leave out `--fault` or `--faults`".to_owned());
    }
    if missions.prices && (missions.faults || missions.fault.is_some() || missions.outages) {
        return Err("`--prices` runs without faults: leave out `--fault`, `--faults` and `--outages`".to_owned());
    }
    Ok(missions)
}
