//! The verifier of programs: those of the compiler have no faults, falsified ones have.

use apex_dsl::{
    analyse::ClusterId,
    catalog::Catalog,
    program::{Fire, Lower, Op, Program},
};
use apex_tests::{
    Dice,
    oracle::{Checked, Checker, generate, with_timeouts},
};
use std::collections::BTreeMap;

fn program<'a>(checked: &'a Checked, catalog: &'a Catalog) -> Program<'a> {
    Program::new(Lower::new(&checked.program.graph, &checked.program.analysis, catalog, None))
}

/// The places of operations of a kind, in clusters that fire.
fn places(program: &Program<'_>, is_meant: impl Fn(&Op) -> bool) -> Vec<(ClusterId, usize)> {
    let firing = program.clusters.iter_enumerated().filter(|(c, _)| program.lower.analysis.clusters[*c].fires);
    firing
        .flat_map(|(cluster, ops)| ops.iter().enumerate().map(move |(at, op)| (cluster, at, op)))
        .filter(|(.., op)| is_meant(op))
        .map(|(cluster, at, _)| (cluster, at))
        .collect()
}

/// Falsifies a program. Returns `false` if it has nothing of that kind.
type Falsify = fn(&mut Program<'_>, &mut Dice) -> bool;

/// Ways to falsify a program.
const WAYS: [(&str, Falsify); 5] = [
    ("a firing is missing", |program, dice| {
        let places =
            places(program, |op| matches!(op, Op::Fire { fire: Fire::Call(_) | Fire::Relay | Fire::Hold, .. }));
        remove(program, &places, dice)
    }),
    ("a node fires twice", |program, dice| {
        let places = places(program, |op| matches!(op, Op::Fire { fire: Fire::Hold | Fire::Relay, .. }));
        let Some((cluster, at)) = any(&places, dice) else { return false };
        let Op::Fire { node, fire } = &program.clusters[cluster][at] else { return false };
        let fire = if matches!(fire, Fire::Hold) { Fire::Hold } else { Fire::Relay };
        let again = Op::Fire { node: *node, fire };
        program.clusters[cluster].push(again);
        true
    }),
    ("activity stays at an input", |program, dice| {
        // Both before the firing, and at the end of the cluster.
        let places = places(program, |op| matches!(op, Op::TakeActivity { gains, .. } if !gains.is_empty()));
        let Some((cluster, at)) = any(&places, dice) else { return false };
        let Op::TakeActivity { node: meant, .. } = program.clusters[cluster][at] else { return false };
        forget(&mut program.clusters[cluster], meant);
        true
    }),
    ("a connection stays occupied", |program, _| {
        let occupied: Vec<usize> = program.wiring.ports().flat_map(|p| &p.sends).filter_map(|s| s.occupies).collect();
        let slot = program.wiring.slots.iter_mut().find(|slot| slot.frees.is_some_and(|bit| occupied.contains(&bit)));
        slot.is_some_and(|slot| slot.frees.take().is_some())
    }),
    ("another slot is queued", |program, _| {
        let slots = &mut program.wiring.slots;
        let is_queued = slots.len() > 1 && slots[0].connection != slots[1].connection;
        let queued = program.wiring.ports().flat_map(|p| &p.sends).any(|send| send.queued == Some(0));
        if is_queued && queued {
            program.wiring.slots.swap(0, 1);
        }
        is_queued && queued
    }),
];

fn any(places: &[(ClusterId, usize)], dice: &mut Dice) -> Option<(ClusterId, usize)> {
    (!places.is_empty()).then(|| *dice.of(places))
}

fn remove(program: &mut Program<'_>, places: &[(ClusterId, usize)], dice: &mut Dice) -> bool {
    let Some((cluster, at)) = any(places, dice) else { return false };
    program.clusters[cluster].remove(at);
    true
}

/// Removes all that takes the activity at the inputs of a node.
fn forget(ops: &mut Vec<Op>, meant: apex_dsl::graph::NodeId) {
    ops.retain(|op| !matches!(op, Op::TakeActivity { node, .. } if *node == meant));
    for op in ops {
        match op {
            Op::Block { body, .. } | Op::IfArrived { body, .. } => forget(body, meant),
            Op::Iteration { firings, .. } => firings.values_mut().for_each(|ops| forget(ops, meant)),
            _ => {}
        }
    }
}

#[test]
fn falsified_programs_have_faults() {
    let checker = Checker::new();
    let mut found: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
    for seed in 0..150 {
        let case = generate(seed, true);
        let case = if seed % 2 == 0 { case } else { with_timeouts(case) };
        let Ok(checked) = checker.check(&case.text("Random")) else { continue };
        let catalog = checker.catalog();
        assert_eq!(program(&checked, &catalog).faults(), [] as [String; 0], "seed {seed}");
        for (way, falsify) in WAYS {
            let mut program = program(&checked, &catalog);
            if falsify(&mut program, &mut Dice(seed | 1)) {
                let counts = found.entry(way).or_default();
                counts.0 += 1;
                counts.1 += usize::from(!program.faults().is_empty());
            }
        }
    }
    println!("{found:?}");
    for (way, (tried, caught)) in &found {
        // Activity that no token brings is not missed.
        assert!(*tried > 10 && caught * 10 >= tried * 9, "{way}: {caught} of {tried} were found");
    }
    assert_eq!(found.len(), WAYS.len());
}
