//! The robot of `robot.afg`, with a battery that charges.

apex_macros::graph!("charging.afg");
