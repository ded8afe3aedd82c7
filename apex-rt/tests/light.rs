//! The runtime stays light: nodes build beside the compiler, not behind it.

use std::{collections::BTreeSet, process::Command};

/// Largest number of packages that the runtime needs without features, itself included.
const MOST: usize = 15;

#[test]
fn the_runtime_has_few_packages_below_it_and_not_the_compiler() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let arguments = "tree -p apex-rt -e normal --no-default-features --offline --prefix none --format {p}";
    let tree = Command::new(cargo)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments.split(' '))
        .output()
        .expect("cargo can be run");
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let lines = String::from_utf8_lossy(&tree.stdout).into_owned();
    let packages: BTreeSet<&str> = lines.lines().filter_map(|line| line.split(' ').next()).collect();
    assert!(packages.contains("apex-rt") && !packages.contains("apex-dsl"), "{packages:?}");
    assert!(packages.len() <= MOST, "{} packages: {packages:?}", packages.len());
}
