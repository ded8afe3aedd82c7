//! Drives of a node: a second of good input, then one condition at one input.

use super::{
    rows::{Inputs, Row, Sent},
    token::{Made, Token},
    world::World,
};
use apex_nodes::nav::Twist;
use apex_rt::{Ctx, Time};
use std::time::Duration;

/// Time between two firings.
pub const STEP: Duration = Duration::from_millis(50);
/// End of the good input, and of the condition.
const GOOD: Time = Time::from_secs(1);
const END: Time = Time::from_secs(4);

/// Tokens that come at an input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    NoMessage,
    NotANumber,
    Infinite,
    Empty,
    /// Measured 10 s ago.
    Stale,
    /// The last good one again.
    Repeated,
    /// Each measured before the one before it.
    OutOfOrder,
    /// From before the time was set back by 100 s.
    Future,
    /// Far from the origin.
    Far,
}

impl Condition {
    pub const ALL: [Self; 9] = [
        Self::NoMessage,
        Self::NotANumber,
        Self::Infinite,
        Self::Empty,
        Self::Stale,
        Self::Repeated,
        Self::OutOfOrder,
        Self::Future,
        Self::Far,
    ];

    /// Heading of its column.
    pub const fn heading(self) -> &'static str {
        match self {
            Self::NoMessage => "⊥",
            Self::NotANumber => "NaN",
            Self::Infinite => "∞",
            Self::Empty => "empty",
            Self::Stale => "stale",
            Self::Repeated => "repeated",
            Self::OutOfOrder => "out of order",
            Self::Future => "from the future",
            Self::Far => "far away",
        }
    }

    /// Odd token in place of a good one, or ⊥. `kept` is the last good one.
    fn token(self, good: &dyn Token, kept: &dyn Token, stamp: Time) -> Result<Option<Box<dyn Token>>, &'static str> {
        let stamped = |token: &dyn Token| token.stamped(stamp).unwrap_or_else(|| token.copied());
        let made: Made = match self {
            Self::NoMessage => return Ok(None),
            Self::NotANumber => good.nan(),
            Self::Infinite => good.infinite(),
            Self::Empty => good.empty(),
            Self::Far => good.far(),
            Self::Stale | Self::OutOfOrder => Ok(stamped(kept)),
            Self::Repeated | Self::Future => good.stamped(stamp).ok_or("no stamp").map(|_| stamped(kept)),
        };
        made.map(Some)
    }

    /// Stamp of a token, or of the firing if the token has none.
    fn stamp(self, now: Time) -> Time {
        match self {
            Self::Stale => now - Duration::from_secs(10),
            Self::Repeated => GOOD,
            Self::OutOfOrder => GOOD - now.since(GOOD),
            Self::Future => now + Duration::from_secs(100),
            _ => now,
        }
    }
}

/// Outcome of a condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Time in s from the last good input to the first twist of zero.
    pub stops: Option<f32>,
    /// Event that came, and when.
    pub event: Option<(&'static str, f32)>,
    pub fails: bool,
    /// Twist before the condition, and at its end.
    pub twists: [Twist; 2],
    /// `true` if the node drives on when the input is good again.
    pub goes_on: bool,
}

/// One drive.
struct Drive<'a> {
    inputs: &'a [(String, String)],
    node: super::rows::Node,
    world: World,
    outcome: Outcome,
}

impl<'a> Drive<'a> {
    /// Drives for a second.
    fn begin(row: &Row, inputs: &'a [(String, String)]) -> Self {
        let outcome = Outcome { stops: None, event: None, fails: false, twists: [Twist::ZERO; 2], goes_on: false };
        let mut drive = Self { inputs, node: (row.make)(), world: World::new(), outcome };
        while drive.world.now < GOOD {
            let (now, tokens) = (drive.world.now, drive.good());
            drive.fire(now, &tokens);
            drive.world.advance(STEP);
        }
        let tokens = drive.good();
        let sent = drive.fire(GOOD, &tokens);
        assert!(sent.event.is_none() && !sent.fails, "`{}` ends before anything is odd: {sent:?}", row.name);
        assert!(drive.world.twist != Twist::ZERO, "`{}` does not drive", row.name);
        drive.outcome.twists[0] = drive.world.twist;
        drive
    }

    fn good(&self) -> Inputs {
        let tokens = self.inputs.iter().map(|(name, ty)| (name, self.world.token(name, ty)));
        tokens.filter_map(|(name, token)| Some((name.clone(), token?))).collect()
    }

    /// Lets the node fire with a stamp, and the base take its twist.
    fn fire(&mut self, stamp: Time, tokens: &Inputs) -> Sent {
        let ctx = Ctx::new(self.world.now).since(stamp.min(self.world.now)).of_node(true);
        let sent = (self.node)(&ctx, tokens);
        assert!(sent.twist.is_none_or(|twist| twist.is_finite()), "{:?}", sent.twist);
        self.world.twist = sent.twist.unwrap_or(self.world.twist);
        sent
    }

    /// Fires in the condition, and notes what comes.
    fn note(&mut self, stamp: Time, tokens: &Inputs) {
        let (sent, after) = (self.fire(stamp, tokens), self.world.now.since(GOOD).as_secs_f32());
        let outcome = &mut self.outcome;
        if sent.twist == Some(Twist::ZERO) {
            outcome.stops.get_or_insert(after);
        }
        outcome.event = outcome.event.or(sent.event.map(|event| (event, after)));
        outcome.fails |= sent.fails;
        outcome.twists[1] = self.world.twist;
    }

    /// Good input again.
    fn finish(mut self) -> Outcome {
        for _ in 0..20 {
            self.world.advance(STEP);
            let (now, tokens) = (self.world.now, self.good());
            self.outcome.goes_on |= self.fire(now, &tokens).twist.is_some_and(|twist| twist != Twist::ZERO);
        }
        self.outcome
    }
}

/// Outcome of a condition at an input, or the reason why it does not exist.
pub fn at_input(
    row: &Row,
    inputs: &[(String, String)],
    (name, ty): &(String, String),
    condition: Condition,
) -> Result<Outcome, &'static str> {
    let mut drive = Drive::begin(row, inputs);
    // What comes once was sent at the start.
    let at = |world: &World| world.token(name, ty).or_else(|| World::new().token(name, ty)).expect("a good token");
    let kept = at(&drive.world);
    while drive.world.now < END {
        drive.world.advance(STEP);
        let (now, mut tokens) = (drive.world.now, drive.good());
        let (good, stamp) = (at(&drive.world), condition.stamp(now));
        tokens.remove(name);
        tokens.extend(condition.token(&*good, &*kept, stamp)?.map(|token| (name.clone(), token)));
        let is_of_token = good.stamped(stamp).is_some();
        drive.note(if is_of_token { now } else { stamp }, &tokens);
    }
    Ok(drive.finish())
}

/// Outcome of a silence of everything.
pub fn in_silence(row: &Row, inputs: &[(String, String)]) -> Outcome {
    let mut drive = Drive::begin(row, inputs);
    while drive.world.now < END {
        drive.world.advance(Duration::from_secs_f32(row.max_age));
        let now = drive.world.now;
        drive.note(now, &Inputs::new());
    }
    drive.finish()
}
