//! Opens the node of a program.

use crate::{
    Args, Carrier, Distribution, Error, Ros,
    carrier::OpenCarrier,
    endpoint::{Endpoints, Tell},
    graph::Graph,
    log::Log,
    name::Scope,
    params::SIM_TIME,
    silence::{Situation, Watch},
    time::RosTime,
    token::Token,
};
use apex_messages::rosgraph_msgs;
use apex_rt::tell_viewers;
use std::{env, str::FromStr as _, sync::Arc};

/// Settings of a node, before it is opened.
pub struct Opening {
    node: String,
    args: Option<Vec<String>>,
    domain: Option<u32>,
    router: Option<String>,
    distribution: Option<Distribution>,
    seed: Option<u64>,
    tell: Tell,
    carrier: Option<OpenCarrier>,
}

impl Opening {
    /// Takes these arguments instead of those of the process.
    #[must_use]
    pub fn args<T: Into<String>>(self, args: impl IntoIterator<Item = T>) -> Self {
        Self { args: Some(args.into_iter().map(Into::into).collect()), ..self }
    }

    /// Joins this domain instead of that in `ROS_DOMAIN_ID`.
    #[must_use]
    pub fn domain(self, domain: u32) -> Self {
        Self { domain: Some(domain), ..self }
    }

    /// Asks the router of Zenoh at this address (`tcp/127.0.0.1:7447`) for the others.
    #[must_use]
    pub fn router(self, address: &str) -> Self {
        Self { router: Some(address.to_owned()), ..self }
    }

    /// Sends and hears by another carrier than Zenoh: `open` gets the domain and the distribution. The crate
    /// `apex-ros-dds` has one.
    #[must_use]
    pub fn over(self, open: impl FnOnce(u32, Distribution) -> Result<Arc<dyn Carrier>, Error> + 'static) -> Self {
        Self { carrier: Some(Box::new(open)), ..self }
    }

    /// Writes as this distribution does, instead of that in `ROS_DISTRO`.
    #[must_use]
    pub fn distribution(self, distribution: Distribution) -> Self {
        Self { distribution: Some(distribution), ..self }
    }

    /// Makes the identifications of the goals that the node sends follow from this number and the names of the node and
    /// the action, so that a simulated run can be repeated. By default they differ each time, so that servers never
    /// confuse the goals of two runs.
    #[must_use]
    pub fn seed(self, seed: u64) -> Self {
        Self { seed: Some(seed), ..self }
    }

    /// Calls `tell` with what is otherwise written to standard error: reasons for silence, and messages that cannot be
    /// read.
    #[must_use]
    pub fn tell(self, tell: impl Fn(&str) + Send + Sync + 'static) -> Self {
        Self { tell: Arc::new(tell), ..self }
    }

    /// Opens the node. It appears in the tools of ROS 2, if a router of Zenoh runs now or later.
    ///
    /// # Errors
    /// An argument or a setting is wrong, or the session cannot be opened.
    pub fn open(self) -> Result<Ros, Error> {
        let arguments = self.args.unwrap_or_else(|| env::args().skip(1).collect());
        let args = Args::read(arguments, &self.node)?;
        let scope = Scope::new(args.namespace.as_deref().unwrap_or(""), args.node.as_deref().unwrap_or(&self.node))?;
        let domain = self.domain.map_or_else(domain, Ok)?;
        let distribution = self.distribution.map_or_else(Distribution::of_environment, Ok)?;
        let is_simulated = args.flag(SIM_TIME)?;
        let (log, said) = (Log::default(), self.tell);
        let tell: Tell = {
            let log = log.clone();
            Arc::new(move |text: &str| {
                said(text);
                log.add(text);
                tell_viewers(text);
            })
        };
        let carrier = self.carrier.unwrap_or_else(|| over_zenoh(self.router, Arc::clone(&tell)));
        let carrier = carrier(domain, distribution)?;
        let mut endpoints = Endpoints::new(carrier, domain, scope, args, distribution, tell, is_simulated);
        endpoints.seed = self.seed.unwrap_or(endpoints.seed);
        let endpoints = Arc::new(endpoints);
        let node = Token {
            domain,
            session: endpoints.session_id(),
            node_id: 0,
            id: 0,
            enclave: endpoints.args.enclave.clone().unwrap_or_default(),
            namespace: endpoints.scope.namespace.clone(),
            node: endpoints.scope.node.clone(),
            endpoint: None,
        };
        endpoints.keep(endpoints.carrier.show(&node)?);
        let graph = Graph::default();
        endpoints.keep(endpoints.carrier.look(graph.clone())?);
        let ros = Ros { endpoints, log, graph };
        ros.watch()?;
        if is_simulated {
            ros.follow_clock()?;
        }
        Ok(ros)
    }
}

/// The carrier by default.
fn over_zenoh(router: Option<String>, tell: Tell) -> OpenCarrier {
    #[cfg(feature = "zenoh")]
    return Box::new(move |_, _| Ok(Arc::new(crate::over_zenoh::Zenoh::open(router.as_deref(), &*tell)?)));
    #[cfg(not(feature = "zenoh"))]
    drop(tell);
    #[cfg(not(feature = "zenoh"))]
    Box::new(move |_, _| {
        let router = router.map_or_else(String::new, |router| format!(" with the router `{router}`"));
        Err(Error::new(format!(
            "a node over Zenoh{router} needs the feature `zenoh` of `apex-ros`; other carriers are named with `over`"
        )))
    })
}

/// Domain in the environment; 0 if there is none.
fn domain() -> Result<u32, Error> {
    match env::var("ROS_DOMAIN_ID").ok().filter(|text| !text.is_empty()) {
        None => Ok(0),
        Some(text) => {
            u32::from_str(&text).map_err(|_| Error::new(format!("`ROS_DOMAIN_ID` is `{text}`, which is not a number")))
        }
    }
}

impl Ros {
    /// Returns the settings of a node with this name.
    pub fn node(name: &str) -> Opening {
        let tell = |text: &str| eprintln!("ros: {text}");
        Opening {
            node: name.to_owned(),
            args: None,
            domain: None,
            router: None,
            distribution: None,
            seed: None,
            tell: Arc::new(tell),
            carrier: None,
        }
    }

    /// Opens a node with the arguments of the process and the settings of the environment.
    ///
    /// # Errors
    /// The errors of [`Opening::open`].
    pub fn open(name: &str) -> Result<Self, Error> {
        Self::node(name).open()
    }

    /// Looks for reasons of silence in a thread.
    fn watch(&self) -> Result<(), Error> {
        let Endpoints { carrier, domain, watch, tell, .. } = &*self.endpoints;
        let (domain, session, rules) = (*domain, self.endpoints.session_id(), carrier.rules());
        let situation = Situation { domain, session, graph: self.graph.clone(), rules };
        let (carrier, watch, tell): (_, Arc<Watch>, Tell) = (Arc::clone(carrier), Arc::clone(watch), Arc::clone(tell));
        self.endpoints.spawn("ros-watch", move || watch.run(&situation, &*carrier, &*tell))
    }

    /// Takes the time of the simulation from `/clock`.
    fn follow_clock(&self) -> Result<(), Error> {
        let RosTime::Simulated(time) = self.endpoints.time.clone() else { return Ok(()) };
        let clock = self.subscribe("/clock").best_effort().depth(1);
        clock.each(move |message: rosgraph_msgs::Clock| time.set(message.clock.as_nanos())).map(drop)
    }
}
