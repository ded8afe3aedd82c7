//! Parameters that viewers read and set. Texts are read here, so that the program gets values; and there is a limit to
//! everything that waits for it.

use super::{
    message::{Report, shortened},
    shared::{MAX_VIEWERS, Pace, Shared},
};
use crate::{
    RemoteParams,
    params::{Given, IntoParam as _, MAX_VALUE, ParamError, Rejection, parsed, room},
    remote::Asked,
};
use core::time::Duration;
use std::{
    collections::{BTreeMap, VecDeque},
    format,
    string::{String, ToString as _},
    sync::Arc,
    time::Instant,
    vec::Vec,
};

/// Number of values of a viewer that may wait for the program. There is room for those of all viewers.
const SHARE: usize = 64;
const _: () = assert!(SHARE * MAX_VIEWERS < crate::requests::ROOM);
/// Interval of the notes about what was set.
const NOTES: Duration = Duration::from_secs(1);
/// Maximum length of a value in a note, in bytes.
const MAX_NOTE: usize = 200;

/// Result of a request to set a parameter: the refusal, the value that was given (whose memory is freed here), the
/// value now, and the number of reactions before.
type IsSet = (Result<(), Rejection>, Given, Option<Given>, u64);

/// Requests of viewers that wait for the program.
pub struct Asking {
    params: RemoteParams,
    shared: Arc<Shared>,
    sets: Vec<Setting>,
    /// `true` if all parameters are to be read once more after those that are being read: one that was asked for before
    /// a viewer came may have changed.
    again: bool,
    /// Numbers of the parameters that are to be read, and those that are being read.
    wanted: VecDeque<usize>,
    reads: Vec<(&'static str, Asked<Option<Given>>)>,
    notes: Notes,
}

/// A value that waits for the program.
struct Setting {
    viewer: u64,
    name: &'static str,
    asked: Asked<IsSet>,
}

/// A message to all viewers, or to one of them.
pub enum Told {
    All(Report),
    One(u64, Report),
}

impl Asking {
    pub fn new(params: RemoteParams, shared: Arc<Shared>) -> Self {
        let (sets, wanted, reads) = (Vec::new(), VecDeque::new(), Vec::new());
        Self { params, shared, sets, again: false, wanted, reads, notes: Notes::default() }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.sets.clear();
        self.wanted.clear();
        self.reads.clear();
    }

    /// Asks the program for the values of all parameters.
    pub fn read_all(&mut self) {
        self.again = true;
        self.ask();
    }

    fn ask(&mut self) {
        // However often viewers ask, each parameter is read once at a time: there is room for that.
        if self.wanted.is_empty() && self.reads.is_empty() && core::mem::take(&mut self.again) {
            self.wanted = (0..self.params.all().len()).collect();
        }
        while let Some(at) = self.wanted.front() {
            let name = self.params.all()[*at].name;
            let asked = self.params.post(name, |access| {
                let mut room = MAX_VALUE;
                let value = Given::copy(access.get(), &mut room);
                (Ok(value), MAX_VALUE - room)
            });
            match asked {
                // There is no place for it yet.
                Ok(None) => return,
                Ok(Some(asked)) => self.reads.push((name, asked)),
                Err(_) => {}
            }
            self.wanted.pop_front();
        }
    }

    /// Asks the program to set a parameter. Returns the answer if it is refused before that.
    pub fn set(&mut self, viewer: (u64, &str), name: &str, value: &str) -> Option<Report> {
        let refused = |error: String| Some(failed(name, error));
        let Some(param) = self.params.all().iter().find(|param| param.name == name) else {
            let unknown = crate::params::find(self.params.all(), name).err();
            return refused(unknown.map_or_else(String::new, |error| error.to_string()));
        };
        let most = room(param.ty);
        if value.len() > most {
            return refused(ParamError::Refused { param, refusal: Rejection::Size { most } }.to_string());
        }
        if self.sets.iter().filter(|set| set.viewer == viewer.0).count() >= SHARE {
            return refused(self.drop_one(viewer.1, name));
        }
        let (size, value, shared) = (value.len(), parsed(value), Arc::clone(&self.shared));
        let asked = self.params.post(name, move |access| {
            let set = access.set(value.give());
            let (mut room, reactions) = (MAX_VALUE, shared.pace.as_ref().map_or(0, Pace::reactions));
            let now = if set.is_ok() { Given::copy(access.get(), &mut room) } else { None };
            (Ok((set, value, now, reactions)), size + MAX_VALUE - room)
        });
        match asked {
            Ok(Some(asked)) => {
                self.sets.push(Setting { viewer: viewer.0, name: param.name, asked });
                self.notes.names.entry(viewer.0).or_insert_with(|| viewer.1.into());
                None
            }
            Ok(None) => refused(self.drop_one(viewer.1, name)),
            Err(error) => refused(error.to_string()),
        }
    }

    /// Counts a value that is dropped. Returns the answer to its sender.
    fn drop_one(&mut self, viewer: &str, name: &str) -> String {
        let (dropped, _) = self.notes.dropped.entry(viewer.into()).or_default();
        *dropped += 1;
        format!(
            "the value of `{name}` was dropped: {SHARE} values wait for the robot already ({dropped} were dropped); send fewer"
        )
    }

    /// The answers of the program.
    pub fn told(&mut self) -> Vec<Told> {
        self.ask();
        let mut told = Vec::new();
        self.reads.retain(|(name, asked)| {
            let Some(value) = asked.take() else { return true };
            let value = value.map_err(|error| error.to_string()).and_then(|value| shown(value).ok_or_else(too_long));
            told.push(Told::All(Report::Param { name: (*name).into(), value, reactions: None }));
            false
        });
        let (params, notes) = (&self.params, &mut self.notes);
        self.sets.retain(|Setting { viewer, name, asked }| {
            let Some(set) = asked.take() else { return true };
            told.push(match set {
                Ok((Ok(()), _, value, reactions)) => {
                    let value = shown(value).ok_or_else(too_long);
                    notes.set(*viewer, name, value.as_deref().unwrap_or("a long value"));
                    Told::All(Report::Param { name: (*name).into(), value, reactions: Some(reactions) })
                }
                Ok((Err(refusal), ..)) => Told::One(*viewer, failed(name, params.refused(name, refusal).to_string())),
                Err(error) => Told::One(*viewer, failed(name, error.to_string())),
            });
            false
        });
        notes.write(&self.sets);
        told
    }
}

/// The answer to a request to set a parameter that keeps its value.
fn failed(name: &str, error: String) -> Report {
    Report::Param { name: name.into(), value: Err(error), reactions: Some(0) }
}

fn shown(value: Option<Given>) -> Option<String> {
    value.map(|value| value.give().to_string())
}

fn too_long() -> String {
    format!("its value is too long to be shown: it has more than {MAX_VALUE} bytes or elements")
}

/// Notes about who has set what, at most one per second for each parameter and viewer.
#[derive(Default)]
struct Notes {
    /// Names of the viewers that have set something.
    names: BTreeMap<u64, String>,
    /// The last value by viewer and parameter, and the number of values since the last note.
    set: BTreeMap<(u64, &'static str), (String, u64)>,
    /// Number of values that were dropped, by name of the viewer; and the number at the last note.
    dropped: BTreeMap<String, (u64, u64)>,
    written: Option<Instant>,
}

impl Notes {
    fn set(&mut self, viewer: u64, param: &'static str, value: &str) {
        let (last, count) = self.set.entry((viewer, param)).or_default();
        *last = shortened(value.into(), MAX_NOTE);
        *count += 1;
    }

    /// Writes the notes to standard error, from time to time. `waiting` are the values whose notes are still to come.
    fn write(&mut self, waiting: &[Setting]) {
        let has_dropped = self.dropped.values().any(|(count, noted)| count > noted);
        if (self.set.is_empty() && !has_dropped) || self.written.is_some_and(|last| last.elapsed() < NOTES) {
            return;
        }
        self.written = Some(Instant::now());
        for ((viewer, param), (value, count)) in core::mem::take(&mut self.set) {
            let who = self.names.get(&viewer).map_or("a viewer", String::as_str);
            let times = if count > 1 { format!(" (the last of {count} values)") } else { String::new() };
            std::eprintln!("viewer {who} has set `{param}` to {value}{times}");
        }
        for (who, (count, noted)) in self.dropped.iter_mut().filter(|(_, (count, noted))| count > noted) {
            std::eprintln!("viewer {who} sends values too fast: {count} were dropped");
            *noted = *count;
        }
        // Viewers come and go; what was noted of so many is not needed any more.
        if self.dropped.len() > MAX_VIEWERS {
            self.dropped.clear();
        }
        self.names.retain(|viewer, _| waiting.iter().any(|set| set.viewer == *viewer));
    }
}
