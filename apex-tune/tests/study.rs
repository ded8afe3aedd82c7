//! Studies of a function with noise by seed.

use apex_optim::{Axis, Scale};
use apex_tune::{Found, Goal, Journal, Method, Objective, Parameter, Report, Shown, Study, Summary};
use std::{
    fs,
    path::PathBuf,
    sync::atomic::{AtomicU64, Ordering},
};

/// Noisy valley. Counts its runs.
#[derive(Default)]
struct Valley {
    runs: AtomicU64,
}

impl Objective for Valley {
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
        self.runs.fetch_add(1, Ordering::Relaxed);
        let noise = |k: u64| (seed.wrapping_mul(0x9e37_79b9).wrapping_add(k * 7919) % 1000) as f64 / 1000.0;
        let (x, y) = (values[0] - 2.0 - 0.4 * noise(1), values[1].ln() - 1.0 - 0.4 * noise(2));
        let cost = 0.1 * noise(3) + x * x + 3.0 * (y - x) * (y - x);
        Ok(vec![if values[0] < -9.0 { f64::NAN } else { cost }, values[0] - noise(4)])
    }
}

fn goal(name: &str, summary: Summary) -> Goal {
    Goal { name: name.to_owned(), unit: String::new(), maximise: false, summary, least: 0.0 }
}

fn study(method: Method, summary: Summary) -> Study {
    let parameter = |name: &str, low, high, scale, default| {
        let axis = Axis::new(low, high, scale, false).expect("a range");
        Parameter {
            name: name.to_owned(),
            unit: "m".to_owned(),
            shown_in: None,
            axis,
            default,
            targets: vec![format!("node.{name}")],
            single: false,
        }
    };
    Study {
        name: "Valley".to_owned(),
        objective: 0,
        parameters: vec![
            parameter("x", -10.0, 10.0, Scale::Linear, 5.0),
            parameter("y", 0.01, 100.0, Scale::Logarithmic, 1.0),
        ],
        method,
        goals: vec![goal("cost", summary)],
        seeds: (0..32).collect(),
        held_out: (100..132).collect(),
        searches: 2,
        candidates: 300,
        seed: 5,
        racing: true,
    }
}

fn run(study: &Study, threads: usize, journal: &mut Journal, part: (u64, u64)) -> (Vec<Found>, u64) {
    let objective = Valley::default();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let found = pool.install(|| study.run(&objective, journal, part, &mut |_| ())).expect("a study");
    (found, objective.runs.into_inner())
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

#[test]
fn racing_saves_runs_and_does_not_change_the_result() {
    for method in [Method::DifferentialEvolution, Method::CmaEs] {
        for summary in [Summary::Mean, Summary::Quantile(0.5), Summary::Quantile(0.9)] {
            let raced = study(method, summary);
            let complete = Study { racing: false, ..raced.clone() };
            let (with, runs) = run(&raced, 2, &mut Journal::in_memory(), (0, 1));
            let (without, all) = run(&complete, 2, &mut Journal::in_memory(), (0, 1));
            println!("{method:?}, {summary:?}: {runs} of {all} runs");
            for (a, b) in with.iter().zip(&without) {
                assert_eq!((&a.best, &a.improvements), (&b.best, &b.improvements));
            }
            assert!(runs < all, "{runs} of {all}");
        }
    }
}

#[test]
fn threads_do_not_change_the_result() {
    for method in [Method::DifferentialEvolution, Method::CmaEs] {
        let study = study(method, Summary::Quantile(0.8));
        let results = [1, 2, 5].map(|threads| run(&study, threads, &mut Journal::in_memory(), (0, 1)));
        assert!(results[0] == results[1] && results[1] == results[2]);
    }
}

#[test]
fn an_interrupted_study_loses_nothing() {
    let (folder, study) = (folder("resumed"), study(Method::DifferentialEvolution, Summary::Mean));
    let file = folder.join("journal");
    let mut journal = Journal::open(&file, &study).expect("a new journal");
    let (whole, runs) = run(&study, 2, &mut journal, (0, 1));
    let text = fs::read_to_string(&file).expect("the journal");
    // Interrupted in the middle of a line.
    fs::write(&file, &text[..text.len() / 3]).expect("a part of the journal");
    let mut journal = Journal::open(&file, &study).expect("the part");
    let before = journal.len() as u64;
    let (resumed, rest) = run(&study, 2, &mut journal, (0, 1));
    assert!(before > 0 && before + rest == runs && resumed == whole, "{before} and {rest} of {runs} runs");
    let error = Journal::open(&file, &Study { seed: 6, ..study }).expect_err("another study");
    assert!(error.to_string().contains("other settings"), "{error}");
}

#[test]
fn parts_are_merged_to_the_same_result() {
    let (folder, study) = (folder("merged"), study(Method::CmaEs, Summary::Mean));
    let (whole, runs) = run(&study, 2, &mut Journal::in_memory(), (0, 1));
    let files = [0, 1].map(|part| folder.join(part.to_string()));
    for (part, file) in files.iter().enumerate() {
        let mut journal = Journal::open(file, &study).expect("a new journal");
        run(&study, 1, &mut journal, (part as u64, 2));
    }
    let mut journal = Journal::merge(&files, &study).expect("both parts");
    assert_eq!(journal.len() as u64, runs);
    assert_eq!(run(&study, 2, &mut journal, (0, 1)), (whole, 0));
}

#[test]
fn a_report_compares_with_the_defaults_on_seeds_held_out() {
    let study = study(Method::CmaEs, Summary::Mean);
    let (found, _) = run(&study, 2, &mut Journal::in_memory(), (0, 1));
    let mut journal = Journal::in_memory();
    let report =
        Report::new(&study, found.clone(), &Valley::default(), &mut journal).expect("scores").expect("a result");
    assert!(report.is_better() && report.tuned.held_out < report.defaults.held_out);
    assert!(report.importance.iter().all(|lost| *lost > 0.0) && report.warning().is_none());
    let folder = folder("report");
    report.write(&folder).expect("a report");
    let text = fs::read_to_string(folder.join("report.md")).expect("the report");
    assert!(text.contains("| `x` [m] | 5 |") && !text.contains("Warning"), "{text}");
    let picture = fs::read_to_string(folder.join("convergence.svg")).expect("a picture");
    assert!(picture.contains("<polyline") && picture.contains("candidates"));
    let unseen = Study { held_out: Vec::new(), ..study };
    let report = Report::new(&unseen, found, &Valley::default(), &mut journal).expect("scores").expect("a result");
    assert!(report.markdown().contains("**Warning:** nothing is held out"));
}

#[test]
fn a_result_that_fails_on_other_seeds_is_a_warning() {
    /// Cost that is lower at 5 for some seeds only.
    struct Lucky;
    impl Objective for Lucky {
        fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
            Ok(vec![1.0 + (if seed < 100 { values[0] + 10.0 } else { 10.0 - values[0] }) / 20.0])
        }
    }
    let study = study(Method::DifferentialEvolution, Summary::Mean);
    let found = study.run(&Lucky, &mut Journal::in_memory(), (0, 1), &mut |_| ()).expect("a study");
    let report = Report::new(&study, found, &Lucky, &mut Journal::in_memory()).expect("scores").expect("a result");
    assert!(report.warning().is_some_and(|text| text.contains("held out")), "{report:?}");
}

#[test]
fn several_goals_have_a_front() {
    let far = Goal { maximise: true, least: f64::NEG_INFINITY, ..goal("far", Summary::Quantile(0.9)) };
    let near = goal("cost", Summary::Quantile(0.9));
    let study = Study { goals: vec![near, far], searches: 5, ..study(Method::DifferentialEvolution, Summary::Mean) };
    let objective = Valley::default();
    let mut journal = Journal::in_memory();
    let found = study.run(&objective, &mut journal, (0, 1), &mut |_| ()).expect("a study");
    let raced = found.iter().map(|f| f.saved).sum::<u64>();
    let all = Study { racing: false, ..study.clone() };
    let complete = all.run(&objective, &mut Journal::in_memory(), (0, 1), &mut |_| ()).expect("a study");
    assert!(raced > 0 && found.iter().zip(&complete).all(|(a, b)| a.best == b.best));
    let report = Report::new(&study, found, &objective, &mut journal).expect("scores").expect("a result");
    assert!(report.front.len() > 5 && report.is_better(), "{:?}", report.front);
    let is_front = report.front.windows(2).all(|w| w[0].costs[0] < w[1].costs[0] && w[0].costs[1] > w[1].costs[1]);
    assert!(is_front, "{:?}", report.front);
    let folder = folder("front");
    report.write(&folder).expect("a report");
    let text = fs::read_to_string(folder.join("report.md")).expect("the report");
    assert!(text.contains("maximise `far` at 90 %") && text.contains("| `cost` | `far` | `x` | `y` |"), "{text}");
    assert!(fs::read_to_string(folder.join("front.svg")).expect("a picture").contains("<circle"));
    // On several machines.
    let files = [0, 1, 2].map(|part| folder.join(part.to_string()));
    for (part, file) in files.iter().enumerate() {
        let mut journal = Journal::open(file, &study).expect("a new journal");
        study.run(&objective, &mut journal, (part as u64, 3), &mut |_| ()).expect("a part");
    }
    let mut merged = Journal::merge(&files, &study).expect("all parts");
    let found = study.run(&objective, &mut merged, (0, 1), &mut |_| ()).expect("the whole");
    let merged = Report::new(&study, found, &objective, &mut merged).expect("scores").expect("a result");
    assert_eq!(merged, report);
}

#[test]
fn the_report_has_the_units_of_the_declarations() {
    let mut study = study(Method::DifferentialEvolution, Summary::Mean);
    study.parameters[0].shown_in = Some(Shown { unit: "cm".to_owned(), size: 0.01 });
    let parameter = &study.parameters[0];
    let (name, default, high) = (&parameter.name, 100.0 * parameter.default, 100.0 * parameter.axis.high());
    let mut journal = Journal::in_memory();
    let (found, _) = run(&study, 1, &mut journal, (0, 1));
    let report = Report::new(&study, found, &Valley::default(), &mut journal).expect("a study").expect("a result");
    let tables = report.tables();
    let line = tables.lines().find(|line| line.starts_with(&format!("| `{name}` [cm] | {default} |")));
    assert!(line.is_some_and(|line| line.contains(&format!(" to {high}"))), "{tables}");
    // Programs get SI.
    assert_eq!(
        (&report.json()["parameters"][0]["unit"], &report.json()["parameters"][0]["default"]),
        (&"m".into(), &parameter.default.into())
    );
}
