//! A robot, as far as it concerns an app.

use crate::{robot::Shared, source::Replayed};
use std::sync::Arc;

/// A robot that an app looks at.
pub struct Seen {
    pub shared: Arc<Shared>,
    /// `true` if the app may only look.
    pub readonly: bool,
    /// `true` if the robot can go back in time.
    pub travels: bool,
    /// The recording that it repeats, if it repeats one.
    pub replayed: Option<Replayed>,
}
