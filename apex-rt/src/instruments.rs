//! Observers of a program that [`drive`](crate::drive) runs: messages on standard error, and on request a profile, a
//! recording, a replay or a stream. All runs have the same type of observer, so that the program is compiled once for
//! them.

#[cfg(feature = "profile")]
use crate::profile::{self, Measures};
#[cfg(feature = "record")]
use crate::record::{self, RunMode, Tap};
use crate::{Clock, Ports, Program, StdErr, run::drive_groups};

/// The observers of a run, or of a thread group in it.
pub type Instruments<'a> = (StdErr, (Measured<'a>, (Tapped, Streamed)));

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

/// Observer that streams, if that was asked for.
#[cfg(feature = "studio")]
pub type Streamed = Option<crate::studio::Stream>;
/// Observer that streams: none without the feature.
#[cfg(not(feature = "studio"))]
pub type Streamed = ();

/// Streams of a run, if that was asked for.
#[derive(Default)]
pub struct Streams {
    #[cfg(feature = "studio")]
    studio: Option<crate::studio::Studio>,
}

impl Streams {
    /// Opens a socket for viewers if the environment asks for it.
    fn of<P: Program>(simulated: bool, ports: &Ports<P>) -> std::io::Result<Self> {
        #[cfg(feature = "studio")]
        {
            // A replay has the times of its recording.
            let simulated = simulated || matches!(RunMode::of::<P>(), Some(RunMode::Replay(_)));
            Ok(Self { studio: crate::studio::Studio::wanted::<P>(simulated, ports.requests())? })
        }
        #[cfg(not(feature = "studio"))]
        {
            let _ = (simulated, ports);
            Ok(Self::default())
        }
    }

    /// Returns the observer of a thread group.
    pub fn of_group(&self, group: usize) -> Streamed {
        #[cfg(feature = "studio")]
        return self.studio.as_ref().and_then(|studio| studio.stream(group));
        #[cfg(not(feature = "studio"))]
        let _ = group;
    }
}

/// Drives a program as the environment variables ask: see [`drive`](crate::drive).
pub fn drive<P: Program, C: Clock>(program: P, clock: C, ports: Ports<P>) -> u8 {
    let streams = match Streams::of(C::SIMULATED, &ports) {
        Ok(streams) => streams,
        Err(error) => {
            eprintln!("error: cannot open the socket in `APEX_STUDIO`: {error}");
            return 2;
        }
    };
    #[cfg(feature = "profile")]
    if let Some(path) = std::env::var_os("APEX_PROFILE") {
        return profile::drive(program, clock, ports, path.as_ref(), &streams);
    }
    #[cfg(feature = "record")]
    if let Some(mode) = RunMode::of::<P>() {
        return record::drive(program, clock, ports, &mode, &streams);
    }
    drive_groups(program, clock, ports, |group| -> Instruments<'_> {
        (StdErr(const { &P::INFO }), (Measured::default(), (Tapped::default(), streams.of_group(group))))
    })
}
