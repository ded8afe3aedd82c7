//! Implementations of DDS below ROS 2, which differ in how a response names its request.

use apex_ros::Error;
use std::env;

/// Implementation of DDS that the other programs use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Vendor {
    /// Cyclone DDS: the request is named in the first 16 bytes of the message.
    Cyclone,
    /// Fast DDS: the request is named beside the message.
    Fast,
}

/// Environment variable by which programs of ROS 2 choose the implementation.
const VARIABLE: &str = "RMW_IMPLEMENTATION";

impl Vendor {
    /// Returns the vendor in the environment. It is not guessed: the wrong one makes servers of the other one read
    /// nonsense.
    ///
    /// # Errors
    /// There is none, or an unknown one.
    pub fn of_environment() -> Result<Self, Error> {
        Self::of(env::var(VARIABLE).ok().as_deref())
    }

    fn of(name: Option<&str>) -> Result<Self, Error> {
        match name {
            Some("rmw_cyclonedds_cpp") => Ok(Self::Cyclone),
            Some("rmw_fastrtps_cpp" | "rmw_fastrtps_dynamic_cpp") => Ok(Self::Fast),
            Some(other) => Err(Error::new(format!(
                "`{VARIABLE}` is `{other}`: services over DDS are known for `rmw_cyclonedds_cpp` and \
                 `rmw_fastrtps_cpp`"
            ))),
            None => Err(Error::new(format!(
                "services differ between implementations of DDS: set `{VARIABLE}` as the other programs have it, to \
                 `rmw_fastrtps_cpp` (the default of ROS 2) or `rmw_cyclonedds_cpp`"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vendor_is_not_guessed() {
        assert_eq!(Vendor::of(Some("rmw_cyclonedds_cpp")), Ok(Vendor::Cyclone));
        assert_eq!(Vendor::of(Some("rmw_fastrtps_cpp")), Ok(Vendor::Fast));
        let why = Vendor::of(None).expect_err("none").to_string();
        assert!(why.contains("set `RMW_IMPLEMENTATION`"), "{why}");
        let why = Vendor::of(Some("rmw_zenoh_cpp")).expect_err("another one").to_string();
        assert!(why.starts_with("`RMW_IMPLEMENTATION` is `rmw_zenoh_cpp`"), "{why}");
    }
}
