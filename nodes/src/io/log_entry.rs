use crate::scan::Pose2;
use apex_rt::Time;

/// Information of a log about a scan besides its ranges.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LogEntry {
    /// Number of the scan: the first column of a table, or counted from 0 in a CARMEN log.
    pub id: u64,
    /// Pose of the scanner, if the log contains it.
    pub pose: Option<Pose2>,
    /// Pose of the robot by its odometry, if the log contains it.
    pub odometry: Option<Pose2>,
    /// Time of the scan since the zero of the recording's clock, if the log contains it.
    pub time: Option<Time>,
}
