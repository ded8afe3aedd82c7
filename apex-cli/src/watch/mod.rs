//! `apex run --watch`: builds and starts the program again after changes.

pub mod files;
pub mod program;

use crate::{
    Format,
    answer::Answer,
    project::print_error,
    run::{self, Found, Wanted},
};
use apex_host::Workspace;
use files::Files;
use program::{Running, forget, start};
use std::{
    fs, mem,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::Duration,
};

/// Interval between checks of the files and the program.
const INTERVAL: Duration = Duration::from_millis(200);

/// `true` after Ctrl-C.
static STOPPED: AtomicBool = AtomicBool::new(false);

/// Builds and runs until Ctrl-C, again after each change. While the source file has errors, the previous program keeps
/// running.
pub fn run(wanted: &Wanted<'_>) -> Result<ExitCode, String> {
    ctrlc::set_handler(|| STOPPED.store(true, Ordering::Relaxed))
        .map_err(|error| format!("cannot wait for Ctrl-C: {error}"))?;
    let mut folders = folders(wanted.file)?;
    let mut running: Option<Running> = None;
    let (mut is_first, mut has_started) = (true, false);
    while !STOPPED.load(Ordering::Relaxed) {
        let files = Files::below(&folders);
        match built(wanted) {
            Ok(Some(_)) if STOPPED.load(Ordering::Relaxed) => break,
            Ok(Some(built)) => {
                if let Some(before) = running.take() {
                    before.end();
                }
                if !mem::replace(&mut has_started, true) {
                    forget(&built);
                }
                running = Some(start(built, wanted)?);
            }
            Ok(None) => print_error(waiting(running.as_ref())),
            Err(message) if is_first => return Err(message),
            Err(message) => print_error(&format!("error: {message}\n{}", waiting(running.as_ref()))),
        }
        is_first = false;
        wait(&files, &folders, &mut running);
        folders = self::folders(wanted.file).unwrap_or(folders);
    }
    if let Some(last) = running {
        last.end();
    }
    Ok(ExitCode::SUCCESS)
}

/// Builds the program. Returns `None` after errors, which are printed.
fn built(wanted: &Wanted<'_>) -> Result<Option<Found>, String> {
    wanted.check(&mut Answer::new("run", Format::Text))?.map_or(Ok(None), |programs| wanted.build(&programs))
}

/// Message about the time until the next change.
fn waiting(running: Option<&Running>) -> &'static str {
    running.map_or("waiting for a change", |_| "the previous program keeps running")
}

/// Waits until files have changed and are stable, or until Ctrl-C.
fn wait(files: &Files, folders: &[PathBuf], running: &mut Option<Running>) {
    let mut last = files.clone();
    while !STOPPED.load(Ordering::Relaxed) {
        if let Some(code) = running.as_mut().and_then(|program| program.ended()) {
            print_error(&format!("the program has ended ({code}); waiting for a change"));
            *running = None;
        }
        thread::sleep(INTERVAL);
        let now = Files::below(folders);
        if now == last && now != *files {
            return;
        }
        last = now;
    }
}

/// Folders of the packages that belong to the program.
pub fn folders(file: &Path) -> Result<Vec<PathBuf>, String> {
    let package = run::package(file)?;
    let workspace = Workspace::load(&package)?;
    let libraries = workspace.libraries().into_iter().map(|(_, folder)| folder.to_owned());
    let mut folders: Vec<PathBuf> = libraries.chain([package]).filter_map(|f| fs::canonicalize(f).ok()).collect();
    folders.sort();
    folders.dedup();
    Ok(folders)
}
