//! Recording and replay by [`drive`](crate::drive) and the `apex` command.

use super::{
    Finished, RecordOptions, Recorder, Replay, ReplayError, Report, RunMode, Tap, WhenFull,
    repeat::{repeat, something},
    threads::{record_from_threads, recorded_threads, replay_on_threads},
};
use crate::{
    Clock, Observer, Ports, Program, StdErr,
    drive::{drive_ports, pace_of_threads},
    instruments::{Instruments, Measured, Streams},
};
use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

/// Environment variable with the file for the report on a replay.
const REPORT: &str = "APEX_REPLAY_REPORT";
/// Drives a program and records it, or replays a recording of it. Returns the exit code.
pub(crate) fn drive<P: Program, C: Clock>(
    mut program: P,
    clock: C,
    ports: Ports<P>,
    mode: &RunMode,
    streams: &Streams,
) -> u8 {
    match mode {
        RunMode::Record(path, options) => {
            let options = options.or_environment();
            let code = options.and_then(|options| record(program, clock, ports, (path, options), streams));
            code.unwrap_or_else(|error| {
                eprintln!("error: cannot record to `{}`: {error}", path.display());
                2
            })
        }
        RunMode::Replay(path) => {
            match replay_with(&mut program, path, |group, tap| instruments::<P>(tap, streams, group)) {
                Ok(report) => {
                    tell(&report);
                    u8::from(!report.is_same() || !report.is_whole())
                }
                Err(error) => {
                    eprintln!("error: {error}");
                    2
                }
            }
        }
    }
}

/// Prints the report on a replay, or writes it as JSON to the file that the `apex` command wants.
fn tell(report: &Report) {
    match env::var_os(REPORT).map(PathBuf::from) {
        None => print!("{report}"),
        Some(path) => {
            if let Err(error) = fs::write(&path, report.json()) {
                eprintln!("error: cannot write `{}`: {error}", path.display());
            }
        }
    }
}

/// Returns the observers of a thread group in a run that is recorded or replayed by `tap`.
fn instruments<P: Program>(tap: Tap, streams: &Streams, group: usize) -> Instruments<'static> {
    (StdErr(const { &P::INFO }), (Measured::default(), (Some(tap), streams.of_group(group))))
}

fn record<P: Program, C: Clock>(
    mut program: P,
    clock: C,
    ports: Ports<P>,
    to: (&Path, RecordOptions),
    streams: &Streams,
) -> io::Result<u8> {
    crate::end::on_signals();
    let (code, finished) = match pace_of_threads::<P, _>(&clock) {
        Some(pace) => {
            let observer = |group, tap| instruments::<P>(tap, streams, group);
            record_from_threads(&mut program, pace, ports.0, to, observer)?
        }
        None => record_in_turn(program, clock, ports, to, streams)?,
    };
    match finished.files.as_slice() {
        [first, .., last] => eprintln!("recorded to `{}` to `{}`", first.display(), last.display()),
        _ => eprintln!("recorded to `{}`", finished.path.display()),
    }
    for (channel, count) in finished.dropped {
        eprintln!("warning: {count} messages of `{channel}` were lost: the file could not be written fast enough");
    }
    Ok(code)
}

/// Records a program that runs on one thread.
fn record_in_turn<P: Program, C: Clock>(
    program: P,
    clock: C,
    ports: Ports<P>,
    to: (&Path, RecordOptions),
    streams: &Streams,
) -> io::Result<(u8, Finished)> {
    let when_full = if C::SIMULATED { WhenFull::Wait } else { WhenFull::Drop };
    let tap = Tap::Record(Recorder::to_file_with::<P>(to.0, when_full, to.1)?);
    let mut observer = instruments::<P>(tap, streams, 0);
    let code = drive_ports(program, clock, &mut observer, ports);
    let (_, (_, (Some(Tap::Record(recorder)), _))) = observer else { unreachable!("it was made so") };
    Ok((code, recorder.finish()?))
}

/// Repeats the run that was recorded in `path`, and reports the differences. If its thread groups ran in parallel, they
/// do so again, each with a clone of `observer`.
///
/// ```
/// use apex_rt::{
///     drive_with,
///     prelude::*,
///     record::{Recorder, Tap, WhenFull, replay},
/// };
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let file = std::env::temp_dir().join(format!("apex-replay-{}.mcap", std::process::id()));
/// # let mut tap = Tap::Record(Recorder::to_file::<Blink>(&file, WhenFull::Wait)?);
/// # drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), &mut tap);
/// # if let Tap::Record(recorder) = tap {
/// #     recorder.finish()?;
/// # }
/// // A second that was recorded before, as the example of `Recorder` does.
/// let report = replay(Blink::new(), &file, ())?;
/// assert!(report.is_same() && report.is_whole());
/// assert_eq!((report.reactions, report.last), (50, Some(Time::from_millis(980))));
/// # std::fs::remove_file(file)?;
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The file is not a recording of such a program, or cannot be read.
pub fn replay<P: Program>(
    mut program: P,
    path: &Path,
    observer: impl Observer + Send + Clone,
) -> Result<Report, ReplayError> {
    replay_with(&mut program, path, |_, tap| (observer.clone(), tap))
}

/// Repeats a run with the observers that `observer` returns.
fn replay_with<P: Program, O: Observer + Send>(
    program: &mut P,
    path: &Path,
    observer: impl Fn(usize, Tap) -> O,
) -> Result<Report, ReplayError> {
    if let Some(threads) = recorded_threads(path)? {
        return replay_on_threads(program, path, &threads, observer);
    }
    let report = repeat(program, &mut observer(0, Tap::Replay(Replay::open::<P>(path)?)), || {});
    something(report.map_err(|error| ReplayError::File(path.to_owned(), error))?, path)
}
