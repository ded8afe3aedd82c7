//! Transforms between frames: `/tf` and `/tf_static`.

use crate::{Error, Publisher, Ros};
use apex_messages::{
    geometry_msgs::{Transform, TransformStamped},
    std_msgs::Header,
    tf2_msgs::TFMessage,
};
use apex_nodes::scan::Pose2;
use apex_rt::{PortReceiver, Time};

impl Ros {
    /// Publishes the poses that an event has as the transform between two frames in `/tf`: the pose of `child` in
    /// `parent`, at the time at which it is sent.
    ///
    /// # Errors
    /// The publisher cannot be declared.
    pub fn transform(&self, parent: &str, child: &str, port: PortReceiver<Pose2>) -> Result<(), Error> {
        let publisher: Publisher<TFMessage> = self.publish("/tf").depth(100).quiet().open()?;
        let (parent, child, tell) = (parent.to_owned(), child.to_owned(), self.endpoints.tell.clone());
        self.endpoints.spawn("/tf", move || {
            while let Some(pose) = port.receive() {
                if let Err(error) = publisher.send(&message(&parent, &child, &pose)) {
                    tell(&error.to_string());
                    break;
                }
            }
        })
    }

    /// Publishes a transform that does not change, in `/tf_static`: that of a sensor on its robot.
    ///
    /// # Errors
    /// The publisher cannot be declared.
    pub fn static_transform(&self, parent: &str, child: &str, pose: &Pose2) -> Result<(), Error> {
        let publisher: Publisher<TFMessage> = self.publish("/tf_static").transient_local().depth(1).quiet().open()?;
        publisher.send(&message(parent, child, pose))?;
        self.endpoints.keep(publisher);
        Ok(())
    }
}

fn message(parent: &str, child: &str, pose: &Pose2) -> TFMessage {
    let header = Header::new(Time::ZERO, parent);
    TFMessage {
        transforms: vec![TransformStamped {
            header,
            child_frame_id: child.to_owned(),
            transform: Transform::from(pose),
        }],
    }
}
