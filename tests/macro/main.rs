//! Messages of rustc for mistakes that the macros find. `TRYBUILD=overwrite` writes the `.stderr` files again.

use std::{fs, path::Path};

/// Settings of the tests of the command, which build in the same folder: the compiler is built once for both.
const SETTINGS: &str = "[profile.dev]\ndebug = 0\n[profile.dev.build-override]\nopt-level = 0\n";

#[test]
fn errors() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("tests").join("trybuild/.cargo");
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("config.toml"), SETTINGS).unwrap();
    // Only failures: beside a program that compiles, such as `inline.rs`, each would be built alone, and completely.
    trybuild::TestCases::new().compile_fail("fail/*.rs");
}
