//! Drives a program with the parameters and the clock of its node.

use crate::{Error, Ros, params::SIM_TIME, params_file::FileParam, time::RosTime};
use apex_rt::{
    Ports, Program, UntilStopped, drive_from,
    params::{ParamError, set_text},
};
use std::thread;

impl Ros {
    /// Sets the parameters of the program that the arguments name: those in files, then those of
    /// `--ros-args -p mission.near:=0.5`. A parameter that a file has for nodes by a pattern, as `/**`, may be missing.
    ///
    /// # Errors
    /// The program has no such parameter, or its value is of another type or out of range.
    pub fn set_params<P: Program>(&self, program: &mut P) -> Result<(), Error> {
        for FileParam { name, value, place, is_named } in &self.args().file_params {
            match set_text(program, name, value) {
                Err(ParamError::Unknown { .. }) if !is_named || name == SIM_TIME => {}
                Err(error @ ParamError::Unknown { .. }) => {
                    return Err(Error::new(format!("{place}: `{name}`: {}", listed::<P>(error))));
                }
                Err(error) => return Err(Error::new(format!("{place}: {error}"))),
                Ok(()) => {}
            }
        }
        for (name, value) in self.args().params.iter().filter(|(name, _)| name != SIM_TIME) {
            let wrong = |error: &dyn std::fmt::Display| Error::new(format!("`-p {name}:={value}`: {error}"));
            let value = crate::args::toml(value).map_err(|error| wrong(&error))?;
            set_text(program, name, &value).map_err(|error| wrong(&listed::<P>(error)))?;
        }
        Ok(())
    }

    /// Drives a program with these ports by [`Ros::clock`] until it ends, or until Ctrl-C. Its parameters are those of
    /// the node, and its problems are in `/rosout` and `/diagnostics`. Returns the exit code.
    ///
    /// # Errors
    /// The errors of [`Ros::set_params`], [`Ros::serve_params`] and [`Ros::report`].
    pub fn drive<P>(&self, mut program: P, ports: Ports<P>) -> Result<u8, Error>
    where
        P: Program,
    {
        self.set_params(&mut program)?;
        self.serve_params(ports.params())?;
        self.report(P::INFO.name)?;
        let clock = self.clock();
        if !matches!(self.endpoints.time, RosTime::Simulated(_)) {
            return Ok(drive_from(program, clock, ports));
        }
        let clock = UntilStopped::ctrl_c(clock).map_err(Error::new)?;
        // The first `/clock` is the program's zero.
        while !self.endpoints.time.is_known() && !clock.is_stopped() {
            thread::sleep(crate::time::LOOK);
        }
        Ok(drive_from(program, clock, ports))
    }
}

/// Text of an error, with all names if no parameter of the program has a similar one.
fn listed<P: Program>(error: ParamError) -> String {
    let names: Vec<String> = P::PARAMS.iter().map(|param| format!("`{}`", param.name)).collect();
    match error {
        ParamError::Unknown { nearest: None } if names.is_empty() => "the program has no parameters".to_owned(),
        ParamError::Unknown { nearest: None } => {
            format!("there is no parameter of this name; those of the program are {}", names.join(", "))
        }
        error => error.to_string(),
    }
}
