//! The node of a program in ROS 2.

use crate::{Args, Kind, Qos, endpoint::Endpoints, graph::Graph, log::Log, time::RosClock};
use std::sync::Arc;

/// The node of a program in ROS 2: its publishers, subscriptions, services and parameters.
///
/// They end when it is dropped.
pub struct Ros {
    pub(crate) endpoints: Arc<Endpoints>,
    pub(crate) log: Log,
    pub(crate) graph: Graph,
}

impl Ros {
    /// Full name of the node: `/robot1/rover`.
    pub fn name(&self) -> String {
        self.endpoints.scope.full()
    }

    /// Arguments of the process: those of ROS, and the others.
    pub fn args(&self) -> &Args {
        &self.endpoints.args
    }

    /// Returns the clock that drives the program: that of the machine, or with `-p use_sim_time:=true` that of the
    /// simulation. Its zero is the start of the node; stamps of messages are converted to it and back.
    pub fn clock(&self) -> RosClock {
        RosClock(self.endpoints.time.clone())
    }

    /// Returns `true` if there is an endpoint of this kind and type in any program: a publisher of a topic, say.
    pub fn sees(&self, kind: Kind, name: &str, ty: &str) -> bool {
        self.endpoints.resolve(name).is_ok_and(|full| {
            let endpoint = |hash: &str| self.endpoints.endpoint(kind, &full, ty, hash, Qos::DEFAULT);
            let others = self.graph.others(kind, &self.endpoints.session_id());
            let wanted = endpoint("");
            others
                .iter()
                .filter_map(|token| token.endpoint.as_ref())
                .any(|it| (&it.name, &it.wire_type) == (&wanted.name, &wanted.wire_type))
        })
    }
}

impl Drop for Ros {
    fn drop(&mut self) {
        self.log.close();
        self.endpoints.close();
    }
}
