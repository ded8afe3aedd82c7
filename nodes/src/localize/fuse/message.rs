//! ROS 2 messages of inertial sensors and satellite positions.

use super::{GeoFix, Inertial};
use crate::{frames::Rotation, scan::message::FRAME};
use apex_messages::{
    Reason, converted,
    geometry_msgs::Vector3,
    sensor_msgs::{Imu, NavSatFix, NavSatStatus},
    std_msgs::Header,
};
use apex_rt::Time;

/// First element of a covariance of what is not measured (the definition of `sensor_msgs/msg/Imu`).
const UNKNOWN: f64 = -1.0;

/// The acceleration is not measured, and covariances are not known.
impl From<&Inertial> for Imu {
    fn from(inertial: &Inertial) -> Self {
        let [x, y, z] = inertial.angular_velocity;
        let mut linear_acceleration_covariance = [0.0; 9];
        linear_acceleration_covariance[0] = UNKNOWN;
        Self {
            header: Header::new(Time::ZERO, FRAME),
            orientation: (&inertial.rotation).into(),
            angular_velocity: Vector3 { x, y, z },
            linear_acceleration_covariance,
            ..Self::default()
        }
    }
}

/// A sensor that does not know its orientation counts as level.
impl TryFrom<Imu> for Inertial {
    type Error = Reason;

    fn try_from(message: Imu) -> Result<Self, Reason> {
        if message.angular_velocity_covariance[0] == UNKNOWN {
            return Err("it has no angular velocity".into());
        }
        let is_known = message.orientation_covariance[0] != UNKNOWN;
        let rotation = if is_known { Rotation::try_from(&message.orientation)? } else { Rotation::NONE };
        let Vector3 { x, y, z } = message.angular_velocity;
        Ok(Self { rotation, angular_velocity: [x, y, z] })
    }
}

converted!(Inertial as Imu);

impl From<&GeoFix> for NavSatFix {
    fn from(fix: &GeoFix) -> Self {
        let status = if fix.has_position { NavSatStatus::STATUS_FIX } else { NavSatStatus::STATUS_NO_FIX };
        let mut position_covariance = [0.0; 9];
        (position_covariance[0], position_covariance[4]) = (fix.variance, fix.variance);
        let is_known = fix.variance != 0.0;
        Self {
            header: Header::new(fix.stamp, FRAME),
            status: NavSatStatus { status, service: NavSatStatus::SERVICE_GPS },
            latitude: fix.latitude,
            longitude: fix.longitude,
            altitude: fix.altitude,
            position_covariance,
            position_covariance_type: if is_known {
                Self::COVARIANCE_TYPE_APPROXIMATED
            } else {
                Self::COVARIANCE_TYPE_UNKNOWN
            },
        }
    }
}

/// A status that is not known is that of a receiver without a position.
impl TryFrom<NavSatFix> for GeoFix {
    type Error = Reason;

    fn try_from(message: NavSatFix) -> Result<Self, Reason> {
        let [east, north] = [message.position_covariance[0], message.position_covariance[4]];
        let is_known = message.position_covariance_type != NavSatFix::COVARIANCE_TYPE_UNKNOWN;
        Ok(Self {
            stamp: message.header.stamp.into(),
            has_position: message.status.status >= NavSatStatus::STATUS_FIX,
            latitude: message.latitude,
            longitude: message.longitude,
            altitude: message.altitude,
            variance: if is_known { if north > east { north } else { east } } else { 0.0 },
        })
    }
}

converted!(GeoFix as NavSatFix);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::message::tests::{again, bytes, reason};
    use apex_messages::Message as _;

    #[test]
    fn tokens_come_back_and_parts_of_them_do_not() {
        let rotation = Rotation::from_rpy(0.1, -0.2, 0.3);
        let inertial = Inertial { rotation, angular_velocity: [0.1, -0.0, 1e-300] };
        let fix = GeoFix {
            stamp: Time::from_nanos(-7),
            has_position: true,
            latitude: 48.5,
            longitude: -9.05,
            altitude: f64::INFINITY,
            variance: 2.3,
        };
        assert_eq!(again(&bytes(&inertial)), Some(inertial));
        for fix in [fix, GeoFix { has_position: false, variance: 0.0, ..fix }] {
            assert_eq!(again(&bytes(&fix)), Some(fix));
        }
        let (inertial, fix) = (bytes(&inertial), bytes(&fix));
        assert!((0..inertial.len()).all(|length| again::<Inertial>(&inertial[..length]).is_none()));
        assert!((0..fix.len()).all(|length| again::<GeoFix>(&fix[..length]).is_none()));
    }

    #[test]
    fn what_a_sensor_does_not_measure_is_not_used() {
        let mut imu = Imu { angular_velocity: Vector3 { x: 0.0, y: 0.0, z: 0.5 }, ..Imu::default() };
        imu.orientation.w = 0.0;
        assert!(reason::<Inertial>(&imu.to_bytes()).is_err_and(|why| why.contains("has not set it")));
        imu.orientation_covariance[0] = -1.0;
        assert_eq!(again(&imu.to_bytes()), Some(Inertial::level(0.5)));
        imu.angular_velocity_covariance[0] = -1.0;
        assert!(reason::<Inertial>(&imu.to_bytes()).is_err());
        let mut fix = NavSatFix { position_covariance: [3.0; 9], ..NavSatFix::default() };
        fix.status.status = NavSatStatus::STATUS_UNKNOWN;
        assert_eq!(again(&fix.to_bytes()), Some(GeoFix::default()));
    }
}
