//! The robot of `robot.afg`, for hours of simulated time.

apex_macros::graph!("hours.afg");
