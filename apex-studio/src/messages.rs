//! Messages between the studio and a page, as JSON.

use crate::{
    editor::Written,
    lane::Drawn,
    language::Place,
    live::{Param, Problem, Run},
    picture::View,
    why::Line,
};
use apex_rt::studio::message::About;
use serde::{Deserialize, Serialize};
use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

/// A message to the page.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Told {
    /// Names of all robots, which of them is shown, and names of the studies beside them.
    Robots { names: Vec<String>, shown: usize, studies: Vec<String> },
    /// Numbers and last times in s of the earlier runs of the robot that can be looked at, the number of this one, and
    /// of the one that is shown.
    Runs { earlier: Vec<(u64, f64)>, last: u64, shown: u64 },
    /// A robot. Everything about an earlier one is obsolete.
    About(AboutRun),
    /// The robot has gone back to a checkpoint. All numbers, problems and tokens come again.
    Back(u64),
    /// Reason why the robot repeats its run from the start to go back.
    Checkpoints(Option<String>),
    /// The picture.
    Picture(Drawing),
    /// Changes since the last such message.
    Tick(Tick),
    /// Errors of the source have come or gone.
    Errors(Option<String>),
    /// New problems.
    Problems { count: u64, problems: Vec<Problem> },
    /// Parameters that have changed.
    Params(BTreeMap<String, Param>),
    /// Times of calls: the node, number of calls, total and longest duration in ns.
    Times(Vec<(u32, u64, u64, u64)>),
    /// Why a node is active and fired, or why not.
    Why(Vec<Line>),
    /// New tokens of channels.
    Tokens(BTreeMap<u32, NewTokens>),
    /// New tokens of the same channels of the robot beside it.
    Beside(BTreeMap<u32, NewTokens>),
    /// The condition at which the robot halts has a mistake, or none.
    Break(Option<String>),
    /// About the source files.
    Written(Written),
    /// The changed parameters were written to this file, or could not be.
    Saved(Result<String, String>),
    /// A marked moment was written to this file as a test, or could not be.
    Test(Result<String, String>),
    /// Lanes of the timeline.
    Lanes {
        from: f64,
        to: f64,
        columns: u32,
        lanes: Vec<Drawn>,
        /// The same lanes of the run that this one repeats.
        before: Vec<Drawn>,
        /// Time in s at which they begin to differ.
        differs: Option<f64>,
    },
}

/// A view of a robot.
#[derive(Serialize)]
pub struct Drawing {
    pub view: View,
    /// `true` if there is another view.
    pub has_activity: bool,
    pub svg: String,
    /// Nested graphs, and those that are open.
    pub graphs: Vec<String>,
    pub open: BTreeSet<String>,
    /// Connections that each line stands for, by the names at its ends.
    pub lines: BTreeMap<String, Vec<usize>>,
    /// Nodes in the view of the activity.
    pub states: Vec<usize>,
}

/// New tokens of a channel.
#[derive(Serialize)]
pub struct NewTokens {
    /// Time in s, and text.
    pub texts: Vec<(f64, String)>,
    /// The newest one as a message in CDR, in base 64.
    pub bytes: String,
}

/// A run of a robot.
#[derive(Serialize)]
pub struct AboutRun {
    pub run: u64,
    pub about: Arc<About>,
    pub texts: Vec<String>,
    /// `true` for each text that may be changed.
    pub editable: Vec<bool>,
    /// `true` if the robot is built and started again when a text has changed.
    pub rebuilds: bool,
    pub readonly: bool,
    /// `true` if the studio asks for neither tokens nor times.
    pub looks: bool,
    /// `true` if it can go back in time.
    pub travels: bool,
    /// `true` if it repeats the run before up to a point.
    pub repeats: bool,
    /// The robot beside it, with whose lanes and tokens its own are compared: `shadow` or `robot`.
    pub beside: Option<&'static str>,
}

/// State of the run.
#[derive(Serialize)]
pub struct Tick {
    pub run: Run,
    /// Time in s.
    pub now: f64,
    pub paused: bool,
    /// Simulated seconds per second; `null` for as fast as possible.
    pub speed: Option<f64>,
    pub lost: u64,
    /// Reason to believe that the robot stands still, or the connection to it.
    pub silence: Option<String>,
    /// Time in s before which only sums are known, if there is one.
    pub forgotten: Option<f64>,
    /// Nodes that have changed: index, active, since when in s, numbers of firings and of tokens that its slots took,
    /// time of the last of these in s, number of problems.
    pub nodes: Vec<(usize, bool, f64, u64, u64, f64, u64)>,
    /// Connections that have changed, with the number of their tokens.
    pub handled: Vec<(usize, u64)>,
    /// Connections over which activity has passed, with the last time in s.
    pub passed: Vec<(usize, f64)>,
    /// Connections over which a node waits for a token, while others have brought theirs.
    pub awaited: Vec<u32>,
}

/// A message of the page.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Asked {
    /// Shows another robot, by its number.
    Robot(usize),
    /// Shows an earlier run by its number, or the current one.
    Look(u64),
    /// Shows a view, opens these nested graphs in it, and closes all others; without them, those that were open before.
    Open { view: View, open: Option<BTreeSet<String>> },
    /// Sets a parameter to a value in TOML.
    Set { name: String, value: String },
    /// Halts the robot.
    Pause,
    /// Lets it react once.
    Step,
    /// Lets it continue at this speed; without one, as fast as possible.
    Run { speed: Option<f64> },
    /// Halts it before the last reaction.
    Back,
    /// Halts it at this time in s.
    Goto(f64),
    /// Halts it whenever this condition becomes true.
    Break(String),
    /// Starts it again.
    Restart,
    /// Gives the robot the parameters of its shadow, which is shown.
    Take,
    /// Writes all changed parameters to a file.
    Save,
    /// Writes a parameter into the source.
    Write(String),
    /// Takes note of a text of the page.
    Edit { file: usize, version: u32, text: String },
    /// Asks for a description of what is at a place.
    Hover(Place),
    /// Asks for completions at a place.
    Complete(Place),
    /// Saves a text, also `over` one that others have saved.
    Keep { file: usize, text: String, over: bool },
    /// Asks for the tokens of these channels, and of no others.
    Watch(BTreeSet<u32>),
    /// Asks for the times of calls, or no longer.
    Measure(bool),
    /// Asks why a node is active and fired, or why not, at a time in s; without one, now.
    Why { node: usize, at: Option<f64> },
    /// Writes a test of the interval between two times in s.
    Test(f64, f64),
    /// Asks for the lanes of the timeline, with those of `also`. Times are in s. Only those of the nodes in `seen` have
    /// contents; without it, all.
    Lanes { from: f64, to: f64, columns: u32, also: Vec<usize>, seen: Option<BTreeSet<usize>> },
}
