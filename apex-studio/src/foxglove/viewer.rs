//! One app: what it asks for, and what it is told.

use super::{
    channels,
    messages::{Asked, Channel, Control, Frame, Parameter, Subscription, Text, Told},
    parameters::{Followed, Pending, parameters, text},
    playback::{self, Playback},
    seen::Seen,
};
use crate::live::{Live, Node};
use apex_rt::studio::message::{About, Command};
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

/// Number of requests for new values that may wait for the robot.
const MAX_PENDING: usize = 100;

/// An app that looks at a robot.
pub struct Viewer {
    seen: Seen,
    /// Number of the run that the app knows, from the first look on, and its robot.
    run: Option<u64>,
    about: Option<Arc<About>>,
    channels: Vec<Channel>,
    /// Channels by subscription.
    subscribed: BTreeMap<u32, u32>,
    /// Number of tokens of each port that the app knows.
    tokens: BTreeMap<u32, u64>,
    /// Ports with tokens that were too long.
    too_long: BTreeSet<u32>,
    /// State of the nodes, and number of problems, that the app knows.
    nodes: Vec<Node>,
    problems: u64,
    followed: Followed,
    pending: Vec<Pending>,
    playback: Playback,
}

impl Viewer {
    pub fn new(seen: Seen) -> Self {
        Self {
            seen,
            run: None,
            about: None,
            channels: vec![],
            subscribed: BTreeMap::new(),
            tokens: BTreeMap::new(),
            too_long: BTreeSet::new(),
            nodes: vec![],
            problems: 0,
            followed: Followed::default(),
            pending: vec![],
            playback: Playback::default(),
        }
    }

    /// Answers the app.
    pub fn answer(&mut self, asked: Asked) -> Vec<Frame> {
        match asked {
            Asked::Playback(control) => self.control(control),
            Asked::Told(Told::Subscribe { subscriptions }) => {
                subscriptions.into_iter().filter_map(|wish| self.subscribe(wish)).collect()
            }
            Asked::Told(Told::Unsubscribe { subscription_ids }) => {
                subscription_ids.into_iter().for_each(|id| self.unsubscribe(id));
                vec![]
            }
            Asked::Told(Told::GetParameters { parameter_names, id }) => {
                let parameters = parameters(&self.seen.shared.live(), &parameter_names);
                vec![Frame::Text(Text::ParameterValues { parameters, id })]
            }
            Asked::Told(Told::SetParameters { parameters, id }) => self.set(&parameters, id),
            Asked::Told(Told::SubscribeParameterUpdates { parameter_names }) => {
                self.followed.add(&self.seen.shared.live(), &parameter_names);
                vec![]
            }
            Asked::Told(Told::UnsubscribeParameterUpdates { parameter_names }) => {
                self.followed.remove(&parameter_names);
                vec![]
            }
        }
    }

    fn control(&mut self, control: Control) -> Vec<Frame> {
        self.playback.obey(&self.seen, control)
    }

    fn subscribe(&mut self, Subscription { id, channel_id }: Subscription) -> Option<Frame> {
        if !self.channels.iter().any(|channel| channel.id == channel_id) {
            return Some(Frame::error(format!("there is no channel {channel_id}")));
        }
        if self.seen.readonly && channels::port(channel_id).is_some() {
            return Some(Frame::warning("this studio may only look, and asks the robot for no tokens".to_owned()));
        }
        if self.subscribed.contains_key(&id) || self.subscribed.values().any(|channel| *channel == channel_id) {
            return Some(Frame::warning(format!("there is a subscription {id}, or one to channel {channel_id}")));
        }
        self.subscribed.insert(id, channel_id);
        match channels::port(channel_id) {
            Some(port) => self.seen.shared.watch(port),
            // All of it comes once more.
            None if channel_id == channels::ACTIVITY => self.nodes.clear(),
            None => self.problems = 0,
        }
        None
    }

    fn unsubscribe(&mut self, id: u32) {
        if let Some(port) = self.subscribed.remove(&id).and_then(channels::port) {
            self.seen.shared.unwatch(port);
            self.tokens.remove(&port);
        }
    }

    /// Sets parameters. Those that the robot is asked to set are answered when it has answered.
    fn set(&mut self, given: &[Parameter], id: Option<String>) -> Vec<Frame> {
        if self.seen.readonly {
            return self.refused(given, id, "this studio may only look");
        }
        if self.pending.len() >= MAX_PENDING {
            return self.refused(given, id, "the robot has not answered yet");
        }
        let shared = Arc::clone(&self.seen.shared);
        let live = shared.live();
        if live.travels {
            drop(live);
            return self.refused(given, id, "the robot repeats its run");
        }
        let (mut told, mut commands, mut versions) = (vec![], vec![], BTreeMap::new());
        for parameter in given {
            let Some(param) = live.params.get(&parameter.name).filter(|param| !param.fixed) else {
                told.push(Frame::error(format!("there is no parameter `{}`", parameter.name)));
                continue;
            };
            match text(&live, parameter) {
                Ok(value) => {
                    versions.insert(parameter.name.clone(), param.version);
                    commands.push(Command::Set { name: parameter.name.clone(), value });
                }
                Err(why) => told.push(Frame::error(why)),
            }
        }
        drop(live);
        commands.iter().for_each(|command| shared.tell(command));
        self.pending.push(Pending { id, versions });
        told
    }

    /// Tells the app that parameters were not set, and the values that they keep.
    fn refused(&self, given: &[Parameter], id: Option<String>, why: &str) -> Vec<Frame> {
        let names: Vec<String> = given.iter().map(|parameter| parameter.name.clone()).collect();
        let mut told = vec![Frame::error(format!("no parameter was set: {why}"))];
        if !names.is_empty() {
            let parameters = parameters(&self.seen.shared.live(), &names);
            told.push(Frame::Text(Text::ParameterValues { parameters, id }));
        }
        told
    }

    /// All that has happened since the last call.
    pub fn news(&mut self) -> Vec<Frame> {
        let shared = Arc::clone(&self.seen.shared);
        let live = shared.live();
        let mut told = vec![];
        let mut gone = vec![];
        if self.run != Some(live.runs) {
            gone = self.begin(&live, &mut told);
        }
        told.extend(self.playback.news(&self.seen, &live));
        told.extend(self.parameters(&live));
        if let Some(about) = live.about.as_deref().filter(|_| !self.playback.travels(&live)) {
            for (subscription, channel) in self.subscribed.clone() {
                let messages = match channels::port(channel) {
                    Some(port) => self.token(&live, port, &mut told),
                    None if channel == channels::ACTIVITY => self.activity(&live, about),
                    None => self.problems(&live, about),
                };
                let data = |(time, payload)| Frame::Data { subscription, time, payload };
                told.extend(messages.into_iter().map(data));
            }
        }
        drop(live);
        gone.into_iter().filter_map(channels::port).for_each(|port| shared.unwatch(port));
        told
    }

    /// Introduces a new run. Returns the channels that the app has to subscribe to once more.
    fn begin(&mut self, live: &Live, told: &mut Vec<Frame>) -> Vec<u32> {
        let is_first = self.run.is_none();
        (self.run, self.nodes, self.problems) = (Some(live.runs), vec![], 0);
        self.tokens.clear();
        // A run that was repeated to go back is the same for the app.
        if !is_first && live.repeats && self.about == live.about {
            return vec![];
        }
        let old = std::mem::take(&mut self.channels);
        if !old.is_empty() {
            let channel_ids = old.iter().map(|channel| channel.id).collect();
            told.push(Frame::Text(Text::Unadvertise { channel_ids }));
        }
        self.about.clone_from(&live.about);
        self.channels = self.about.as_deref().map(channels::channels).unwrap_or_default();
        told.push(Frame::Text(self.info(live)));
        told.push(Frame::Text(Text::Advertise { channels: self.channels.clone() }));
        self.followed = Followed::default();
        std::mem::take(&mut self.subscribed).into_values().collect()
    }

    /// Description of the robot.
    fn info(&self, live: &Live) -> Text {
        let is_controlled = playback::is_controlled(&self.seen, live);
        let range = is_controlled.then(|| playback::range(&self.seen, live));
        let capabilities = ["time", "parameters", "parametersSubscribe", "playbackControl"];
        Text::ServerInfo {
            name: live.about.as_ref().map_or_else(|| "Apex".to_owned(), |about| about.name.clone()),
            capabilities: capabilities[..if is_controlled { 4 } else { 3 }].to_vec(),
            session_id: live.runs.to_string(),
            data_start_time: range.map(|(first, _)| first),
            data_end_time: range.map(|(_, last)| last),
        }
    }

    /// Parameters that have changed, and answers of the robot.
    fn parameters(&mut self, live: &Live) -> Vec<Frame> {
        let mut told = vec![];
        let answered: Vec<Pending> = self.pending.extract_if(.., |pending| pending.is_answered(live)).collect();
        for pending in answered {
            told.extend(pending.errors(live).into_iter().map(Frame::error));
            if pending.id.is_some() {
                // Without names all of them would be meant.
                let none = pending.versions.is_empty();
                let parameters = if none { vec![] } else { parameters(live, pending.versions.keys()) };
                told.push(Frame::Text(Text::ParameterValues { parameters, id: pending.id }));
            }
        }
        let parameters = self.followed.news(live);
        if !parameters.is_empty() {
            told.push(Frame::Text(Text::ParameterValues { parameters, id: None }));
        }
        told
    }

    /// The newest token of a port, if the app does not know it.
    fn token(&mut self, live: &Live, port: u32, told: &mut Vec<Frame>) -> Vec<(u64, Vec<u8>)> {
        let count = live.tokens.get(&port).map_or(0, |tokens| tokens.count);
        let seen = self.tokens.entry(port).or_default();
        if std::mem::replace(seen, count) >= count {
            return vec![];
        }
        let token = channels::token(live, port);
        if token.is_none() && self.too_long.insert(port) {
            let name = live.about.as_ref().and_then(|about| Some(about.channels.get(port as usize)?.name.as_str()));
            let name = name.unwrap_or_default();
            told.push(Frame::warning(format!("tokens of `{name}` are too long for the studio, and are not shown")));
        }
        token.into_iter().collect()
    }

    /// Changes of activity.
    fn activity(&mut self, live: &Live, about: &About) -> Vec<(u64, Vec<u8>)> {
        let is_first = self.nodes.len() != live.nodes.len();
        if is_first {
            self.nodes.clone_from(&live.nodes);
        }
        let mut changes = vec![];
        for (at, (node, seen)) in live.nodes.iter().zip(&mut self.nodes).enumerate() {
            let has_changed = node.active != seen.active || node.since != seen.since;
            // It was something else for a moment.
            if has_changed && node.active == seen.active {
                changes.extend(channels::activity(about, at, node, !node.active));
            }
            if has_changed || is_first {
                changes.extend(channels::activity(about, at, node, node.active));
            }
            *seen = *node;
        }
        changes
    }

    /// New problems.
    fn problems(&mut self, live: &Live, about: &About) -> Vec<(u64, Vec<u8>)> {
        let seen = std::mem::replace(&mut self.problems, live.problem_count);
        let new = usize::try_from(live.problem_count.saturating_sub(seen)).unwrap_or(usize::MAX);
        let first = live.problems.len().saturating_sub(new);
        live.problems.iter().skip(first).map(|problem| channels::problem(about, problem)).collect()
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        let ports = self.subscribed.values().copied().filter_map(channels::port);
        ports.for_each(|port| self.seen.shared.unwatch(port));
    }
}
