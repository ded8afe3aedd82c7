//! The examples in `docs/tools.md` agree with the command.

use crate::{
    TARGET, builds,
    common::{Folder, apex, lock},
};
use std::{fs, path::Path};

/// First block of the page that begins like this.
fn block(begin: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/tools.md");
    let page = fs::read_to_string(page).unwrap();
    let begin = format!("```{begin}");
    let (_, rest) = page.split_once(&begin).unwrap();
    let block = begin + rest.split_once("```").unwrap().0;
    block.split_once('\n').unwrap().1.to_owned()
}

/// Runs the command of a block in `folder`, and compares the output.
fn runs(begin: &str, folder: &Path) {
    let console = block(&format!("console\n$ apex {begin}"));
    let (command, said) = console.split_once('\n').unwrap();
    let arguments = command.strip_prefix("$ apex ").unwrap().split(' ');
    let output = apex().args(arguments).current_dir(folder).env_remove("CARGO_TARGET_DIR").output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), said);
}

#[test]
fn the_new_project_of_the_page_and_its_documentation() {
    let folder = Folder::new("docs-new");
    runs("new", &folder.0);
    lock(&folder.0.join("my-robot"));
    runs("doc", &folder.0.join("my-robot"));
}

/// Copies the package out of the workspace, whose settings would have everything built once more.
fn copy_of_the_firmware(to: &Path) {
    let checkout = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let from = checkout.join("robots/firmware");
    let dependency = |name: &str, folder: &str| {
        format!("{name} = {{ path = {:?}, default-features = false }}\n", checkout.join(folder))
    };
    let dependencies = [("apex-macros", "apex-macros"), ("apex-nodes", "nodes"), ("apex-rt", "apex-rt")];
    let dependencies: String = dependencies.iter().map(|(name, folder)| dependency(name, folder)).collect();
    let package =
        "[package]\nname = \"firmware\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n";
    fs::create_dir_all(to.join("src")).unwrap();
    fs::write(to.join("Cargo.toml"), format!("{package}{dependencies}")).unwrap();
    lock(to);
    for file in ["firmware.afg", "src/lib.rs", "src/line.rs"] {
        fs::copy(from.join(file), to.join(file)).unwrap();
    }
}

#[test]
fn the_memory_of_the_page() {
    let _guard = builds();
    let console = block("console\n$ apex explain --memory");
    let (command, said) = console.split_once('\n').unwrap();
    let arguments = command.strip_prefix("$ apex ").unwrap().split(' ');
    let folder = Folder::new("docs-memory");
    copy_of_the_firmware(&folder.0.join("robots/firmware"));
    let mut apex = apex();
    apex.args(arguments).current_dir(&folder.0).env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true");
    assert_eq!(String::from_utf8(apex.output().unwrap().stdout).unwrap(), said);
}

#[test]
fn the_import_of_the_page() {
    let folder = Folder::new("docs-import");
    let output = apex().arg("import").arg(folder.file("robot.apex", block("yaml\n"))).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap(), block("text\n"));
}
