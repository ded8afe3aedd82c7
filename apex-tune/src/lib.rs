//! Studies that optimize the parameters of a robot (thesis 3.6.4, 9.3.1).
//!
//! A [`Study`] evaluates candidates on the same seeds, in parallel and with the same result on any number of threads.
//! A candidate that cannot win any more is stopped, which does not change the result either. Every run is written to a
//! [`Journal`] when it ends: an interrupted study continues from there, and the journals of several machines are
//! merged. The [`Report`] scores the result on seeds that the study has not seen. A [`Follower`] reads a journal while
//! it grows, and shows the candidates of the study.

mod bound;
mod changes;
mod course;
mod description;
mod follow;
mod goal;
mod journal;
mod picture;
mod race;
mod report;
mod sample;
mod searching;
mod seen;
mod study;
mod summary;
mod timed;

pub use apex_optim::{Axis, BadAxis, Best, Scale};
pub use follow::Follower;
pub use goal::{Goal, Point};
pub use journal::{Journal, JournalError, Lock, Run};
pub use report::{Report, Score};
pub use searching::{Known, Objective, Progress, StudyError, on_threads};
pub use seen::{Candidate, Fate, Seen, Trail};
pub use study::{Found, Method, Parameter, Shown, Study};
pub use summary::Summary;
pub use timed::Timed;
