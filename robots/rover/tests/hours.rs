//! The robot of `robot.afg`, for hours of simulated time.

apex_rt::graph!("hours.afg");
