//! Searches on functions with known minima: `optimise [--first-seed N] [--seeds N] [--jobs N] [--functions FILE]`
//! prints for each function the share of searches that reach the minimum to 1e-8 within 10 000 evaluations per
//! dimension, the median evaluations of those that do, and the evaluations of all searches per success. FILE is a CSV
//! table; the first column has the names of the functions. `compare.py` prints the same table for
//! searches of other libraries.

mod functions;

use apex_optim::{Axis, CmaSearch, DeSearch, Scale, Search, Space};
use functions::{FUNCTIONS, Function};
use std::{
    fs,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

/// Error of the minimum at which a search has succeeded.
const ACCURACY: f64 = 1e-8;
/// Maximum evaluations per dimension.
const EVALUATIONS: u64 = 10_000;

/// Command line.
struct Settings {
    first_seed: u64,
    seeds: u64,
    jobs: usize,
    /// Names of the functions, if not all.
    names: Option<Vec<String>>,
}

fn main() {
    if let Err(error) = settings().map(|settings| run(&settings)) {
        eprintln!("error: {error}");
        std::process::exit(2);
    }
}

fn settings() -> Result<Settings, String> {
    let mut settings = Settings { first_seed: 1, seeds: 30, jobs: 1, names: None };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let value = arguments.next().ok_or_else(|| format!("`{name}` needs a value"))?;
        let number = || value.parse::<u64>().map_err(|_| format!("`{name} {value}`: not a number"));
        match name.as_str() {
            "--first-seed" => settings.first_seed = number()?,
            "--seeds" => settings.seeds = number()?,
            "--jobs" => settings.jobs = number()?.max(1) as usize,
            "--functions" => settings.names = Some(names(&value)?),
            _ => return Err(format!("unknown option `{name}`: use --first-seed, --seeds, --jobs or --functions")),
        }
    }
    Ok(settings)
}

/// First column of a table with a headline.
fn names(file: &str) -> Result<Vec<String>, String> {
    let text = fs::read_to_string(file).map_err(|e| format!("{file}: {e}"))?;
    let first = |line: &str| match line.strip_prefix('"') {
        Some(quoted) => quoted.split('"').next().unwrap_or_default().to_owned(),
        None => line.split(',').next().unwrap_or_default().to_owned(),
    };
    let names: Vec<String> = text.lines().skip(1).filter(|line| !line.is_empty()).map(first).collect();
    match names.iter().find(|name| FUNCTIONS.iter().all(|f| f.name != name.as_str())) {
        Some(name) => Err(format!("{file}: the function `{name}` is unknown")),
        None => Ok(names),
    }
}

fn run(settings: &Settings) {
    let chosen = |f: &&Function| settings.names.as_ref().is_none_or(|names| names.iter().any(|name| name == f.name));
    let functions: Vec<&Function> = FUNCTIONS.iter().filter(chosen).collect();
    let seeds = settings.first_seed..settings.first_seed.saturating_add(settings.seeds);
    let searches = |f| seeds.clone().flat_map(move |seed| [(f, false, seed), (f, true, seed)]);
    let work: Vec<(&Function, bool, u64)> = functions.iter().flat_map(|f| searches(*f)).collect();
    let results = on_threads(settings.jobs, &work);
    println!("seeds {seeds:?}; share of successes, median evaluations of a success, evaluations per success");
    println!("{:28}{:>3}{:>12}{:>8}{:>9}{:>14}{:>8}{:>9}", "function", "n", "DE", "", "", "CMA-ES", "", "");
    for function in functions {
        print!("{:28}{:3}", function.name, function.dimensions);
        for (with_cma, width) in [(false, 12), (true, 14)] {
            let of = |(w, _): &(&(&Function, bool, u64), &Option<u64>)| std::ptr::eq(w.0, function) && w.1 == with_cma;
            let results: Vec<Option<u64>> = work.iter().zip(&results).filter(of).map(|(_, r)| *r).collect();
            print!("{}", cells(function, &results, width));
        }
        println!();
    }
}

/// Cells of the table for the searches of one function.
fn cells(function: &Function, results: &[Option<u64>], width: usize) -> String {
    let mut hits: Vec<u64> = results.iter().copied().flatten().collect();
    hits.sort_unstable();
    let longest = EVALUATIONS * function.dimensions as u64;
    let all: u64 = hits.iter().sum::<u64>() + (results.len() - hits.len()) as u64 * longest;
    let text = |number: Option<u64>| number.map_or("-".to_owned(), |n| n.to_string());
    let median = text(hits.get(hits.len() / 2).copied());
    let each = text(all.checked_div(hits.len() as u64));
    format!("{:>width$}{median:>8}{each:>9}", format!("{}/{}", hits.len(), results.len()))
}

/// Result of each search, in the order of `work`.
fn on_threads(jobs: usize, work: &[(&Function, bool, u64)]) -> Vec<Option<u64>> {
    let results = Mutex::new(vec![None; work.len()]);
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                while let Some((number, (function, with_cma, seed))) = {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    work.get(number).map(|w| (number, w))
                } {
                    let result = if *with_cma {
                        evaluations(function, CmaSearch::new(space(function), *seed))
                    } else {
                        evaluations(function, DeSearch::new(space(function), *seed))
                    };
                    results.lock().expect("no thread panics")[number] = result;
                }
            });
        }
    });
    results.into_inner().expect("no thread panics")
}

fn space(function: &Function) -> Space {
    let bounds = |i: usize| function.bounds[i.min(function.bounds.len() - 1)];
    let axis = |[low, high]: [f64; 2]| Axis::new(low, high, Scale::Linear, false).expect("bounds of a function");
    Space::new((0..function.dimensions).map(|i| axis(bounds(i))).collect())
}

/// Number of evaluations until the minimum is found, or `None` if it is not.
fn evaluations(function: &Function, mut search: impl Search) -> Option<u64> {
    let (mut count, longest) = (0, EVALUATIONS * function.dimensions as u64);
    let mut fitness = Vec::new();
    while count < longest {
        fitness.clear();
        for candidate in search.ask() {
            let value = (function.value)(candidate);
            count += 1;
            if value - function.minimum <= ACCURACY {
                return Some(count);
            }
            fitness.push(value);
        }
        search.tell(&fitness);
    }
    None
}
