//! The robot of the text, for hours of simulated time.

apex_rt::graph!("hours.afg");
