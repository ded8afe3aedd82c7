//! What rustc shows of the mistakes that the macros find. `TRYBUILD=overwrite` writes the `.stderr` files anew.

#[test]
fn errors() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("macro/fail/*.rs");
    cases.pass("macro/pass/*.rs");
}
