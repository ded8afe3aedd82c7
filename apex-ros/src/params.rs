//! The parameters of a program as those of its node in ROS 2.

use crate::{Error, Ros};
use apex_rt::RemoteParams;

impl Ros {
    /// Offers the parameters of a program as those of the node.
    ///
    /// # Errors
    /// The services cannot be declared.
    pub fn serve_params(&self, params: RemoteParams) -> Result<(), Error> {
        let _ = params;
        Ok(())
    }
}
