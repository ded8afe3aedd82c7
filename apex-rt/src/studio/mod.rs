//! Streams of running programs: what fires, what is active, what fails, and on demand the tokens of ports. Viewers, as
//! `apex studio` is one, connect to a socket; they can set parameters and, in simulated time, halt the program.
//!
//! A program that [`drive`](crate::drive) runs streams if the environment variable `APEX_STUDIO` has an address:
//! `HOST:PORT`, or the path of a socket. With `APEX_STUDIO_WAIT` a program in simulated time waits for a viewer that
//! lets it run.
//!
//! Viewers may set parameters if other machines cannot reach the address, and may only look otherwise; the environment
//! variable `APEX_STUDIO_ACCESS` (`read` or `write`) says so for any address. With `APEX_STUDIO_TOKEN` only viewers
//! with the same value are admitted. The robot notes on standard error who has set which parameter.

#[cfg(feature = "studio")]
mod access;
#[cfg(feature = "studio")]
mod asking;
#[cfg(feature = "studio")]
mod checkpoint;
#[cfg(feature = "studio")]
mod fork;
#[doc(hidden)]
pub mod message;
#[cfg(feature = "studio")]
mod robot;
#[cfg(feature = "studio")]
mod run;
#[cfg(feature = "studio")]
mod server;
#[cfg(feature = "studio")]
mod serving;
#[cfg(feature = "studio")]
mod shared;
mod socket;
#[cfg(feature = "studio")]
mod stream;
#[cfg(feature = "studio")]
mod times;
#[cfg(feature = "studio")]
mod viewer;

#[cfg(feature = "studio")]
pub use run::{StreamedTime, Studio};
#[doc(hidden)]
pub use socket::{connect, connect_until};
#[cfg(feature = "studio")]
pub use stream::Stream;
