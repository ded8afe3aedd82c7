//! `apex run`: the package's own program, or one that is made for the text.

use crate::project;
use apex_dsl::{graph::NodeKind, passes::Program};
use apex_host::Workspace;
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::{Command, ExitCode},
};

/// Checks, builds and runs.
pub fn run(file: &Path, robot: Option<&str>, args: &[String]) -> Result<ExitCode, String> {
    let checked = project::check(file)?;
    checked.print_diagnostics();
    if checked.diagnostics.has_errors() {
        return Ok(ExitCode::from(1));
    }
    let folder = project::package_of(file).ok_or_else(|| {
        format!("`{}` is in no cargo package, so that its nodes cannot be found; put it beside a Cargo.toml that depends on `apex-rt`", file.display())
    })?;
    let workspace = Workspace::load(&folder)?;
    let (package, binary) = workspace.binary();
    let mut command = cargo();
    match binary.filter(|_| robot.is_none()) {
        Some(binary) => {
            command
                .args(["run", "--release", "--quiet", "--package", package, "--bin", binary, "--"])
                .args(args)
                .current_dir(&folder);
        }
        None => {
            let program = choose(&checked.programs, robot)?;
            let made = driver(file, program, &workspace)?;
            command
                .args(["run", "--release", "--quiet", "--manifest-path"])
                .arg(made)
                .arg("--target-dir")
                .arg(workspace.target.join("apex/run"))
                .arg("--")
                .args(args);
        }
    }
    let status = command.status().map_err(|e| format!("cannot run cargo: {e}"))?;
    Ok(status.code().and_then(|c| u8::try_from(c).ok()).map_or(ExitCode::from(2), ExitCode::from))
}

fn cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// The program that is meant: the named one, the only robot, or the only graph.
fn choose<'a>(programs: &'a [Program], name: Option<&str>) -> Result<&'a Program, String> {
    let names = || programs.iter().map(|p| format!("`{}`", p.graph.name)).collect::<Vec<_>>().join(", ");
    if let Some(name) = name {
        return programs
            .iter()
            .find(|p| p.graph.name == name)
            .ok_or_else(|| format!("there is no robot `{name}`; there are {}", names()));
    }
    let robots: Vec<&Program> = programs.iter().filter(|p| p.graph.robot).collect();
    match (robots.as_slice(), programs) {
        ([only], _) => Ok(*only),
        ([], [only]) => Ok(only),
        _ => Err(format!("which one is to run? choose with `--robot`: {}", names())),
    }
}

/// Makes a package whose only job is to drive the program.
fn driver(file: &Path, program: &Program, workspace: &Workspace) -> Result<PathBuf, String> {
    let graph = &program.graph;
    if let Some(node) = graph.nodes.iter().find(|n| matches!(&n.kind, NodeKind::Library(l) if l.handed_in)) {
        return Err(format!("`{}` of `{}` is made in Rust: run it from a program of your own", node.name, graph.name));
    }
    let folder = workspace.cache_folder().join("run").join(&graph.name);
    let file = fs::canonicalize(file).map_err(|e| format!("cannot find `{}`: {e}", file.display()))?;
    let dependencies: String =
        workspace.libraries().iter().map(|(name, path)| format!("{name} = {{ path = {path:?} }}\n")).collect();
    let manifest = format!(
        "[package]\nname = \"apex-run\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[profile.dev.build-override]\nopt-level = 2\n\n[dependencies]\n{dependencies}"
    );
    let main = format!(
        "use apex_rt::prelude::*;\n\ngraph!({file:?});\n\nfn main() {{\n    run({}::new(), WallClock::new());\n}}\n",
        graph.name
    );
    let write = |path: PathBuf, text: &str| {
        let same = fs::read_to_string(&path).is_ok_and(|old| old == text);
        let result = if same {
            Ok(())
        } else {
            fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).and_then(|()| fs::write(&path, text))
        };
        result.map_err(|e| format!("cannot write `{}`: {e}", path.display()))
    };
    write(folder.join("Cargo.toml"), &manifest)?;
    write(folder.join("src/main.rs"), &main)?;
    Ok(folder.join("Cargo.toml"))
}
