//! Nets without programs: their own runs are legal, falsified ones are not.

use apex_tests::{
    Dice,
    oracle::{Case, Checked, Checker, Record, generate, walk, with_timeouts},
};
use rayon::iter::{IntoParallelIterator as _, ParallelIterator as _};

/// The random graph of a seed, or `None` if it is not legal.
fn checked(checker: &Checker, seed: u64) -> Option<(Case, Checked)> {
    let case = generate(seed, true);
    let case = if seed.is_multiple_of(2) { case } else { with_timeouts(case) };
    let checked = checker.check(&case.text("Random")).ok()?;
    Some((case, checked))
}

#[test]
fn most_random_graphs_are_legal() {
    let checker = Checker::new();
    let mut reasons = std::collections::BTreeMap::<String, usize>::new();
    for seed in 0..100 {
        if let Err(reason) = checker.check(&generate(seed, true).text("Random")) {
            let code = reason.split(':').next().unwrap_or_default().to_owned();
            *reasons.entry(code).or_default() += 1;
            if std::env::var_os("APEX_ORACLE_SHOW").is_some() {
                println!("{seed}: {reason}");
            }
        }
    }
    println!("{reasons:?}");
    assert!(reasons.values().sum::<usize>() < 20, "{reasons:?}");
}

#[test]
fn runs_of_a_net_are_legal() {
    let checker = Checker::new();
    let (mut count, mut records) = (0, 0);
    for seed in 0..100 {
        let Some((case, checked)) = checked(&checker, seed) else { continue };
        let run = walk(&checker.catalog(), &checked, &mut Dice(seed | 1), 8);
        if let Err((step, why)) = checker.judge(&checked, &run) {
            panic!("seed {seed}: {why}\n{}\n{:?}", case.text("Random"), &run[..=step]);
        }
        count += 1;
        records += run.iter().filter(|r| matches!(r, Record::Fired(_) | Record::Handled(_))).count();
    }
    println!("{count} graphs, {records} calls");
}

/// Number of ways to falsify a run.
const WAYS: usize = 7;

/// Falsifies a run by changing one record in one of several ways. Returns `None` if the run has no suitable record.
fn spoiled(run: &[Record], way: usize, dice: &mut Dice) -> Option<Vec<Record>> {
    let mut run = run.to_vec();
    let is_call = |r: &Record| matches!(r, Record::Fired(_) | Record::Handled(_));
    let calls: Vec<usize> = (0..run.len()).filter(|i| is_call(&run[*i])).collect();
    let values: Vec<usize> =
        (0..run.len()).filter(|i| matches!(&run[*i], Record::Took(t) if t.iter().any(Option::is_some))).collect();
    let changes: Vec<usize> = (0..run.len()).filter(|i| matches!(run[*i], Record::Activity(..))).collect();
    let pick = |list: &[usize], dice: &mut Dice| (!list.is_empty()).then(|| *dice.of(list));
    match way {
        // A repeated call.
        0 => {
            let at = pick(&calls, dice)?;
            run.insert(at, run[at].clone());
        }
        // A missing call, with its tokens.
        1 => {
            let at = pick(&calls, dice)?;
            run.remove(at);
            if matches!(run.get(at), Some(Record::Took(_))) {
                run.remove(at);
            }
        }
        // A lost value, and one that no node sent.
        2 | 3 => {
            let at = pick(&values, dice)?;
            let Record::Took(tokens) = &mut run[at] else { return None };
            // The net knows no origin of initial tokens and timeouts, which are sevens here: other numbers are as good.
            let is_known = |token: &&mut Option<i64>| token.is_some_and(|value| way == 2 || value != 7);
            let token = tokens.iter_mut().find(is_known)?;
            *token = if way == 2 { None } else { token.map(|value| value + 1) };
        }
        // Unrecorded activity, and activity without a cause.
        4 => drop(run.remove(pick(&changes, dice)?)),
        5 => {
            let at = pick(&changes, dice)?;
            let Record::Activity(node, active) = run[at] else { return None };
            run.insert(at, Record::Activity(node, !active));
        }
        // A reaction that ends too early.
        _ => {
            let at = pick(&calls, dice)?;
            run.insert(at, Record::End);
        }
    }
    Some(run)
}

/// The ways that a run of the graph of a seed can be falsified in, each with `true` if the net does not see it.
fn judged(checker: &Checker, seed: u64) -> Vec<(usize, bool)> {
    let Some((_, checked)) = checked(checker, seed) else { return vec![] };
    let mut dice = Dice(seed | 1);
    let run = walk(&checker.catalog(), &checked, &mut dice, 4);
    let spoiled = (0..WAYS).filter_map(|way| Some((way, spoiled(&run, way, &mut dice)?)));
    spoiled.map(|(way, run)| (way, checker.judge(&checked, &run).is_ok())).collect()
}

#[test]
fn spoiled_runs_are_refused() {
    // To refuse a run, all that the net may do instead is tried: 50 ms.
    let judged: Vec<(usize, bool)> =
        (0..60).into_par_iter().map_init(Checker::new, |checker, seed| judged(checker, seed)).flatten_iter().collect();
    let (mut tried, mut passed) = ([0; WAYS], [0; WAYS]);
    for (way, is_ok) in judged {
        tried[way] += 1;
        passed[way] += usize::from(is_ok);
    }
    println!("tried {tried:?}, passed {passed:?}");
    for way in 0..WAYS {
        assert!(tried[way] > 5, "way {way} is not tried: {tried:?}");
        assert!(passed[way] * 20 <= tried[way], "way {way} is not seen: {passed:?} of {tried:?}");
    }
}
