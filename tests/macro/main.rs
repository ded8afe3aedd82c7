//! Messages of rustc for mistakes that the macros find. `TRYBUILD=overwrite` writes the `.stderr` files again.

#[test]
fn errors() {
    // Only failures: beside a program that compiles, such as `inline.rs`, each would be built alone, and completely.
    trybuild::TestCases::new().compile_fail("fail/*.rs");
}
