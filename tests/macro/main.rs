//! Messages of rustc for the errors that the macros detect. `TRYBUILD=overwrite` writes the `.stderr` files again.

#[test]
fn errors() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("macro/fail/*.rs");
    cases.pass("macro/pass/*.rs");
}
