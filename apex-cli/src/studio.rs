//! `apex studio`: builds and starts a robot, and opens the page on which it can be seen; or opens the page of a study.

mod launch;
mod launched;
mod text;

use crate::{
    project::{self, print_error},
    run, tune,
};
use apex_host::Workspace;
use apex_studio::{Addresses, Recorded, Remote, Robot, Seat, Shadow, Studio, Study};
use apex_tune::Journal;
use launched::Launched;
use std::{
    io::{self, IsTerminal as _},
    net::SocketAddr,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::Arc,
};
use text::Text;

pub use launch::Launch;

/// The page.
pub struct Page {
    pub listen: SocketAddr,
    /// Origins under which proxies show it.
    pub origins: Vec<String>,
    pub read_only: bool,
    pub speed: f64,
}

/// Reads a speed.
pub fn speed(text: &str) -> Result<f64, String> {
    let speed = text.parse().ok().filter(|speed: &f64| *speed > 0.0);
    speed.ok_or_else(|| "a positive number, or `inf` for as fast as possible".to_owned())
}

/// Runs the robot and serves its page until Ctrl-C.
pub fn run(launch: Launch, page: &Page) -> Result<ExitCode, String> {
    let studies = studies(&launch.file);
    let (file, replay) = (Some(launch.file.clone()), launch.replay.clone());
    let text = Arc::new(Text::new(file, replay, launch.params.is_some()));
    let name = launch.file.display().to_string();
    let recorded = launch.shadow.then(Arc::<Recorded>::default);
    let mut robot = Launched::new(launch, Arc::clone(&text), recorded.clone())?;
    if !robot.build()? {
        return Ok(ExitCode::from(1));
    }
    let mut robots = vec![Seat { name, robot: Box::new(robot), source: Arc::clone(&text) as _, shadow_of: None }];
    if let Some(recorded) = recorded {
        let robot: Box<dyn Robot> = Box::new(Shadow::new(recorded));
        robots.push(Seat { name: "shadow".to_owned(), robot, source: text, shadow_of: Some(0) });
    }
    page.serve(robots, studies, Some(page.speed)).map(|()| ExitCode::SUCCESS)
}

/// Serves a page of the study in a folder until Ctrl-C.
pub fn study(launch: &Launch, page: &Page) -> Result<ExitCode, String> {
    let Launch { file: folder, robot, replay, simulated, shadow, params, args, .. } = launch;
    let of_robots = [
        ("--robot", robot.is_some()),
        ("--replay", replay.is_some()),
        ("--simulated", *simulated),
        ("--shadow", *shadow),
        ("--params", params.is_some()),
        ("--", !args.is_empty()),
    ];
    if let Some((option, _)) = of_robots.iter().find(|(_, is_given)| *is_given) {
        return Err(format!("`{option}` is for robots, and `{}` is the folder of a study", folder.display()));
    }
    if !folder.join(Journal::FILE).is_file() {
        return Err(format!(
            "`{}` is a folder without the journal of a study (`{}`): write the folder in which `apex tune` writes, or a source file",
            folder.display(),
            Journal::FILE
        ));
    }
    let study = Study { name: folder.display().to_string(), folder: folder.to_owned() };
    page.serve(vec![], vec![study], None).map(|()| ExitCode::SUCCESS)
}

/// Studies of the `tune` items of a source file, in the folders in which `apex tune` writes them.
fn studies(file: &Path) -> Vec<Study> {
    let workspace = run::package(file).and_then(|folder| Workspace::load(&folder));
    let (Ok(workspace), Ok(checked)) = (workspace, project::check(file)) else { return vec![] };
    let scripts = checked.programs.iter().flat_map(|program| &program.scripts);
    let named = scripts
        .filter(|script| script.study.is_some())
        .map(|script| Study { name: script.name.clone(), folder: tune::default_folder(&workspace, &script.name) });
    named.filter(|study| study.folder.join(Journal::FILE).is_file()).collect()
}

/// Serves a page of robots that run already until Ctrl-C. `file` has their text.
pub fn connect(addresses: Vec<String>, file: Option<PathBuf>, page: &Page) -> Result<ExitCode, String> {
    if let Some(file) = &file {
        project::check(file)?.print_diagnostics();
    }
    let seat = |address: String| {
        let text = Text::new(file.clone(), None, false);
        Seat { name: address.clone(), robot: Box::new(Remote { address }), source: Arc::new(text), shadow_of: None }
    };
    let studies = file.as_deref().map(studies).unwrap_or_default();
    page.serve(addresses.into_iter().map(seat).collect(), studies, None).map(|()| ExitCode::SUCCESS)
}

/// Shows a robot in the terminal.
pub fn top(address: String) -> Result<ExitCode, String> {
    if !io::stdout().is_terminal() {
        return Err("`apex top` needs a terminal".to_owned());
    }
    apex_studio::top(Remote { address }).map_err(|error| format!("cannot use the terminal: {error}"))?;
    Ok(ExitCode::SUCCESS)
}

impl Page {
    fn serve(&self, robots: Vec<Seat>, studies: Vec<Study>, speed: Option<f64>) -> Result<(), String> {
        let has_robot = !robots.is_empty();
        let (address, origins, readonly) = (self.listen, self.origins.clone(), self.read_only);
        let studio = Studio { robots, studies, address, origins, readonly, speed };
        let opened = |Addresses { page, proxied, foxglove }: &Addresses| {
            let foxglove = if has_robot { format!("Foxglove: {foxglove}\n") } else { String::new() };
            let proxied: String = proxied.iter().map(|page| format!("behind the proxy: {page}\n")).collect();
            print_error(&format!("studio: {page}\n{proxied}{foxglove}Ctrl-C ends it"));
        };
        studio.serve(opened).map_err(|error| {
            format!("cannot open the page at {}: {error}; choose another address with `--listen`", self.listen)
        })
    }
}
