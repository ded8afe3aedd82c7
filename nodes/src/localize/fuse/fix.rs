use crate::scan::Point2;
use apex_rt::{Time, Units, node};
use core::f64::consts::{FRAC_PI_2, TAU};
use libm::{cos, sin, sincos, sqrt};

/// Ellipsoid of WGS 84: semi-major axis in m, and the square of its eccentricity (NIMA TR8350.2, 2000, tables 3.1 and
/// 3.3).
const AXIS: f64 = 6_378_137.0;
const ECCENTRICITY: f64 = 6.694_379_990_14e-3;
/// Farthest position on a tangent plane that is used, in m.
const FARTHEST: f64 = 1e5;

/// Measurement of a receiver of satellite navigation (GNSS), as `sensor_msgs/msg/NavSatFix` has it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GeoFix {
    /// Time of the measurement, which is before it arrives.
    pub stamp: Time,
    /// `false` if the receiver knows no position.
    pub has_position: bool,
    /// Latitude, in degrees, positive to the north.
    pub latitude: f64,
    /// Longitude, in degrees, positive to the east.
    pub longitude: f64,
    /// Height above the ellipsoid, in m. NaN if it is not known.
    pub altitude: f64,
    /// Variance of the position to the east and to the north (the larger one), in m²; 0 if it is not known.
    pub variance: f64,
}

impl GeoFix {
    /// Returns `true` if the receiver knows a position that is one on the earth.
    pub fn is_usable(&self) -> bool {
        // False for NaN.
        self.has_position && self.latitude.abs() <= 90.0 && self.longitude.abs() <= 360.0
    }
}

/// Position on a plane, and the time at which it was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PositionFix {
    /// Time of the measurement, which is before it arrives.
    pub stamp: Time,
    /// Position of the antenna, in m.
    pub position: Point2,
    /// Variance along each axis, in m²; 0 if it is not known.
    pub variance: f32,
}

/// Plane that touches the earth at its origin. Its x axis points to the east, its y axis to the north (ENU, as in
/// REP 103). Heights above the ellipsoid are left out: on a plane of some kilometres a height h changes positions by
/// h / 6378 km of their distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentPlane {
    /// Origin, in the Cartesian frame of the earth, in m.
    origin: [f64; 3],
    latitude: f64,
    longitude: f64,
}

impl TangentPlane {
    /// Creates the plane at a latitude and a longitude, in rad.
    pub fn new(latitude: f64, longitude: f64) -> Self {
        Self { origin: of_earth(latitude, longitude), latitude, longitude }
    }

    /// East and north position of a latitude and a longitude, in rad, in m (Farrell: Aided Navigation, 2008, 2.3.2 and
    /// 2.5.2).
    pub fn position(&self, latitude: f64, longitude: f64) -> [f64; 2] {
        let point = of_earth(latitude, longitude);
        let [x, y, z]: [f64; 3] = core::array::from_fn(|i| point[i] - self.origin[i]);
        let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (sincos(self.latitude), sincos(self.longitude));
        [y * cos_lon - x * sin_lon, z * cos_lat - sin_lat * (x * cos_lon + y * sin_lon)]
    }

    /// Position of a fix. `None` for one without a position, one that is not a number or not on the earth, and one
    /// farther than 100 km from the origin.
    pub fn place(&self, fix: &GeoFix) -> Option<PositionFix> {
        if !fix.is_usable() {
            return None;
        }
        let [x, y] = self.position(fix.latitude.to_radians(), fix.longitude.to_radians());
        let is_near = x.abs() <= FARTHEST && y.abs() <= FARTHEST;
        let position = Point2::new(x as f32, y as f32);
        is_near.then_some(PositionFix { stamp: fix.stamp, position, variance: fix.variance as f32 })
    }

    /// Latitude and longitude of a position within some kilometres of the origin, in rad.
    pub fn geodetic(&self, [east, north]: [f64; 2]) -> [f64; 2] {
        let (mut latitude, mut longitude) = (self.latitude, self.longitude);
        // By the radii of curvature; the error becomes a thousandth each time.
        for _ in 0..4 {
            let [x, y] = self.position(latitude, longitude);
            let square = 1.0 - ECCENTRICITY * sin(latitude) * sin(latitude);
            let prime = AXIS / sqrt(square);
            let meridian = prime * (1.0 - ECCENTRICITY) / square;
            latitude += (north - y) / meridian;
            longitude += (east - x) / (prime * cos(latitude));
        }
        [latitude, longitude]
    }
}

/// Point of the ellipsoid in the Cartesian frame of the earth, in m.
fn of_earth(latitude: f64, longitude: f64) -> [f64; 3] {
    let ((sin_lat, cos_lat), (sin_lon, cos_lon)) = (sincos(latitude), sincos(longitude));
    let prime = AXIS / sqrt(1.0 - ECCENTRICITY * sin_lat * sin_lat);
    [prime * cos_lat * cos_lon, prime * cos_lat * sin_lon, prime * (1.0 - ECCENTRICITY) * sin_lat]
}

/// Position of a satellite fix on the plane that touches the earth at an origin: x to the east, y to the north, in m.
/// The origin is that of the parameters, or the first position that is known.
///
/// `position` is ⊥ for a fix without a position, one that is not a number or not on the earth, and one farther than
/// 100 km from the origin.
#[node]
#[derive(Debug, Clone, Default)]
pub struct PlaceFix {
    /// `true` if the origin is the first position.
    #[param(default = true)]
    from_first: bool,
    /// Latitude of the origin.
    #[param(unit = "rad", default = 0.0, range = -FRAC_PI_2..=FRAC_PI_2)]
    latitude: f64,
    /// Longitude of the origin.
    #[param(unit = "rad", default = 0.0, range = -TAU..=TAU)]
    longitude: f64,
    plane: Option<TangentPlane>,
}

#[node]
impl PlaceFix {
    fn process(&mut self, fix: &GeoFix) -> Option<PositionFix> {
        if !fix.is_usable() {
            return None;
        }
        let first = [fix.latitude.to_radians(), fix.longitude.to_radians()];
        let origin = if self.from_first { first } else { [self.latitude, self.longitude] };
        self.plane.get_or_insert_with(|| TangentPlane::new(origin[0], origin[1])).place(fix)
    }

    /// Forgets an origin that is a first position: the next one is another.
    #[slot]
    fn reset(&mut self) {
        self.plane = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn distances_on_the_earth_are_known() {
        // Lengths of a degree at 45°, of NGA's calculator: 111131.745 m of latitude, 78846.806 m of longitude. The
        // plane is below the ellipsoid at that distance, by about d³ / 6 R².
        let plane = TangentPlane::new(45_f64.to_radians(), 0.0);
        let [_, north] = plane.position(45.01_f64.to_radians(), 0.0);
        let [east, _] = plane.position(45_f64.to_radians(), 0.01_f64.to_radians());
        assert!((north - 1111.317).abs() < 0.1 && (east - 788.468).abs() < 0.01, "{north} {east}");
        let equator = TangentPlane::new(0.0, 3.0).position(0.0, 3.001);
        assert!((equator[0] - AXIS * sin(0.001)).abs() < 1e-6 && equator[1].abs() < 1e-9, "{equator:?}");
    }

    #[test]
    fn positions_come_back() {
        let plane = TangentPlane::new(0.847, -2.1);
        for place in [[0.0, 0.0], [350.0, -1200.0], [-5000.0, 4000.0]] {
            let [latitude, longitude] = plane.geodetic(place);
            let back = plane.position(latitude, longitude);
            assert!((back[0] - place[0]).abs() < 1e-4 && (back[1] - place[1]).abs() < 1e-4, "{back:?}");
        }
    }

    fn fix(latitude: f64, longitude: f64) -> GeoFix {
        GeoFix { has_position: true, latitude, longitude, variance: 2.0, ..GeoFix::default() }
    }

    #[test]
    fn the_first_position_is_the_origin() {
        let mut node = PlaceFix::construct((true, 0.0, 0.0));
        assert_eq!(node.process(&GeoFix { has_position: false, ..fix(48.5, 9.05) }), None);
        let at = |fix: Option<PositionFix>| fix.map(|fix| fix.position);
        assert_eq!(at(node.process(&fix(48.5, 9.05))), Some(Point2::default()));
        let north = at(node.process(&fix(48.501, 9.05))).expect("near");
        assert!((north.y - 111.2).abs() < 0.1 && north.x.abs() < 1e-3, "{north:?}");
        node.reset();
        assert_eq!(at(node.process(&fix(48.501, 9.05))), Some(Point2::default()));
    }

    #[test]
    fn what_is_no_position_is_none() {
        let mut node = PlaceFix::construct((false, 48.5_f64.to_radians(), 9.0_f64.to_radians()));
        for odd in [fix(f64::NAN, 9.0), fix(48.5, f64::INFINITY), fix(91.0, 9.0), fix(52.0, 13.0), fix(48.5, 1e9)] {
            assert_eq!(node.process(&odd), None, "{odd:?}");
        }
        assert!(node.process(&fix(48.5, 9.0)).is_some_and(|fix| fix.position.norm() < 1e-6 && fix.variance == 2.0));
    }
}
