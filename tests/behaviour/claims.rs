//! Claims that the compiler could not decide are checked while the program runs.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("claims.afg");

#[test]
fn a_broken_claim_is_reported_once_until_it_holds_again() {
    let mut program = Broken::new();
    assert!(react(&mut program, 1).broken.is_empty());
    // 8 rings and `go`; two tokens are sent before any of them is taken.
    let all = ["exclusive(x, many)", "exclusive(x, y)"];
    let mut broken = react(&mut program, 1).broken;
    assert_eq!(broken.remove(0), "conserved", "before anybody takes the tokens");
    assert_eq!(broken, all);
    assert!(react(&mut program, 1).broken.is_empty(), "they have been reported");
    assert!(react(&mut program, 1).broken.is_empty(), "all is as at the start");
    assert_eq!(react(&mut program, 1).broken, ["conserved", all[0], all[1]]);
}

#[test]
fn claims_that_hold_are_not_reported() {
    let mut program = Taken::new();
    assert_eq!(react(&mut program, 2).broken, ["reaches(x, go)"], "nothing leads back from `x`");
    assert!(program.is_active(index::<Taken>("x")));
    assert!(react(&mut program, 2).broken.is_empty());
    assert!(!program.is_active(index::<Taken>("x")));
}

#[test]
fn what_ends_the_program_is_not_lost() {
    let mut program = Ended::new();
    assert!(react(&mut program, 3).broken.is_empty());
    assert_eq!(program.react(Time::ZERO), Next::Exit(0));
}

#[test]
fn the_table_has_all_claims() {
    assert_eq!(Decided::INFO.claims, ["exclusive(x, y)", "conserved"]);
    assert_eq!(Broken::INFO.claims.len(), 7);
}

#[test]
fn decided_claims_cost_nothing() {
    let text = include_str!("claims.afg");
    let at = text.find("/// All is decided").unwrap_or_default();
    let decided = format!("use apex_tests::nodes::Pass;\n{}", &text[at..]);
    assert!(!apex_tests::expand(&decided).contains("claim_"));
    assert!(apex_tests::expand(text).contains("claim_failed"));
}

/// Pairs of nodes that pass an activity to each other, and claims about some of them.
#[test]
fn what_happens_elsewhere_does_not_multiply_the_states_of_a_claim() {
    let pair = |n: usize| {
        format!("node a{n} = Pass();\nnode b{n} = Pass();\nstart => a{n};\na{n}.e => b{n}.s;\nb{n}.e => a{n}.s;\n")
    };
    let pairs: String = (0..18).map(pair).collect();
    let claims = "claim exclusive(a0, b0);\nclaim exclusive(a1, b1);\nclaim reaches(a2, b2);\nclaim conserved;\n";
    let text = format!("use apex_tests::nodes::Pass;\ngraph Pairs {{\n{pairs}{claims}}}\n");
    assert!(!apex_tests::expand(&text).contains("claim_"));
    let wrong = text.replace("b1)", "b2)");
    assert!(std::panic::catch_unwind(|| apex_tests::expand(&wrong)).is_err(), "both can be active");
}

fn index<P: Program>(node: &str) -> usize {
    P::INFO.nodes.iter().position(|n| n.name == node).expect("there is such a node")
}
