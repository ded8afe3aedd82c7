//! Messages of rustc for mistakes that the macros find. `TRYBUILD=overwrite` writes the `.stderr` files again.

#[test]
fn errors() {
    // Only failures: with programs that compile, each would be built by itself, and all that it needs completely.
    trybuild::TestCases::new().compile_fail("fail/*.rs");
}
