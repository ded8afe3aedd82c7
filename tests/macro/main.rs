//! Messages of rustc for mistakes that the macros find. `TRYBUILD=overwrite` writes the `.stderr` files again.

#[test]
fn errors() {
    let cases = trybuild::TestCases::new();
    cases.compile_fail("fail/*.rs");
    cases.pass("pass/*.rs");
}
