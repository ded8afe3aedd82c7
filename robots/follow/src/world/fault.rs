use apex_sim::fault_named;
use std::{fmt, str::FromStr};

/// Temporary fault of a sensor of the robot.
pub type Fault = apex_sim::Fault<FaultKind>;

/// Kind of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// The receiver has no position.
    GnssSilent,
    /// All positions of the receiver are 20 m too far to the east.
    GnssJump,
    /// The gyroscope measures NaN, the inclination is right.
    GyroNan,
    /// The wheels send nothing.
    WheelsSilent,
}

impl FaultKind {
    /// All kinds of faults.
    pub const ALL: [Self; 4] = [Self::GnssSilent, Self::GnssJump, Self::GyroNan, Self::WheelsSilent];

    /// Name of the fault on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::GnssSilent => "gnss-silent",
            Self::GnssJump => "gnss-jump",
            Self::GyroNan => "gyro-nan",
            Self::WheelsSilent => "wheels-silent",
        }
    }
}

impl FromStr for FaultKind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        fault_named(text, &Self::ALL, Self::name)
    }
}

impl fmt::Display for FaultKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
