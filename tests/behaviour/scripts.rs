//! `test` items, each of which becomes a Rust test.

use apex_macros::graph;

graph!("scripts.afg");

/// Tests that must fail, and what they say.
fn wrong() -> Vec<(fn(), &'static str)> {
    // Cargo does not run the tests in a function.
    #![allow(unnameable_test_items, reason = "they fail")]
    graph!("wrong_scripts.afg");
    use wrong_scripts_afg as w;
    let never_put = "was never put in: the program has not taken the one before";
    vec![
        (w::test_the_second_token_comes::run, "`y == 2` happened, but never should"),
        (w::test_the_last_of_a_list_comes::run, "`y == 3` happened, but never should"),
        (w::test_the_last_statement_counts::run, "`y` happened, but never should"),
        (w::test_used_once::run, "the one at 1.000000 s does not count, because an earlier `expect` has used it"),
        (w::test_too_late::run, "expected `rang` by 0.999000 s: it came at 1.000000 s"),
        (w::test_not_what_was_before::run, "expected `y` within 1s: it came before, at 0.000000 s"),
        (w::test_not_the_cause::run, "expected `y == 1` within 0ns: the one at 0.000000 s does not count"),
        (w::test_not_backwards::run, "expected `y == 1`: the one at 0.000000 s does not count"),
        (w::test_never_put_in::run, never_put),
        (w::test_never_put_in_again::run, never_put),
        (w::test_after_the_end::run, "token 1 for `a`, due at 1.000000 s, was never put in: the program ended at 0.0"),
        (w::test_a_state_is_looked_at_now::run, "by 1.000000 s, which is past: a state is looked at now"),
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
