//! Observers of a program that [`drive`](crate::drive) runs: messages on standard error, and on request a profile, a
//! recording, a replay or a stream. All runs have the same type of observer, so that the program is compiled once for
//! them.

#[cfg(feature = "profile")]
use crate::profile::Measures;
#[cfg(feature = "record")]
use crate::record::Tap;
use crate::{Ports, Program, StdErr};

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
    pub fn of<P: Program>(simulated: bool, ports: &Ports<P>) -> std::io::Result<Self> {
        #[cfg(feature = "studio")]
        {
            use crate::record::RunMode;
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
