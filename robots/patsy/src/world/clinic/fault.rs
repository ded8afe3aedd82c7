use apex_sim::{Promise, Stops, fault_kinds};
use std::time::Duration;

/// Temporary fault of a device of the vehicle.
pub type Fault = apex_sim::Fault<FaultKind>;

fault_kinds! {
    /// Kind of a fault.
    pub enum FaultKind {
        /// The camera measures nothing.
        CameraBlack = "camera-black",
        /// The camera sends the same cloud repeatedly, with its stamp.
        CameraFrozen = "camera-frozen",
        /// The camera sends NaN as all values.
        CameraNan = "camera-nan",
        /// The scanner sends nothing.
        ScannerFrozen = "scanner-frozen",
        /// The wheel odometry sends the same pose repeatedly, and afterwards continues at its real pose.
        OdometryStopped = "odometry-stopped",
        /// The lift does not move.
        LiftJammed = "lift-jammed",
        /// The scanner measures NaN in all directions.
        ScannerNan = "scanner-nan",
        /// The scanner measures infinity in all directions.
        ScannerInfinite = "scanner-infinite",
        /// The scanner on the trailer sends nothing.
        RearFrozen = "rear-frozen",
        /// The scanner on the trailer measures NaN in all directions.
        RearNan = "rear-nan",
        /// The wheels and the hitch send nothing.
        OdometrySilent = "odometry-silent",
        /// The wheels send NaN.
        OdometryNan = "odometry-nan",
    }
}

impl FaultKind {
    /// Kinds whose cost is measured.
    pub const MEASURED: [Self; 6] = [
        Self::CameraBlack,
        Self::CameraFrozen,
        Self::CameraNan,
        Self::ScannerFrozen,
        Self::OdometryStopped,
        Self::LiftJammed,
    ];

    /// Kinds of faults of sensors.
    pub const OF_SENSORS: [Self; 11] = [
        Self::CameraBlack,
        Self::CameraFrozen,
        Self::CameraNan,
        Self::ScannerFrozen,
        Self::ScannerNan,
        Self::ScannerInfinite,
        Self::RearFrozen,
        Self::RearNan,
        Self::OdometryStopped,
        Self::OdometrySilent,
        Self::OdometryNan,
    ];

    /// Promises of the vehicle about each of [`OF_SENSORS`](Self::OF_SENSORS).
    pub fn promises() -> [Promise; Self::OF_SENSORS.len()] {
        Self::OF_SENSORS.map(Self::promise)
    }

    /// Promise of the vehicle without the sensor (`careful.afg`, `clinic.afg`). The stated times are those of the
    /// guards, that of their next firing, and 1 s in which the motors brake with 1 m/s² from 1 m/s.
    const fn promise(self) -> Promise {
        const fn after(ms: u64) -> Duration {
            Duration::from_millis(ms + 1000)
        }
        let (period, stops) = match self {
            // `SweepStop` does without a map for 0.6 s. Clouds come every 240 ms.
            Self::CameraBlack | Self::CameraFrozen | Self::CameraNan => (240, Stops::Within(after(600 + 80))),
            // `TrailerField` does without a scan for 0.5 s.
            Self::ScannerFrozen | Self::ScannerNan | Self::ScannerInfinite | Self::RearFrozen | Self::RearNan => {
                (80, Stops::Within(after(500 + 80)))
            }
            Self::OdometrySilent | Self::OdometryNan => (80, Stops::Within(after(80))),
            // `OdometryGuard` waits for more than 0.4 s.
            Self::OdometryStopped => (80, Stops::Tries(after(400 + 2 * 80))),
            Self::LiftJammed => (80, Stops::No),
        };
        Promise { fault: self.name(), period: Duration::from_millis(period), stops }
    }

    /// Duration of the fault: long enough to meet a lift that moves.
    pub const fn duration(self) -> Duration {
        Duration::from_secs(if matches!(self, Self::LiftJammed) { 60 } else { 10 })
    }
}

/// Text of a fault in tables.
pub fn words(fault: &Fault) -> String {
    let [from, until] = [fault.from, fault.until].map(|time| time.as_secs_f64());
    format!("{} from {from:.1} s to {until:.1} s", fault.kind.name())
}
