use apex_sim::fault_kinds;

/// Temporary fault of a sensor of the robot.
pub type Fault = apex_sim::Fault<FaultKind>;

fault_kinds! {
    /// Kind of a fault.
    pub enum FaultKind {
        /// The receiver has no position.
        GnssSilent = "gnss-silent",
        /// All positions of the receiver are 20 m too far to the east.
        GnssJump = "gnss-jump",
        /// The gyroscope measures NaN, the inclination is right.
        GyroNan = "gyro-nan",
        /// The wheels send nothing.
        WheelsSilent = "wheels-silent",
    }
}
