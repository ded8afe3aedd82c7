//! Repetition of the reactions of a recording.

use super::{ReplayError, Report, Tap};
use crate::{
    Next, Observer, Program, Time,
    react::{react, react_again},
};
use core::time::Duration;
use std::{io, path::Path};

/// Time between two reactions of a program that has sources without a period.
const STEP: Duration = Duration::from_millis(1);

/// Repeats all reactions of a program or of a thread group, and calls `before` before each. The tap of the observer has
/// their recording.
pub(super) fn repeat<P: Program, O: Observer>(
    program: &mut P,
    observer: &mut O,
    mut before: impl FnMut(),
) -> io::Result<Report> {
    lead_in(program, observer);
    while let Some(Tap::Replay(replay)) = observer.tap()
        && let Some((now, ends_early)) = replay.next_reaction()?
    {
        before();
        react_again(program, now, observer, ends_early);
    }
    Ok(observer.tap().map(Tap::report).unwrap_or_default())
}

/// Leads a program to the first recorded reaction, if that is in the middle of a run: its timers go on as they would
/// have, while its sources send what they send first in the recording.
fn lead_in<P: Program, O: Observer>(program: &mut P, observer: &mut O) {
    let Some(Tap::Replay(replay)) = observer.tap() else { return };
    let Some(end) = replay.leads_in() else { return };
    let mut now = Time::ZERO;
    while now < end {
        now = match react(program, now, observer, &mut || Duration::ZERO).0 {
            Next::Now => now + STEP,
            Next::At(time) if time > now => time,
            Next::At(_) | Next::Input | Next::Exit(_) => break,
        };
    }
    if let Some(Tap::Replay(replay)) = observer.tap() {
        replay.end_lead_in();
    }
}

/// Returns the report if it has at least one reaction.
///
/// # Errors
/// No reaction was repeated, so that the replay proves nothing.
pub(super) fn something(report: Report, path: &Path) -> Result<Report, ReplayError> {
    match report.reactions {
        0 => Err(ReplayError::Nothing { path: path.to_owned(), why: report.cut }),
        _ => Ok(report),
    }
}
