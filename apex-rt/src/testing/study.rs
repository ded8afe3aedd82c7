//! Studies: a process that runs a script again and again, with other values of parameters.
//!
//! `apex tune` starts the process with the environment variable `APEX_STUDY`. Each line of standard input is a run, and
//! is answered by a line of standard output that begins with [`ANSWER`].

use crate::{
    Parameters, Program,
    params::{Access, ParamInfo, ParamRef, ParamVisitor},
};
use core::{any::Any, cell::RefCell, fmt::Write as _};
use std::{
    collections::HashMap,
    env,
    io::{self, BufRead as _, Write as _},
    panic,
    rc::Rc,
};

/// Beginning of the lines that answer. Other lines are those of nodes and of the test harness.
const ANSWER: &str = "apex-study:";
/// Environment variable of the process.
const ASKED: &str = "APEX_STUDY";

/// Constants of a study.
#[derive(Debug)]
pub struct Study {
    /// Parameters that are searched, each with the names under which the program has them; `true` for integers.
    pub vary: &'static [(&'static [&'static str], bool)],
    /// Parameters to which the seed of a run is added.
    pub seeds: &'static [&'static str],
    /// Recordings that stand for those of the script, by number, from 1.
    pub recordings: &'static [&'static str],
    /// Tests that must pass.
    pub required: &'static [(&'static str, fn())],
}

/// One run.
struct Trial {
    study: &'static Study,
    values: Vec<f64>,
    seed: u64,
    /// Number of the recording, or 0 for those of the script.
    recording: usize,
    /// `true` to run the tests, too.
    tests: bool,
}

/// Recordings that have been read, by file and channel.
type Recorded = HashMap<(&'static str, &'static str), Rc<dyn Any>>;

std::thread_local! {
    static TRIAL: RefCell<Option<Trial>> = const { RefCell::new(None) };
    static RECORDED: RefCell<Recorded> = RefCell::new(HashMap::new());
}

/// Sets the parameters that `visit` passes on to the values of the present run, if there is one.
///
/// # Panics
/// A parameter refuses its value.
pub(super) fn set(visit: &mut dyn FnMut(&mut dyn ParamVisitor)) {
    TRIAL.with_borrow(|trial| {
        let Some(trial) = trial else { return };
        let mut setter = Setter { trial, refused: None };
        visit(&mut setter);
        if let Some(refused) = setter.refused {
            panic!("{refused}");
        }
    });
}

struct Setter<'a> {
    trial: &'a Trial,
    refused: Option<String>,
}

impl ParamVisitor for Setter<'_> {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let Some(access) = access else { return };
        let study = self.trial.study;
        let varied = study.vary.iter().zip(&self.trial.values).find(|((names, _), _)| names.contains(&info.name));
        let value = match varied {
            Some(((_, true), value)) => ParamRef::Integer(*value as i128),
            Some((_, value)) => ParamRef::Float(*value),
            None if study.seeds.contains(&info.name) => match access.get() {
                ParamRef::Integer(first) => ParamRef::Integer(first + i128::from(self.trial.seed)),
                _ => return,
            },
            None => return,
        };
        if access.set(value).is_err() {
            self.refused = Some(format!("`{}` refuses {value}", info.name));
        }
    }
}

/// Reader of the values that the text gives.
struct Defaults {
    study: &'static Study,
    values: Vec<f64>,
}

impl ParamVisitor for Defaults {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let number = self.study.vary.iter().position(|(names, _)| names.first() == Some(&info.name));
        if let (Some(number), Some(access)) = (number, access) {
            self.values[number] = match access.get() {
                ParamRef::Integer(value) => value as f64,
                ParamRef::Float(value) => value,
                ParamRef::Single(value) => f64::from(value),
                _ => f64::NAN,
            };
        }
    }
}

/// Returns the tokens of a channel of `file`, or of the recording that stands for it in the present run. `tokens` gives
/// those of a file; their clones know what was read in the runs before.
pub fn recorded<T: Clone + 'static>(file: &'static str, channel: &'static str, tokens: impl FnOnce(&str) -> T) -> T {
    let other = TRIAL.with_borrow(|trial| {
        let trial = trial.as_ref()?;
        trial.study.recordings.get(trial.recording.checked_sub(1)?).copied()
    });
    let file = other.unwrap_or(file);
    RECORDED.with_borrow_mut(|all| {
        let known = all.get(&(file, channel)).and_then(|known| known.downcast_ref::<T>());
        known.cloned().unwrap_or_else(|| {
            let tokens = tokens(file);
            all.insert((file, channel), Rc::new(tokens.clone()));
            tokens
        })
    })
}

/// Serves runs until standard input ends: `seed recording tests value …`, answered by `ok goal …` or `failed reason`.
/// The first line has the values in the text. `run` executes the script of `program`, and returns the goals.
///
/// # Panics
/// The process was not started by `apex tune`.
pub fn serve<P: Program + Parameters>(study: &'static Study, program: fn() -> P, run: fn() -> Vec<f64>) {
    assert!(env::var_os(ASKED).is_some(), "this is a study: run it with `apex tune`");
    // A run that fails says so in its answer.
    panic::set_hook(Box::new(|_| {}));
    let mut defaults = Defaults { study, values: vec![f64::NAN; study.vary.len()] };
    program().visit_params(&mut defaults);
    answer("\n", "ready", &defaults.values);
    for line in io::stdin().lock().lines().map_while(Result::ok) {
        let Some(trial) = asked(study, &line) else {
            answer("", "failed this is not a run", &[]);
            continue;
        };
        match panic::catch_unwind(|| goals(trial, run)) {
            Ok(goals) => answer("", "ok", &goals),
            Err(reason) => answer("", &format!("failed {}", told(&*reason)), &[]),
        }
    }
}

fn asked(study: &'static Study, line: &str) -> Option<Trial> {
    let mut words = line.split(' ');
    let (seed, recording) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
    let tests = words.next()? == "1";
    let values: Vec<f64> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
    (values.len() == study.vary.len()).then_some(Trial { study, values, seed, recording, tests })
}

fn goals(trial: Trial, run: fn() -> Vec<f64>) -> Vec<f64> {
    let (study, tests) = (trial.study, trial.tests);
    TRIAL.set(Some(trial));
    if tests {
        study.required.iter().for_each(|(_, test)| test());
    }
    run()
}

fn answer(before: &str, word: &str, values: &[f64]) {
    let mut line = format!("{before}{ANSWER} {word}");
    for value in values {
        // This form is read as the same number.
        let _ = write!(line, " {value:?}");
    }
    line.push('\n');
    let mut output = io::stdout().lock();
    let _ = output.write_all(line.as_bytes()).and_then(|()| output.flush());
}

/// The first line of the message of a panic.
fn told(reason: &(dyn Any + Send)) -> &str {
    let text = reason.downcast_ref::<String>().map(String::as_str).or_else(|| reason.downcast_ref::<&str>().copied());
    text.unwrap_or("it panicked").lines().next().unwrap_or_default()
}
