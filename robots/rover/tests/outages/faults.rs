//! Nodes between the sensors and the robot, which spoil what comes.

use apex_nodes::scan::{Pose2, Scan};
use apex_rt::prelude::*;

/// Fault of a sensor.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Fault {
    #[default]
    None,
    /// The scanner sends nothing.
    ScanSilent,
    /// It sends the last scan again and again, with its stamp.
    ScanFrozen,
    /// All its beams measure NaN.
    ScanNan,
    /// They measure nothing within range, as if it were covered.
    ScanInfinite,
    /// They measure 0.
    ScanZero,
    /// It has no beams.
    ScanEmpty,
    /// The wheels send no pose.
    PoseSilent,
    /// They send the same pose again and again.
    PoseFrozen,
    PoseNan,
    /// They send a pose that is far from anything.
    PoseFar,
}

impl Fault {
    pub const ALL: [Self; 10] = [
        Self::ScanSilent,
        Self::ScanFrozen,
        Self::ScanNan,
        Self::ScanInfinite,
        Self::ScanZero,
        Self::ScanEmpty,
        Self::PoseSilent,
        Self::PoseFrozen,
        Self::PoseNan,
        Self::PoseFar,
    ];

    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::ScanSilent => "scanner silent",
            Self::ScanFrozen => "scanner frozen",
            Self::ScanNan => "scanner NaN",
            Self::ScanInfinite => "scanner ∞",
            Self::ScanZero => "scanner 0",
            Self::ScanEmpty => "scanner without beams",
            Self::PoseSilent => "odometry silent",
            Self::PoseFrozen => "odometry frozen",
            Self::PoseNan => "odometry NaN",
            Self::PoseFar => "odometry far away",
        }
    }
}

/// Spoils scans.
#[node]
#[derive(Default)]
pub struct ScanFault {
    fault: Fault,
    last: Option<Scan>,
}

#[node]
impl ScanFault {
    fn process(&mut self, scan: &Scan) -> Option<Scan> {
        let with = |range| Some(Scan { ranges: scan.ranges.iter().map(|_| range).collect(), ..scan.clone() });
        match self.fault {
            Fault::ScanSilent => None,
            Fault::ScanFrozen => self.last.clone(),
            Fault::ScanNan => with(f32::NAN),
            Fault::ScanInfinite => with(f32::INFINITY),
            Fault::ScanZero => with(0.0),
            Fault::ScanEmpty => Some(Scan { ranges: [].into_iter().collect(), ..scan.clone() }),
            _ => {
                self.last = Some(scan.clone());
                self.last.clone()
            }
        }
    }

    /// Begins or ends a fault.
    #[slot]
    fn begin(&mut self, fault: &Fault) {
        self.fault = *fault;
    }
}

/// Spoils poses.
#[node]
#[derive(Default)]
pub struct PoseFault {
    fault: Fault,
    last: Option<Pose2>,
}

#[node]
impl PoseFault {
    fn process(&mut self, pose: &Pose2) -> Option<Pose2> {
        match self.fault {
            Fault::PoseSilent => None,
            Fault::PoseFrozen => self.last,
            Fault::PoseNan => Some(Pose2::new(f32::NAN, pose.y, pose.theta)),
            Fault::PoseFar => Some(Pose2::new(5e6, pose.y, pose.theta)),
            _ => {
                self.last = Some(*pose);
                self.last
            }
        }
    }

    /// Begins or ends a fault.
    #[slot]
    fn begin(&mut self, fault: &Fault) {
        self.fault = *fault;
    }
}
