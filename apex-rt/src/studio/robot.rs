//! The robot, as its viewers act on it.

use super::{
    access::Access,
    asking::Asking,
    message::{self, Report},
    shared::Shared,
};
use std::{
    sync::{Arc, atomic::Ordering::Release},
    vec::Vec,
};

/// State of the robot that commands of viewers concern.
pub struct Robot {
    pub access: Access,
    pub shared: Arc<Shared>,
    pub asking: Asking,
    /// Description of the robot, as a message.
    pub about: Vec<u8>,
}

impl Robot {
    /// Describes the robot to a new viewer, in the bytes that it is sent.
    pub fn introduce(&self, out: &mut Vec<u8>) {
        self.shared.watched.store(true, Release);
        if self.access.readonly {
            message::write(&Report::ReadOnly, out);
        }
        out.extend_from_slice(&self.about);
        message::write(&self.shared.active_nodes(), out);
        if let Some(pace) = &self.shared.pace {
            message::write(&pace.report(), out);
        }
    }
}
