use apex_nodes::scan::Scan;
use apex_sim::{Promise, Random, Stops, fault_kinds};
use std::time::Duration;

/// Temporary fault of a device of our robot.
pub type Fault = apex_sim::Fault<FaultKind>;

fault_kinds! {
    /// Kind of a fault.
    pub enum FaultKind {
        /// The front scanner sends nothing.
        LaserFrozen = "laser-frozen",
        /// The images of the front camera are black.
        CameraBlack = "camera-black",
        /// The images of the front camera have a wrong size: 17×3 and 0×0 alternately.
        CameraTorn = "camera-torn",
        /// The front scanner measures NaN in all directions.
        BeamsNan = "beams-nan",
        /// The front scanner measures infinity in all directions.
        BeamsInfinite = "beams-infinite",
        /// The front scanner measures 0 in all directions.
        BeamsZero = "beams-zero",
        /// Each beam of the front scanner measures infinity with a probability of ½.
        BeamsMissing = "beams-missing",
        /// The wheel odometry sends the same pose repeatedly, and afterwards continues at its real pose.
        OdometryStopped = "odometry-stopped",
        /// The front scanner sends the same scan repeatedly, with its stamp.
        LaserRepeated = "laser-repeated",
        /// The rear scanner sends nothing.
        RearFrozen = "rear-frozen",
        /// The wheel odometry sends nothing.
        OdometrySilent = "odometry-silent",
        /// The wheel odometry sends NaN.
        OdometryNan = "odometry-nan",
    }
}

impl FaultKind {
    /// Promises of the robot about each of [`ALL`](Self::ALL).
    pub fn promises() -> [Promise; Self::ALL.len()] {
        Self::ALL.map(Self::promise)
    }

    /// Promise of the robot without the sensor (`safety.afg`). The stated times are those of the guards, that of their
    /// next firing, and 0.75 s in which the base brakes with 2 m/s² from 1.5 m/s.
    const fn promise(self) -> Promise {
        const fn after(ms: u64) -> Duration {
            Duration::from_millis(ms + 750)
        }
        let (period, stops) = match self {
            // The fields do without a scan for 0.2 s.
            Self::LaserFrozen
            | Self::LaserRepeated
            | Self::RearFrozen
            | Self::BeamsNan
            | Self::BeamsInfinite
            | Self::BeamsZero => (40, Stops::Within(after(200 + 40))),
            Self::OdometrySilent | Self::OdometryNan => (40, Stops::Within(after(40))),
            // The guard waits for more than 0.4 s.
            Self::OdometryStopped => (40, Stops::Tries(after(400 + 2 * 40))),
            // Half of the beams show where the robot can drive, and so do all without a camera.
            Self::BeamsMissing => (40, Stops::No),
            Self::CameraBlack | Self::CameraTorn => (200, Stops::No),
        };
        Promise { fault: self.name(), period: Duration::from_millis(period), stops }
    }

    /// Faults that change the beams of a scan.
    pub(super) const OF_BEAMS: [Self; 4] = [Self::BeamsNan, Self::BeamsInfinite, Self::BeamsZero, Self::BeamsMissing];

    pub(super) fn spoil(self, scan: &mut Scan, random: &mut Random) {
        for range in &mut scan.ranges {
            *range = match self {
                Self::BeamsNan => f32::NAN,
                Self::BeamsInfinite => f32::INFINITY,
                Self::BeamsZero => 0.0,
                Self::BeamsMissing if random.chance(0.5) => f32::INFINITY,
                _ => *range,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Time;

    #[test]
    fn faults_are_read_as_they_are_written() {
        for kind in FaultKind::ALL {
            let fault = Fault { kind, from: Time::from_millis(1500), until: Time::from_secs(30) };
            assert_eq!(fault.to_string().parse(), Ok(fault));
        }
        let text = "laser-frozen@473.2s..476.2s";
        assert_eq!(text.parse::<Fault>().map(|fault| fault.to_string()), Ok(text.to_owned()));
    }

    #[test]
    fn what_is_no_fault_is_refused_with_the_reason() {
        for (text, reason) in [
            ("laser-frozen", "no `@`"),
            ("laser@1s..2s", "`laser` is no kind of fault; there are laser-frozen, camera-black"),
            ("beams-nan@1s", "no `..`"),
            ("beams-nan@1..2s", "`1` is no time"),
            ("beams-nan@-1s..2s", "`-1s` is no time"),
            ("beams-nan@1s..NaNs", "`NaNs` is no time"),
            ("beams-nan@1s..1e300s", "`1e300s` is no time"),
            ("beams-nan@2s..2s", "ends before it begins"),
        ] {
            let error = text.parse::<Fault>().expect_err(text);
            assert!(error.contains(reason), "{error}");
        }
    }
}
