//! `apex tune`: studies, in which a `tune` item finds good values of parameters.

mod result;
mod worker;

use crate::{Format, answer::Answer, build::How, project, replace, run, test};
use apex_dsl::{
    report::nearest,
    script::{Script, Study as Stated, Varied},
    source::Sources,
};
use apex_host::Workspace;
use apex_tune::{
    Axis, Found, Goal, Journal, Known, Lock, Method, Parameter, Progress, Report, Scale, Shown, Study, StudyError,
    Summary, Timed,
};
use std::{
    fs,
    io::{self, IsTerminal as _, Write as _},
    path::{Path, PathBuf},
    process::{self, ExitCode},
    time::{Duration, Instant},
};
use worker::{Workers, scenario};

/// Ratio of the bounds of a range from which on it is searched on a logarithmic scale.
const LOGARITHMIC: f64 = 100.0;

/// A study to run.
#[derive(clap::Args)]
pub struct Wanted {
    /// Source file.
    file: PathBuf,
    /// Name of the `tune` item, if the file has several.
    name: Option<String>,
    /// Method of the search: differential evolution, or CMA-ES for parameters that depend on each other.
    #[arg(long, value_enum, default_value_t = Search::De)]
    method: Search,
    /// Number of candidates of each search.
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u64).range(1..))]
    candidates: u64,
    /// Number of independent searches; by default 1, or with several goals two more than twice their number.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    searches: Option<u64>,
    /// Seed of the search. The same seed gives the same result, on any number of cores.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Number of processes that run candidates; by default one for each core.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    jobs: Option<u64>,
    /// Folder of the journal and the report; by default `apex/tune/NAME` in the target folder of the package.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Continue the study in the folder; without it, a folder with a journal is left unchanged.
    #[arg(long)]
    resume: bool,
    /// Run only part K of N of the searches, whose journals are merged later.
    #[arg(long, value_name = "K/N", value_parser = shard, conflicts_with_all = ["write", "params"])]
    shard: Option<(u64, u64)>,
    /// Merge the journals of all parts, in these folders, instead of searching.
    #[arg(long, value_name = "FOLDER", conflicts_with_all = ["shard", "resume"])]
    merge: Vec<PathBuf>,
    /// Write the tuned values to this file (TOML), for `apex run --params`.
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// Write the tuned values into the source file.
    #[arg(long)]
    write: bool,
    /// Build without optimisations, which takes less time: for a few short runs.
    #[arg(long)]
    debug: bool,
    /// Format of the result.
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// Print only errors and the result.
    #[arg(short, long)]
    quiet: bool,
}

/// Method of a search.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Search {
    /// Differential evolution.
    De,
    /// CMA-ES with restarts.
    Cma,
}

/// Part of a study, counted from 1, and their number.
fn shard(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    parts
        .filter(|(k, n)| (1..=*n).contains(k))
        .ok_or_else(|| "expected a part and the number of parts: `1/4`".to_owned())
}

/// Checks, builds, searches and reports.
pub fn run(wanted: &Wanted, answer: &mut Answer) -> Result<ExitCode, String> {
    let checked = project::check(&wanted.file)?;
    answer.messages(&checked.diagnostics, &checked.sources);
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let scripts = checked.programs.iter().flat_map(|p| &p.scripts);
    let studies = scripts.filter_map(|script| Some((script, script.study.as_ref()?))).collect::<Vec<_>>();
    let (script, stated) = chosen(&studies, wanted)?;
    let folder = run::package(&wanted.file)?;
    let workspace = Workspace::load(&folder)?;
    let output = wanted.output.clone().unwrap_or_else(|| default_folder(&workspace, &script.name));
    wanted.look(&output)?;
    fs::create_dir_all(&output).map_err(|e| format!("cannot write in `{}`: {e}", output.display()))?;
    let _lock = Lock::of(&output)?;
    if wanted.write {
        result::look(&checked, script, stated)?;
    }
    let how = How::new(!wanted.debug, wanted.quiet);
    let Some(test::Found { built, names, turn }) = test::built(&wanted.file, &checked, &[&script.name], how)? else {
        return answer.not_built();
    };
    let goals = stated.goals.iter().map(|goal| goal.name.as_str()).collect();
    let test = names.into_iter().next().ok_or("the program has no such study")?;
    let (workers, defaults) = Workers::start(built, test, &folder, goals)?;
    drop(turn);
    let study = study(wanted, script, stated, &defaults, fingerprint(&checked.sources))?;
    let run = Run { wanted, script, study: &study, output, workers: &workers };
    let threads = wanted.jobs.unwrap_or(0) as usize;
    let Some(report) = apex_tune::on_threads(threads, || run.report(answer.is_json()))?? else {
        return Ok(if wanted.shard.is_some() { ExitCode::SUCCESS } else { ExitCode::from(1) });
    };
    if answer.is_json() {
        answer.give(String::new, || report.json())?;
    }
    let is_better = report.is_better();
    if let Some(file) = &wanted.params {
        replace::write(file, &study.params(report.values()))?;
    }
    if wanted.write && is_better {
        let numbers: Vec<String> = study.parameters.iter().zip(report.values()).map(|(p, v)| p.number(*v)).collect();
        result::write(&checked, script, stated, &numbers, &wanted.file)?;
    }
    Ok(if is_better { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Folder of the study of a `tune` item, unless another one is wanted.
pub fn default_folder(workspace: &Workspace, name: &str) -> PathBuf {
    workspace.cache_folder().join("tune").join(name)
}

/// The study with the name that is wanted, or else the only one.
fn chosen<'a>(studies: &[(&'a Script, &'a Stated)], wanted: &Wanted) -> Result<(&'a Script, &'a Stated), String> {
    let names = || studies.iter().map(|(script, _)| script.name.as_str());
    let list = || names().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (studies, &wanted.name) {
        ([], _) => Err(format!(
            "`{}` has no `tune` item: write one, as `apex explain wrong-study` shows",
            wanted.file.display()
        )),
        (_, Some(name)) => {
            studies.iter().find(|(script, _)| script.name == *name).copied().ok_or_else(|| {
                match nearest(name, names()) {
                    Some(near) => format!("there is no `tune` item `{name}`; did you mean `{near}`?"),
                    None => format!("there is no `tune` item `{name}`; there are {}", list()),
                }
            })
        }
        ([only], None) => Ok(*only),
        (_, None) => Err(format!("there are several `tune` items: write the name of one behind the file: {}", list())),
    }
}

impl Wanted {
    /// Reports problems with files before the build.
    fn look(&self, output: &Path) -> Result<(), String> {
        let journal = output.join(Journal::FILE);
        if self.merge.is_empty() && !self.resume && journal.exists() {
            return Err(format!(
                "`{}` has the journal of an earlier study: continue it with `--resume`, choose another folder with `--output`, or remove the journal",
                output.display()
            ));
        }
        if self.resume && !journal.exists() {
            return Err(format!("there is nothing to resume: `{}` has no journal", output.display()));
        }
        if let Some(missing) = self.merge.iter().find(|folder| !folder.join(Journal::FILE).is_file()) {
            return Err(format!("`{}` has no journal to be merged", missing.display()));
        }
        if let Some(file) = &self.params {
            run::has_folder(file).map_err(|e| format!("cannot write `{}`: {e}", file.display()))?;
        }
        if output.is_file() {
            return Err(format!("`{}` is a file: choose a folder with `--output`", output.display()));
        }
        Ok(())
    }
}

/// The study with its numbers.
fn study(wanted: &Wanted, script: &Script, stated: &Stated, defaults: &[f64], objective: u64) -> Result<Study, String> {
    let parameter = |(varied, default): (&Varied, &f64)| {
        if default.is_nan() {
            return Err(format!("`{}` has a type whose values cannot be set", varied.name));
        }
        let wide = varied.low > 0.0 && varied.high / varied.low >= LOGARITHMIC;
        let scale = if wide { Scale::Logarithmic } else { Scale::Linear };
        let axis = Axis::new(varied.low, varied.high, scale, varied.integer);
        let axis = axis.map_err(|error| format!("`{}`: {error}", varied.name))?;
        Ok(Parameter {
            name: varied.name.clone(),
            unit: varied.unit.clone().unwrap_or_default(),
            shown_in: varied.declared.clone().map(|(unit, size)| Shown { unit, size }),
            axis,
            default: *default,
            targets: varied.targets.clone(),
            single: varied.single,
        })
    };
    let goals = stated.goals.iter().map(|goal| Goal {
        name: goal.name.clone(),
        unit: goal.unit.clone().unwrap_or_default(),
        maximise: goal.maximise,
        summary: Summary::Quantile(goal.share),
        least: f64::NEG_INFINITY,
    });
    let searches = match stated.goals.len() {
        1 => 1,
        several => 2 * several as u64 + 2,
    };
    let others =
        (1..=stated.recordings.len()).flat_map(|recording| (0..stated.seeds).map(move |s| scenario(recording, s)));
    let held_out = (stated.seeds..stated.seeds + stated.held_out).chain(others).collect();
    Ok(Study {
        name: script.name.clone(),
        objective,
        parameters: stated.vary.iter().zip(defaults).map(parameter).collect::<Result<_, _>>()?,
        method: if wanted.method == Search::De { Method::DifferentialEvolution } else { Method::CmaEs },
        goals: goals.collect(),
        seeds: (0..stated.seeds).collect(),
        held_out,
        searches: wanted.searches.unwrap_or(searches),
        candidates: wanted.candidates,
        seed: wanted.seed,
        racing: true,
    })
}

/// Number that another content of the texts changes (FNV-1a).
fn fingerprint(sources: &Sources) -> u64 {
    let bytes = sources.iter().flat_map(|source| source.text.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A study that runs.
struct Run<'a> {
    wanted: &'a Wanted,
    script: &'a Script,
    study: &'a Study,
    output: PathBuf,
    workers: &'a Workers<'a>,
}

impl Run<'_> {
    /// Searches, prints and writes the report; `None` for a part of a study, and if all candidates have failed.
    fn report(&self, is_json: bool) -> Result<Option<Report>, String> {
        let told = |error: StudyError| error.to_string();
        let ((k, n), searches) = (self.wanted.shard.unwrap_or((1, 1)), self.study.searches);
        if n > searches {
            return Err(format!(
                "a study of {searches} searches has no {n} parts: give all of them `--searches {n}`, or more"
            ));
        }
        let timed = Timed::new(self.workers);
        let (found, mut journal) = if self.wanted.merge.is_empty() {
            let mut journal = Journal::open(&self.output.join(Journal::FILE), self.study).map_err(|e| e.to_string())?;
            warn_of_damage(&journal, "their runs are repeated");
            self.begin(&journal)?;
            let found = self.search(&timed, &mut journal, (k - 1, n)).map_err(told)?;
            if n > 1 {
                let folder = self.output.display();
                if !is_json {
                    project::print(&format!("part {k} of {n}: {} searches are in `{folder}`", found.len()))?;
                }
                return Ok(None);
            }
            (found, journal)
        } else {
            let files: Vec<PathBuf> = self.wanted.merge.iter().map(|folder| folder.join(Journal::FILE)).collect();
            let mut journal = Journal::merge(&files, self.study).map_err(|e| e.to_string())?;
            warn_of_damage(&journal, "their runs are missing: repeat them with `--shard K/N --resume`");
            let found = self.study.run(&Known, &mut journal, (0, 1), &mut |_| ()).map_err(told)?;
            (found, journal)
        };
        let Some(report) = Report::new(self.study, found, &timed, &mut journal).map_err(told)? else {
            let why = self.workers.failure().map(|reason| format!(": {reason}")).unwrap_or_default();
            project::print_error(&format!("all candidates of `{}` failed{why}", self.script.name));
            return Ok(None);
        };
        report.write(&self.output).map_err(|e| format!("cannot write in `{}`: {e}", self.output.display()))?;
        if !is_json {
            project::print(report.tables().trim_end())?;
            let (cost, time, file) = (report.cost(), timed.cost(), self.output.join("report.md"));
            project::print(&format!("\n{cost}\n{time}\nreport: {}", file.display()))?;
        }
        if let Some(warning) = report.warning() {
            project::print_error(&format!("warning: {warning}"));
        }
        if !report.is_better() {
            project::print_error("no candidate is better than the defaults");
        }
        Ok(Some(report))
    }

    /// Returns `true` if the course of the study is shown: in a terminal.
    fn shows(&self) -> bool {
        !self.wanted.quiet && io::stderr().is_terminal()
    }

    /// Prints what is about to run, and prepares Ctrl-C.
    fn begin(&self, journal: &Journal) -> Result<(), String> {
        let Study { searches, candidates, parameters, goals, seeds, .. } = self.study;
        let shows = self.shows();
        if shows {
            let (name, known) = (&self.script.name, journal.len());
            let known = if known > 0 { format!("; {known} runs are known") } else { String::new() };
            let (p, g, s) = (
                project::counted(parameters.len(), "parameter"),
                project::counted(goals.len(), "goal"),
                project::counted(seeds.len(), "seed"),
            );
            project::print_error(&format!("`{name}`: {p}, {g}, {s}, {searches} × {candidates} candidates{known}"));
            project::print_error(&format!("`apex studio {}` shows it", self.output.display()));
        }
        // The journal is complete at all times.
        let stop = move || {
            if shows {
                project::print_error("\nstopped; `--resume` continues");
            }
            process::exit(130);
        };
        ctrlc::set_handler(stop).map_err(|e| format!("cannot handle Ctrl-C: {e}"))
    }

    fn search(
        &self,
        timed: &Timed<'_>,
        journal: &mut Journal,
        (part, parts): (u64, u64),
    ) -> Result<Vec<Found>, StudyError> {
        let shows = self.shows();
        let mine = (0..self.study.searches).filter(|search| search % parts == part).count() as u64;
        let (start, total) = (Instant::now(), mine * self.study.candidates);
        let found = self.study.run(timed, journal, (part, parts), &mut |progress| {
            if shows {
                let done = progress.search / parts * self.study.candidates + progress.candidates;
                let left = start.elapsed().mul_f64((total - done) as f64 / done as f64);
                self.show(progress, done, total, left);
            }
        });
        if shows {
            eprintln!();
        }
        found
    }

    fn show(&self, progress: &Progress, done: u64, total: u64, left: Duration) {
        let best = match (&progress.best, self.study.goals.as_slice()) {
            (None, _) => "none has passed yet".to_owned(),
            (Some(best), [goal]) => {
                let value = if goal.maximise { -best.fitness } else { best.fitness };
                format!("best {value:.6} {}", goal.unit)
            }
            // The change from the defaults in the goal that has improved least.
            (Some(best), _) => format!("best {:+.2} %", 100.0 * best.fitness),
        };
        let seconds = left.as_secs();
        let left = if seconds >= 100 { format!("{} min", seconds.div_ceil(60)) } else { format!("{seconds} s") };
        eprint!("\r\x1b[2K{done} of {total} candidates; {best}; {left} left");
        let _ = io::stderr().flush();
    }
}

/// Maximum number of damaged lines that are named.
const MAX_NAMED: usize = 10;

/// Prints the lines of a journal that are damaged.
fn warn_of_damage(journal: &Journal, what: &str) {
    let damaged = journal.damaged();
    let named = damaged.iter().take(MAX_NAMED).map(|(path, line)| format!("{}:{line}", path.display()));
    let named: Vec<String> = named.collect();
    if !named.is_empty() {
        let more =
            if damaged.len() > MAX_NAMED { format!(" and {} more", damaged.len() - MAX_NAMED) } else { String::new() };
        project::print_error(&format!(
            "warning: lines of the journal are damaged, and {what}: {}{more}",
            named.join(", ")
        ));
    }
}
