//! `test` items, each of which becomes a Rust test.

use apex_macros::graph;
use apex_tests::expand;

graph!("scripts.afg");

/// Tests that must fail, and what they say.
fn wrong() -> Vec<(fn(), &'static str)> {
    // Cargo does not run the tests in a function.
    #![allow(unnameable_test_items, reason = "they fail")]
    graph!("wrong_scripts.afg");
    use wrong_scripts_afg::{tests_of_Numbers as n, tests_of_Pairs as p, tests_of_States as s};
    let never_put = "was never put in: the program has not taken the one before";
    vec![
        (n::run_the_second_token_comes, "`y == 2` happened, but never should"),
        (n::run_the_last_of_a_list_comes, "`y == 3` happened, but never should"),
        (n::run_the_last_statement_counts, "`y` happened, but never should"),
        (n::run_used_once, "the one at 1.000000 s does not count, because an earlier `expect` has used it"),
        (n::run_too_late, "expected `rang` by 0.999000 s: it came at 1.000000 s"),
        (n::run_not_what_was_before, "expected `y` within 1s: it came before, at 0.000000 s"),
        (n::run_not_the_cause, "expected `y == 1` within 0ns: the one at 0.000000 s does not count"),
        (n::run_not_backwards, "expected `y == 1`: the one at 0.000000 s does not count"),
        (p::run_never_put_in, never_put),
        (p::run_never_put_in_again, never_put),
        (p::run_after_the_end, "token 1 for `a`, due at 1.000000 s, was never put in: the program ended at 0.0"),
        (s::run_a_state_is_looked_at_now, "by 1.000000 s, which is past: a state is looked at now"),
    ]
}

#[test]
fn a_test_does_not_praise_what_was_not_done() {
    for (test, says) in wrong() {
        let reason = std::panic::catch_unwind(test).expect_err(says);
        let message = reason.downcast_ref::<String>().expect("a text");
        assert!(message.contains(says), "expected: {says}\n{message}");
        assert!(message.contains("wrong_scripts.afg:"), "{message}");
    }
}

/// A program is compiled once for all its tests, unless it differs in an argument or a node.
#[test]
fn tests_of_one_program_share_it() {
    let graph = "use apex_tests::nodes::Pass;
        graph Numbers(first: i64 = 1) { slot a: i64; event b: i64; node r = Pass(); node s = Pass(); a -> r.s; r.e -> s.s; s.e -> b; }";
    let programs = |tests: &str| {
        let code = expand(&format!("{graph}\n{tests}"));
        let count = |what: &str| code.matches(what).count();
        assert_eq!(count("fn run_"), count("# [test]"), "each test is run: {code}");
        count("pub mod tests_of_Numbers")
    };
    let same = "test one: Numbers { feed a = 1; expect b; } test two: Numbers { feed a = 2; expect r.e == 2; }";
    assert_eq!(programs(same), 1);
    let other = "test three: Numbers(first = 1) { feed a = 1; expect b; } test four: Numbers(first = 2) { expect b; }";
    assert_eq!(programs(&format!("{same} {other}")), 3);
    let replaced = "test five: Numbers { replace r = Pass(); feed a = 1; expect b; }";
    assert_eq!(programs(&format!("{same} {replaced} {}", replaced.replace("five", "six"))), 2);
    assert_eq!(
        programs(&format!(
            "{same} {replaced} {}",
            replaced.replace("five: Numbers { replace r", "six: Numbers { replace s")
        )),
        3
    );
}
