//! Runs a program as on another machine: moved to a folder of its own, without the source tree that it was built from,
//! without a home and without variables of cargo. A program that looks for a file in that tree does not find it.

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

/// Hides the folder `$1` behind an empty one, `$2`, and runs the rest. Other processes do not see that.
const HIDE: &str = "mount --bind \"$2\" \"$1\" && shift 2 && exec \"$@\"";

/// Runs `program` with `args` in an empty folder, and returns what it left there: the folder, and its output.
///
/// Where a process may not hide folders from itself (`unshare`), the source tree remains in reach; a message says so.
pub fn run(name: &str, program: &str, args: &[&str]) -> (PathBuf, Output) {
    let folder = env::temp_dir().join(format!("apex-moved-{name}-{}", std::process::id()));
    let empty = folder.join("empty");
    fs::create_dir_all(&empty).expect("a folder for temporary files");
    let mut above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
    let tree = above.find(|folder| folder.join("apex-rt").is_dir()).expect("the source tree");
    let moved = folder.join(name);
    fs::copy(program, &moved).expect("room for the program");
    let hidden = |rest: &[&str]| {
        let mut command = Command::new("unshare");
        command.args(["--user", "--map-root-user", "--mount", "sh", "-c", HIDE, "sh"]);
        command.arg(tree).arg(&empty).args(rest);
        command
    };
    let file = tree.join("Cargo.toml").to_string_lossy().into_owned();
    let can_hide = hidden(&["test", "!", "-e", &file]).status().is_ok_and(|status| status.success());
    let moved = moved.to_string_lossy().into_owned();
    let mut command = match can_hide {
        true => hidden(&[&moved]),
        false => {
            eprintln!("the source tree remains in reach: this machine does not let `unshare` hide it");
            Command::new(&moved)
        }
    };
    let path = env::var_os("PATH").unwrap_or_default();
    command.args(args).current_dir(&folder).env_clear().env("PATH", path).env("HOME", &empty);
    (folder, command.output().expect("the program"))
}
