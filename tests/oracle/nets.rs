//! Nets by themselves: their own runs are legal, spoiled ones are not.

use apex_tests::oracle::{Case, Checked, Checker, Dice, Record, generate, walk};

/// A checked random graph for each seed, if it is a legal one.
fn checked(checker: &Checker, seed: u64) -> Option<(Case, Checked)> {
    let case = generate(seed, true);
    let checked = checker.check(&case.text("Random")).ok()?;
    Some((case, checked))
}

#[test]
fn most_random_graphs_are_legal() {
    let checker = Checker::new();
    let mut reasons = std::collections::BTreeMap::<String, usize>::new();
    for seed in 0..300 {
        if let Err(reason) = checker.check(&generate(seed, true).text("Random")) {
            let code = reason.split(':').next().unwrap_or_default().to_owned();
            *reasons.entry(code).or_default() += 1;
            assert!(["cycle", "unknown"].is_empty() || !reason.is_empty());
            if std::env::var_os("APEX_ORACLE_SHOW").is_some() {
                println!("{seed}: {reason}");
            }
        }
    }
    println!("{reasons:?}");
    assert!(reasons.values().sum::<usize>() < 100, "{reasons:?}");
}

#[test]
fn runs_of_a_net_are_legal() {
    let checker = Checker::new();
    let (mut count, mut records) = (0, 0);
    for seed in 0..300 {
        let Some((case, checked)) = checked(&checker, seed) else { continue };
        let run = walk(checker.catalog(), &checked, &mut Dice(seed | 1), 8);
        if let Err((step, why)) = checker.judge(&checked, &run) {
            panic!("seed {seed}: {why}\n{}\n{:?}", case.text("Random"), &run[..=step]);
        }
        count += 1;
        records += run.iter().filter(|r| matches!(r, Record::Fired(_) | Record::Handled(_))).count();
    }
    println!("{count} graphs, {records} calls");
}
