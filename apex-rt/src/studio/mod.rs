//! Streams of running programs: what fires, what is active, what fails, and on demand the tokens of ports. Viewers, as
//! `apex studio` is one, connect to a socket; they can set parameters and, in simulated time, halt the program.
//!
//! A program that [`drive`](crate::drive) runs streams if the environment variable `APEX_STUDIO` has an address:
//! `HOST:PORT`, or the path of a socket. With `APEX_STUDIO_WAIT` a program in simulated time waits for a viewer that
//! lets it run. Anyone who can connect can set parameters: use addresses that others cannot reach, such as
//! `127.0.0.1:7400`.

#[cfg(feature = "studio")]
mod checkpoint;
#[cfg(feature = "studio")]
mod fork;
pub mod message;
#[cfg(feature = "studio")]
mod run;
#[cfg(feature = "studio")]
mod server;
#[cfg(feature = "studio")]
mod shared;
mod socket;
#[cfg(feature = "studio")]
mod stream;
#[cfg(feature = "studio")]
mod times;

#[cfg(feature = "studio")]
pub use run::{StreamedTime, Studio};
pub use socket::connect;
#[cfg(feature = "studio")]
pub use stream::Stream;
