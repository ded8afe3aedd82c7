//! Observers of a program that [`drive`](crate::drive) runs: messages on standard error, and on request a profile, a
//! recording or a replay. All runs have the same type of observer, so that the program is compiled once for them.

#[cfg(feature = "profile")]
use crate::profile::{self, Measures};
#[cfg(feature = "record")]
use crate::record::{self, RunMode, Tap};
use crate::{Clock, Ports, Program, StdErr, run::drive_groups};

/// The observers of a run, or of a thread group in it.
pub type Instruments<'a> = (StdErr, (Measured<'a>, Tapped));

/// Observer that measures, if that was asked for.
#[cfg(feature = "profile")]
pub type Measured<'a> = Option<Measures<'a>>;
/// Observer that measures: none without the feature.
#[cfg(not(feature = "profile"))]
pub type Measured<'a> = core::marker::PhantomData<&'a ()>;

/// Observer that records or replays, if that was asked for.
#[cfg(feature = "record")]
pub type Tapped = Option<Tap>;
/// Observer that records or replays: none without the feature.
#[cfg(not(feature = "record"))]
pub type Tapped = ();

/// Drives a program as the environment variables ask: see [`drive`](crate::drive).
pub fn drive<P: Program, C: Clock>(program: P, clock: C, ports: Ports<P>) -> u8 {
    #[cfg(feature = "profile")]
    if let Some(path) = std::env::var_os("APEX_PROFILE") {
        return profile::drive(program, clock, ports, path.as_ref());
    }
    #[cfg(feature = "record")]
    if let Some(mode) = RunMode::of::<P>() {
        return record::drive(program, clock, ports, &mode);
    }
    drive_groups(program, clock, ports, |_| -> Instruments<'_> {
        (StdErr(const { &P::INFO }), (Measured::default(), Tapped::default()))
    })
}
