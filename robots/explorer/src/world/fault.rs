use apex_sim::{Promise, Stops, fault_kinds};
use std::time::Duration;

/// Temporary fault of a device of the robot.
pub type Fault = apex_sim::Fault<FaultKind>;

/// Period of all sensors.
const PERIOD: Duration = Duration::from_millis(50);

fault_kinds! {
    /// Kind of a fault.
    pub enum FaultKind {
        /// The scanner sends nothing.
        LaserSilent = "laser-silent",
        /// The scanner sends the same scan repeatedly, with its stamp.
        LaserRepeated = "laser-repeated",
        /// The scanner measures infinity in all directions.
        BeamsInfinite = "beams-infinite",
        /// The wheels send nothing.
        WheelsSilent = "wheels-silent",
        /// The wheels send NaN.
        WheelsNan = "wheels-nan",
        /// The wheels send the same pose repeatedly, and afterwards continue at their real pose.
        WheelsStopped = "wheels-stopped",
        /// The gauge of the battery sends nothing.
        ChargeSilent = "charge-silent",
        /// The images of the camera are black.
        EyeBlack = "eye-black",
    }
}

impl FaultKind {
    /// Promises of the robot about each of [`ALL`](Self::ALL).
    pub fn promises() -> [Promise; Self::ALL.len()] {
        Self::ALL.map(Self::promise)
    }

    /// Promise of the robot without the sensor. The stated times are those of the guards, that of their next firing,
    /// and 0.6 s in which the base brakes with 1 m/s² from 0.6 m/s.
    const fn promise(self) -> Promise {
        const fn after(ms: u64) -> Duration {
            Duration::from_millis(ms + 50 + 600)
        }
        let stops = match self {
            Self::LaserSilent | Self::LaserRepeated | Self::BeamsInfinite => Stops::Within(after(500)),
            Self::WheelsSilent | Self::WheelsNan => Stops::Within(after(0)),
            // The guard waits for more than 0.4 s.
            Self::WheelsStopped => Stops::Tries(after(400 + 50)),
            Self::ChargeSilent | Self::EyeBlack => Stops::No,
        };
        Promise { fault: self.name(), period: PERIOD, stops }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_are_read_as_they_are_written() {
        for kind in FaultKind::ALL {
            let text = format!("{kind}@1.5s..30s");
            assert_eq!(text.parse::<Fault>().map(|fault| fault.to_string()), Ok(text));
        }
        assert!("laser@1s..2s".parse::<Fault>().is_err());
    }
}
