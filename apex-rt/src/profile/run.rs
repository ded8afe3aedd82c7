//! Profiles by [`drive`](crate::drive).

use super::{MAX_TRACED, Profile};
use crate::{
    Clock, Ports, Program, StdErr,
    drive::drive_groups,
    instruments::{Instruments, Streams, Tapped},
};
use std::{
    io,
    path::Path,
    sync::{Mutex, PoisonError},
};

/// Drives a program, writes its trace to `path` and its table to standard error. Returns the exit code.
pub(crate) fn drive<P: Program, C: Clock>(program: P, clock: C, ports: Ports<P>, path: &Path, streams: &Streams) -> u8 {
    let cannot_write = |error: io::Error| eprintln!("error: cannot write `{}`: {error}", path.display());
    let info = const { &P::INFO };
    let profile = match Profile::to_file(info, path) {
        Ok(profile) => Mutex::new(profile),
        Err(error) => {
            cannot_write(error);
            return 2;
        }
    };
    let observer = |group| -> Instruments<'_> {
        let measures = Profile::of_group(&profile, group);
        (StdErr(info), (Some(measures), (Tapped::default(), streams.of_group(group))))
    };
    crate::end::on_signals();
    let code = drive_groups(program, clock, ports, observer);
    let mut profile = profile.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Err(error) = profile.finish() {
        cannot_write(error);
    }
    eprint!("{}", profile.table());
    profile.warnings().iter().for_each(|warning| eprintln!("warning: {warning}"));
    if profile.is_cut() {
        eprintln!("the trace ends after {MAX_TRACED} calls; the table counts all");
    }
    code
}
