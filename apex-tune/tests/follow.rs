//! Journals that are read while they grow.

use apex_tune::{
    Axis, Fate, Follower, Found, Goal, Journal, Method, Objective, Parameter, Report, Scale, Seen, Study, Summary,
};
use std::{
    collections::BTreeMap,
    fs::{self, OpenOptions},
    io::Write as _,
    path::{Path, PathBuf},
    sync::Mutex,
};

/// Noisy valley. Remembers the values of its runs.
#[derive(Default)]
struct Valley {
    runs: Mutex<Vec<(Vec<f64>, u64, f64)>>,
}

impl Objective for Valley {
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
        let noise = (seed.wrapping_mul(0x9e37_79b9) % 1000) as f64 / 1000.0;
        let (x, y) = (values[0] - 2.0 - 0.4 * noise, values[1].ln() - 1.0);
        let cost = if values[0] < -5.0 { f64::NAN } else { 0.1 * noise + x * x + 3.0 * (y - x) * (y - x) };
        self.runs.lock().expect("no panic").push((values.to_vec(), seed, cost));
        Ok(vec![cost, values[0] - noise])
    }
}

fn study(method: Method, goals: usize) -> Study {
    let parameter = |name: &str, low, high, scale, default| {
        let axis = Axis::new(low, high, scale, false).expect("a range");
        Parameter {
            name: name.into(),
            unit: "m".into(),
            shown_in: None,
            axis,
            default,
            targets: vec![format!("a.b.{name}")],
            single: false,
        }
    };
    let goal = |name: &str, maximise, least| {
        let (name, unit, summary) = (name.to_owned(), String::new(), Summary::Quantile(0.9));
        Goal { name, unit, maximise, summary, least }
    };
    Study {
        name: "Valley".to_owned(),
        objective: u64::MAX,
        parameters: vec![
            parameter("x", -10.0, 10.0, Scale::Linear, 0.1 + 0.2),
            parameter("y", 0.01, 100.0, Scale::Logarithmic, 1.0 / 3.0),
        ],
        method,
        goals: [goal("cost", false, f64::NEG_INFINITY), goal("far", true, f64::NEG_INFINITY)]
            .into_iter()
            .take(goals)
            .collect(),
        seeds: (0..16).collect(),
        held_out: (100..116).collect(),
        searches: 2,
        candidates: 100,
        seed: 5,
        racing: true,
    }
}

fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A line of a journal, with its checksum.
fn checked(line: &str) -> String {
    format!("{line},{:08x}\n", crc32fast::hash(line.as_bytes()))
}

/// Runs a study up to its report. Returns the text of its journal.
fn run(study: &Study, file: &Path, objective: &Valley) -> (String, Vec<Found>) {
    let mut journal = Journal::open(file, study).expect("a new journal");
    let found = study.run(objective, &mut journal, (0, 1), &mut |_| ()).expect("a study");
    Report::new(study, found.clone(), objective, &mut journal).expect("scores").expect("a result");
    (fs::read_to_string(file).expect("the journal"), found)
}

/// Reads all that is there.
fn read(follower: &mut Follower) {
    while follower.read().expect("a journal") {}
}

fn append(file: &Path, text: &[u8]) {
    OpenOptions::new().append(true).open(file).and_then(|mut file| file.write_all(text)).expect("the journal");
}

/// Checks that each run of a candidate is one that the objective has seen, with these values.
fn check_runs(seen: &Seen, objective: &Valley) {
    let runs = objective.runs.lock().expect("no panic");
    let ran: BTreeMap<(String, u64), f64> =
        runs.iter().map(|(v, seed, cost)| ((format!("{v:?}"), *seed), *cost)).collect();
    for (search, trail) in seen.trails() {
        for (number, candidate) in trail.candidates().iter().enumerate() {
            let costs: Vec<_> = seen.costs(search, number as u64).collect();
            for (seed, costs) in seen.study().seeds.iter().zip(&costs) {
                let Some(costs) = costs else { continue };
                let cost = ran.get(&(format!("{:?}", candidate.values), *seed)).expect("a run with these values");
                assert!(costs[0] == *cost || cost.is_nan() && costs[0] == f64::INFINITY);
            }
            assert_eq!(costs.iter().flatten().count(), candidate.runs);
            match candidate.fate {
                Fate::Running => assert!(number >= trail.ended() && candidate.runs < costs.len()),
                Fate::Complete => assert_eq!(candidate.runs, costs.len()),
                Fate::Stopped => assert!(number < trail.ended() && candidate.runs < costs.len()),
                Fate::Failed => assert!(costs.iter().flatten().any(|costs| costs[0] == f64::INFINITY)),
            }
        }
    }
}

#[test]
fn a_growing_journal_shows_the_values_that_were_run() {
    for (method, goals) in [(Method::DifferentialEvolution, 1), (Method::CmaEs, 1), (Method::CmaEs, 2)] {
        let (study, objective) = (study(method, goals), Valley::default());
        let folder = folder(&format!("follow-{method:?}-{goals}"));
        let (text, found) = run(&study, &folder.join("whole"), &objective);
        let file = folder.join("part");
        fs::write(&file, "").expect("a file");
        let mut follower = Follower::new(file.clone());
        // Cut in the middle of lines.
        for part in text.as_bytes().chunks(text.len() / 7 + 3) {
            append(&file, part);
            read(&mut follower);
            check_runs(follower.seen().expect("the first part has the description"), &objective);
        }
        let seen = follower.seen().expect("a study");
        assert_eq!(seen.study(), &study);
        assert!(seen.is_finished() && seen.trails().all(|(_, trail)| trail.ended() == 100));
        assert!(seen.trails().map(|(_, trail)| trail.found()).eq(&found));
        assert_eq!(seen.runs(), found.iter().map(|found| found.runs).sum::<u64>());
        let report = seen.report().expect("a result");
        let (search, best) = seen.best().expect("a best one");
        let candidate = &seen.trail(search).expect("a search").candidates()[best];
        assert_eq!(candidate.values, report.values());
        assert_eq!(seen.defaults().as_ref(), Some(&report.defaults.training));
        let (low, high) = seen.range(0).expect("runs");
        assert!(low < high && seen.failed_runs() > 0);
    }
}

#[test]
fn parts_and_other_journals_are_followed() {
    let (study, objective, folder) = (study(Method::CmaEs, 2), Valley::default(), folder("follow-part"));
    let file = folder.join("journal");
    let mut follower = Follower::new(file.clone());
    assert!(follower.read().is_err_and(|error| error.to_string().contains("journal")));
    let mut journal = Journal::open(&file, &study).expect("a new journal");
    study.run(&objective, &mut journal, (1, 2), &mut |_| ()).expect("a part");
    read(&mut follower);
    let seen = follower.seen().expect("a study");
    assert!(seen.trails().map(|(number, _)| number).eq([1]) && !seen.is_finished());
    check_runs(seen, &objective);
    // Another study takes its place.
    let (before, other) = (follower.state().1, Study { name: "Other".to_owned(), ..study });
    fs::write(&file, other.description() + "\n").expect("a file");
    read(&mut follower);
    assert_eq!(follower.seen().map(|seen| seen.study().name.as_str()), Some("Other"));
    assert!(follower.state() == (1, before + 1));
}

#[test]
fn journals_that_cannot_be_read_are_reported() {
    let (study, folder) = (study(Method::DifferentialEvolution, 1), folder("follow-wrong"));
    let head = study.description() + "\n";
    let many = Study { seeds: (0..20_000).collect(), ..study.clone() }.description() + "\n";
    let long = "1".repeat(2 << 20);
    let run = [head.as_bytes(), checked("0,0,0,1.5").as_bytes()].concat();
    let with = |line: &[u8]| [&run, line].concat();
    let changed = checked("0,0,1,1.5").replace("1.5", "1.6");
    for (text, message) in [
        ("nonsense\n".as_bytes(), "journal:1: the study of the journal cannot be shown: it does not describe a study"),
        (head.replace("\"apex\":\"", "\"apex\":\"9.").as_bytes(), "its candidates may differ"),
        (head.replace("\"high\":10.0", "\"high\":-11.0").as_bytes(), "`x`: cannot search -10..=-11"),
        (head.replace("a.b.x", "a]\\nb.x").as_bytes(), "is not the name of a parameter"),
        (head.replace("\"goals\":[", "\"goals\":[],\"other\":[").as_bytes(), "unknown field `other`"),
        (many.as_bytes(), "it has 20016 seeds, and at most 10000 are shown"),
        (&with(b"0,1\n"), "journal:3: not a run"),
        (&with(b"0,0,1,1.5\n"), "journal:3: not a run"),
        (&with(b"\xff\xfe\n"), "journal:3: not a run"),
        (&with(changed.as_bytes()), "journal:3: not a run"),
        (&with(checked("0,0,1,1.5,2.5").as_bytes()), "journal:3: not a run"),
        (head.replace("\"journal\":2,", "").as_bytes(), "its lines have another form"),
        ([head.as_bytes(), long.as_bytes()].concat().as_slice(), "journal:2: not a run"),
        (b"\0\0\0\n", "does not describe a study"),
    ] {
        let file = folder.join("journal");
        fs::write(&file, text).expect("a file");
        let mut follower = Follower::new(file);
        let error = loop {
            match follower.read() {
                Ok(true) => {}
                Ok(false) => panic!("no error: {message}"),
                Err(error) => break error.to_string(),
            }
        };
        assert!(error.contains(message), "{error}");
        // The error stays, and so does all before it.
        assert!(follower.read().is_err_and(|again| again.to_string() == error));
        assert_eq!(follower.seen().map_or(0, Seen::runs), u64::from(message.contains(":3:")));
    }
    assert!(Follower::new(folder).read().is_err_and(|error| error.to_string().contains("not a file")));
}

#[test]
fn a_description_is_read_bit_by_bit_and_gives_a_file_with_parameters() {
    let study = study(Method::CmaEs, 2);
    assert_eq!(Study::from_description(&study.description()).as_ref(), Ok(&study));
    assert_eq!(study.params(&[0.1 + 0.2, 1e-7]), "[a.b]\nx = 0.30000000000000004\ny = 1e-7\n");
}

#[test]
fn a_journal_that_is_too_long_is_shown_in_part() {
    let (study, folder) = (study(Method::DifferentialEvolution, 1), folder("follow-long"));
    let file = folder.join("journal");
    fs::write(&file, study.description() + "\n").expect("a file");
    let zeros = "0".repeat(1_000_000);
    (0..80).for_each(|candidate| append(&file, checked(&format!("0,{candidate},0,0.{zeros}1")).as_bytes()));
    let mut follower = Follower::new(file);
    let error = loop {
        match follower.read() {
            Ok(has_read) => assert!(has_read, "the end was reached"),
            Err(error) => break error.to_string(),
        }
    };
    assert!(error.contains("the journal is too long: only its first 64 MB are shown"), "{error}");
    assert_eq!(follower.seen().map_or(0, Seen::runs), 67);
}
