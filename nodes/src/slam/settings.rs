use super::Window;

/// Settings of a [`Mapper`](super::Mapper).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Distance after which a new scan is kept, in m.
    pub travel: f64,
    /// Rotation after which a new scan is kept, in rad.
    pub turn: f64,
    /// Maximum distance of the used points, in m.
    pub reach: f64,
    /// Side of the cells for the comparison of scans, in m.
    pub resolution: f64,
    /// Standard deviation of the distance between two measurements of the same object, in m.
    pub correlation_sigma: f64,
    /// Number of previous scans that a scan is compared with.
    pub window_scans: usize,
    /// Maximum error of odometry between two kept scans.
    pub window: Window,
    /// Minimum response of a scan that agrees with those before. With the other defaults it was at least 0.45 on the
    /// recordings of two buildings; after the robot was carried away, it was below 0.4 in 83 to 91 % of the cases.
    pub least_response: f64,
    /// Drift of a pose per metre of the path, in m.
    pub drift: f64,
    /// Maximum drift that is searched for a loop, in m.
    pub loop_distance: f64,
    /// Minimum response that closes a loop.
    pub loop_response: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            travel: 0.3,
            turn: 0.35,
            reach: 20.0,
            resolution: 0.05,
            correlation_sigma: 0.06,
            window_scans: 20,
            window: Window { distance: 0.4, angle: 0.35 },
            least_response: 0.4,
            drift: 0.04,
            loop_distance: 4.0,
            loop_response: 0.6,
        }
    }
}
