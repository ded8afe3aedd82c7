//! `apex new`: a project that works at once.

mod name;

use crate::{agents, project};
use clap::ValueEnum;
use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

/// A kind of project.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Template {
    /// A robot with a base and a laser scanner in a small simulated world: a mission, a live picture, a test.
    #[default]
    Robot,
    /// A library crate with nodes of its own, and a graph that tests them.
    Node,
    /// A cart on a microcontroller: a graph without the standard library and heap, which runs on this computer, too.
    Firmware,
    /// A mission whose drivers are another process, in Python here: a bridge over UDP, with a simulated base.
    Bridge,
}

/// A file of a project and its content. The placeholders `{name}`, `{crate}`, `{checkout}` and those of the crates'
/// paths are replaced.
type File = (&'static str, &'static str);

const GITIGNORE: File = (".gitignore", include_str!("template/gitignore.txt"));
const RUSTFMT: File = ("rustfmt.toml", include_str!("../../../rustfmt.toml"));

/// The robot is that of `robots/rover`, the firmware that of `robots/firmware`, where they are built and tested.
const ROBOT: [File; 9] = [
    ("Cargo.toml", include_str!("template/robot/Cargo.toml.txt")),
    (".cargo/config.toml", include_str!("template/robot/config.toml.txt")),
    ("README.md", include_str!("template/robot/README.md")),
    GITIGNORE,
    RUSTFMT,
    ("robot.afg", include_str!("../../../robots/rover/robot.afg")),
    ("world.txt", include_str!("../../../robots/rover/world.txt")),
    ("src/lib.rs", include_str!("../../../robots/rover/src/lib.rs")),
    ("src/main.rs", include_str!("../../../robots/rover/src/main.rs")),
];

const NODE: [File; 6] = [
    ("Cargo.toml", include_str!("template/node/Cargo.toml.txt")),
    ("README.md", include_str!("template/node/README.md")),
    GITIGNORE,
    RUSTFMT,
    ("tests.afg", include_str!("template/node/tests.afg")),
    ("src/lib.rs", include_str!("template/node/src/lib.rs")),
];

const FIRMWARE: [File; 8] = [
    ("Cargo.toml", include_str!("template/firmware/Cargo.toml.txt")),
    ("README.md", include_str!("template/firmware/README.md")),
    GITIGNORE,
    RUSTFMT,
    ("firmware.afg", include_str!("../../../robots/firmware/firmware.afg")),
    ("src/lib.rs", include_str!("../../../robots/firmware/src/lib.rs")),
    ("src/line.rs", include_str!("../../../robots/firmware/src/line.rs")),
    ("src/main.rs", include_str!("template/firmware/src/main.rs.txt")),
];

const BRIDGE: [File; 8] = [
    ("Cargo.toml", include_str!("template/bridge/Cargo.toml.txt")),
    ("README.md", include_str!("template/bridge/README.md")),
    GITIGNORE,
    RUSTFMT,
    ("robot.afg", include_str!("template/bridge/robot.afg")),
    ("drivers.py", include_str!("template/bridge/drivers.py")),
    ("src/lib.rs", include_str!("template/bridge/src/lib.rs")),
    ("src/main.rs", include_str!("template/bridge/src/main.rs")),
];

impl Template {
    fn files(self) -> &'static [File] {
        match self {
            Self::Robot => &ROBOT,
            Self::Node => &NODE,
            Self::Firmware => &FIRMWARE,
            Self::Bridge => &BRIDGE,
        }
    }

    /// First commands to run in the project.
    fn next(self) -> &'static [&'static str] {
        match self {
            Self::Robot => &["apex check robot.afg", "apex test robot.afg", "cargo run"],
            Self::Node => &["apex check tests.afg", "apex test tests.afg"],
            Self::Firmware => &["apex check firmware.afg", "apex test firmware.afg", "cargo run"],
            Self::Bridge => &["apex check robot.afg", "apex test robot.afg", "python3 drivers.py &", "cargo run"],
        }
    }
}

/// Makes a project in `folder`, whose name becomes that of the project. Its crates are those of `checkout`, or of the
/// checkout from which this command was built.
pub fn run(folder: &Path, template: Template, checkout: Option<&Path>) -> Result<ExitCode, String> {
    let checkout = find(checkout)?;
    let name = name::of(folder, &name::locked(&checkout))?;
    is_free(folder)?;
    let path = |path: &str| toml_string(&checkout.join(path));
    let filled = [
        // Package of the robot's files where they are tested.
        ("rover::", format!("{}::", name.replace('-', "_"))),
        ("{name}", name.to_owned()),
        ("{crate}", name.replace('-', "_")),
        ("{checkout}", checkout.display().to_string()),
        ("{macros}", path("apex-macros")?),
        ("{runtime}", path("apex-rt")?),
        ("{nodes}", path("nodes")?),
        ("{sim}", path("robots/sim")?),
    ];
    for (file, template) in template.files() {
        let text = filled.iter().fold((*template).to_owned(), |text, (hole, word)| text.replace(hole, word));
        write(&folder.join(file), &text)?;
    }
    agents::begin(folder, name, &checkout)?;
    let next: String = template.next().iter().map(|line| format!("\n  {line}")).collect();
    project::print(&format!("created `{name}`; next\n  cd {}{next}", shell_word(folder)))?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses a folder that is not empty.
fn is_free(folder: &Path) -> Result<(), String> {
    let shown = folder.display();
    match fs::read_dir(folder) {
        Ok(mut entries) => match entries.next() {
            None => Ok(()),
            Some(_) => Err(format!("the folder `{shown}` is not empty: choose another name")),
        },
        Err(_) if fs::symlink_metadata(folder).is_err() => Ok(()),
        Err(reason) => Err(format!("cannot create a project in `{shown}`: {reason}")),
    }
}

/// Checkout with the crates of Apex.
fn find(given: Option<&Path>) -> Result<PathBuf, String> {
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("/"));
    let checkout = given.unwrap_or(built_from);
    if ["apex-rt", "nodes", "robots/sim"].iter().all(|name| checkout.join(name).join("Cargo.toml").is_file()) {
        return fs::canonicalize(checkout).map_err(|e| format!("cannot find `{}`: {e}", checkout.display()));
    }
    let shown = checkout.display();
    Err(match given {
        Some(_) => {
            format!("`{shown}` is not a checkout of Apex: there is no `apex-rt`, `nodes` and `robots/sim` in it")
        }
        None => format!("the checkout of Apex is no longer in `{shown}`: name its folder with `--path`"),
    })
}

/// A path as a TOML string. Every JSON string is one.
fn toml_string(path: &Path) -> Result<String, String> {
    let shown = path.display();
    let text = path.to_str().ok_or_else(|| format!("the path `{shown}` is not UTF-8: move the checkout of Apex"))?;
    serde_json::to_string(text).map_err(|e| format!("cannot write the path `{shown}`: {e}"))
}

/// A path as one word of a shell.
fn shell_word(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = text.chars().all(|c| c.is_alphanumeric() || "/\\:._-~".contains(c));
    if plain { text } else { format!("'{}'", text.replace('\'', "'\\''")) }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .map_err(|e| format!("cannot write `{}`: {e}", path.display()))
}
