//! Errors of the compiler: code, place, and the important words.

use apex_tests::{check, error};

#[test]
fn df_02_an_open_mandatory_input_is_named() {
    let found = error("graph G { node x = OneBased(); node j = add(); x -> j.a; }");
    assert_eq!((found.code, found.at.as_str()), ("open-input", "j"));
    assert!(found.message.contains("`b` of `j`"), "{found:?}");
    let optional = check("graph G { node x = OneBased(); node j = add_or(); x -> j.x; }");
    assert!(optional.is_empty(), "{optional:?}");
}

#[test]
fn df_09_an_input_takes_one_connection() {
    let found = error("graph G { node x = OneBased(); node y = OneBased(); node k = Snk();\nx -> k;\ny -> k; }");
    assert_eq!((found.code, found.place.0), ("connected-twice", 3));
    assert!(found.message.contains("`k.x`"), "{found:?}");
    assert!(!found.also.is_empty(), "the first connection is shown: {found:?}");

    let found = error("graph G { node x = OneBased(); node k = Snk();\nx -> k;\nx -> k; }");
    assert_eq!((found.code, found.place.0), ("connected-twice", 3));

    let many = check("graph G { node x = OneBased(); node k = Snk(); node l = Snk(); x -> [k, l]; x -> Snk(); }");
    assert!(many.is_empty(), "an output takes many: {many:?}");
}

#[test]
fn df_10_a_cycle_is_printed() {
    let found = error("graph G { node a = pass(); node b = pass(); a -> b -> a; }");
    assert_eq!(found.code, "cycle");
    assert!(found.message.contains("`a` → `b` → `a`") || found.message.contains("`b` → `a` → `b`"), "{found:?}");
    assert!(found.says("delay"), "{found:?}");

    let found = error("graph G { node a = pass(); a -> a; }");
    assert_eq!(found.code, "cycle");
    assert!(found.message.contains("`a` → `a`"), "{found:?}");

    let broken = check("graph G { node a = pass() delay 0; a -> a; }");
    assert!(broken.is_empty(), "{broken:?}");
}

#[test]
fn df_10_a_cycle_through_a_nested_graph_is_printed() {
    let found = error(
        "graph Two { in x: i64; in y: i64; out a: i64; out b: i64; x -> pass() -> a; y -> pass() -> b; }
         graph G { node s = OneBased(); node t = Two(); s -> t.x; t.a -> t.y; t.b -> Snk(); }",
    );
    assert_eq!(found.code, "cycle");
    assert!(found.says("takes all its inputs together"), "{found:?}");
}

#[test]
fn df_11_a_mismatch_names_both_sides() {
    let found = error("graph G { node x = OneBased(); node l = limited(); x -> l; }");
    assert_eq!((found.code, found.at.as_str()), ("type-mismatch", "->"));
    for word in ["`x.out`", "`i64`", "`l.x`", "`f64`"] {
        assert!(found.message.contains(word), "{word} in {found:?}");
    }
    assert!(found.says("sources.rs:") && found.says("params.rs:"), "both declarations: {found:?}");
    assert!(found.says("types are not converted implicitly"), "{found:?}");
}

#[test]
fn par_02_a_value_out_of_range_is_an_error_with_the_range() {
    let found = error("graph G { node x = OneBased(); node f = scaled(gain = 11); x -> f; }");
    assert_eq!((found.code, found.at.as_str()), ("out-of-range", "11"));
    assert!(found.message.contains("0..=10"), "{found:?}");

    let found = error("graph G { node s = Settings(length = 200m); }");
    assert_eq!((found.code, found.at.as_str()), ("out-of-range", "200m"));
    assert!(found.message.contains("0..=100 m"), "{found:?}");

    // In its own unit the value would be in range.
    let found = error("graph G { node s = Settings(length = 1km); }");
    assert_eq!((found.code, found.at.as_str()), ("out-of-range", "1km"));

    let found = error("graph G(gain: i64 = 6 in 0..=5) { node x = OneBased(); node f = scaled(gain = gain); x -> f; }");
    assert_eq!((found.code, found.at.as_str()), ("out-of-range", "6"));
}

#[test]
fn par_03_a_wrong_unit_is_an_error() {
    let found = error("graph G { node s = Settings(length = 10ms); }");
    assert_eq!((found.code, found.at.as_str()), ("wrong-unit", "10ms"));
    assert!(found.message.contains("a length") && found.message.contains("a time"), "{found:?}");

    let found = error("graph G { node s = Settings(length = 10); }");
    assert_eq!((found.code, found.at.as_str(), found.fixes), ("missing-unit", "10", vec!["m".to_owned()]));
}

#[test]
fn par_03_an_unknown_parameter_gets_the_nearest_name() {
    let found = error("graph G { node s = Settings(lenght = 1m); }");
    assert_eq!((found.code, found.at.as_str(), found.fixes), ("unknown-argument", "lenght", vec!["length".to_owned()]));
}
