use apex_rt::Time;
use std::{fmt, time::Duration};

/// Temporary fault of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fault {
    /// Kind of the fault.
    pub kind: FaultKind,
    /// Start of the fault.
    pub from: Time,
    /// End of the fault.
    pub until: Time,
}

/// Kind of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// The camera measures nothing.
    CameraBlack,
    /// The camera sends the same cloud repeatedly, with its stamp.
    CameraFrozen,
    /// The camera sends NaN as all values.
    CameraNan,
    /// The scanner sends nothing.
    ScannerFrozen,
    /// The wheel odometry sends the same pose repeatedly, and afterwards continues at its real pose.
    OdometryStopped,
    /// The lift does not move.
    LiftJammed,
}

impl FaultKind {
    /// All kinds of faults.
    pub const ALL: [Self; 6] = [
        Self::CameraBlack,
        Self::CameraFrozen,
        Self::CameraNan,
        Self::ScannerFrozen,
        Self::OdometryStopped,
        Self::LiftJammed,
    ];

    /// Name of the fault on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::CameraBlack => "camera-black",
            Self::CameraFrozen => "camera-frozen",
            Self::CameraNan => "camera-nan",
            Self::ScannerFrozen => "scanner-frozen",
            Self::OdometryStopped => "odometry-stopped",
            Self::LiftJammed => "lift-jammed",
        }
    }

    /// Kind of a name.
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Duration of the fault: long enough to meet a lift that moves.
    pub const fn duration(self) -> Duration {
        Duration::from_secs(if matches!(self, Self::LiftJammed) { 60 } else { 10 })
    }
}

impl Fault {
    pub(super) fn is_on(&self, kind: FaultKind, now: Time) -> bool {
        self.kind == kind && self.from <= now && now < self.until
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} from {:.1} s to {:.1} s", self.kind.name(), self.from.as_secs_f64(), self.until.as_secs_f64())
    }
}
