//! The node of a program in ROS 2.

use crate::{
    Args, Carrier, Distribution, Error, Kind, Publishing, Qos, Subscribing,
    carrier::OpenCarrier,
    endpoint::Endpoints,
    graph::Graph,
    log::Log,
    name::Scope,
    params::SIM_TIME,
    params_file::FileParam,
    silence::{Situation, Watch},
    time::{RosClock, RosTime},
    token::Token,
};
use apex_messages::rosgraph_msgs;
use apex_rt::{
    Ports, Program, UntilStopped, drive_from,
    params::{ParamError, set_text},
    tell_viewers,
};
use std::{env, str::FromStr as _, sync::Arc, thread};

/// Function that is told reasons for silence, and of messages that cannot be read.
pub(crate) type Tell = Arc<dyn Fn(&str) + Send + Sync>;

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
        let carrier = self.carrier.unwrap_or_else(|| over_zenoh(self.router))(domain, distribution)?;
        let (log, said) = (Log::default(), self.tell);
        let tell: Tell = {
            let log = log.clone();
            Arc::new(move |text: &str| {
                said(text);
                log.add(text);
                tell_viewers(text);
            })
        };
        let is_simulated = args.flag(SIM_TIME);
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
fn over_zenoh(router: Option<String>) -> OpenCarrier {
    #[cfg(feature = "zenoh")]
    return Box::new(move |_, _| Ok(Arc::new(crate::over_zenoh::Zenoh::open(router.as_deref())?)));
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

/// The node of a program in ROS 2: its publishers, subscriptions, services and parameters.
///
/// They end when it is dropped.
pub struct Ros {
    pub(crate) endpoints: Arc<Endpoints>,
    pub(crate) log: Log,
    pub(crate) graph: Graph,
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

    /// Full name of the node: `/robot1/rover`.
    pub fn name(&self) -> String {
        self.endpoints.scope.full()
    }

    /// Arguments of the process: those of ROS, and the others.
    pub fn args(&self) -> &Args {
        &self.endpoints.args
    }

    /// Begins a subscription of a topic. Names are those of ROS: `scan` is in the namespace of the node, `~/scan` below
    /// the node, `/scan` absolute; remappings hold.
    pub fn subscribe(&self, topic: &str) -> Subscribing<'_> {
        Subscribing::new(self, topic)
    }

    /// Begins a publisher of a topic.
    pub fn publish(&self, topic: &str) -> Publishing<'_> {
        Publishing::new(self, topic)
    }

    /// Returns the clock that drives the program: that of the machine, or with `-p use_sim_time:=true` that of the
    /// simulation. Its zero is the start of the node; stamps of messages are converted to it and back.
    pub fn clock(&self) -> RosClock {
        RosClock(self.endpoints.time.clone())
    }

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

impl Drop for Ros {
    fn drop(&mut self) {
        self.log.close();
        self.endpoints.close();
    }
}
