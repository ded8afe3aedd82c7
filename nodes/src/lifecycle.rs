//! Robots whose activity a manager gives and takes: it is configured, activated, deactivated, cleaned up and shut down.
//! `apex-ros` makes such a program a managed node of ROS 2.

use apex_rt::{Ctx, Event, node};

/// Order of a manager.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Transition {
    /// Make ready: open devices, load maps.
    Configure,
    /// Begin to act.
    Activate,
    /// Stop acting.
    Deactivate,
    /// Undo the configuration.
    CleanUp,
    /// Stop for good.
    ShutDown,
}

/// Outcome of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome {
    /// The robot is in the next state.
    Success,
    /// The robot is in the state from which it came.
    Failure,
    /// Something is broken: the robot has to be configured again.
    Error,
}

/// Home of the activity of a robot while it is inactive. The activity leaves with `activate`, and `deactivate` takes it
/// away from whatever the robot does, which brings it back to `ready`: `start => life.ready; life.activate =>
/// mission.begin; life.deactivate -> mission.cancel; mission.cancelled => life.ready`.
///
/// So an inactive robot does nothing that needs activity: it sends no goals, accepts none, and drives nowhere. A
/// mission that ends by itself brings its activity back to `ready`, too.
#[node]
#[derive(Debug, Clone)]
pub struct Managed {
    /// Waits for `done`, `refuse` or `error` after `configure` and `clean_up`. Otherwise both succeed at once.
    #[param(default = false)]
    waits: bool,
    pending: Option<Transition>,
}

#[node]
impl Managed {
    /// Keeps the activity: the robot is inactive.
    #[slot]
    fn ready(&mut self, ctx: &Ctx, outcome: Event<Outcome>) {
        if ctx.active() && matches!(self.pending, Some(Transition::Deactivate | Transition::ShutDown)) {
            self.answer(Outcome::Success, outcome);
        }
    }

    /// Takes an order of the manager.
    #[slot]
    #[allow(clippy::too_many_arguments, reason = "each transition is an event of its own")]
    fn manage(
        &mut self,
        order: &Transition,
        ctx: &Ctx,
        configure: Event<()>,
        activate: Event<()>,
        deactivate: Event<()>,
        clean_up: Event<()>,
        shut_down: Event<()>,
        outcome: Event<Outcome>,
    ) {
        // The activity may be out: in the mission.
        let is_out = !ctx.active();
        let waits = match order {
            Transition::Configure => {
                configure.emit(());
                self.waits
            }
            Transition::CleanUp => {
                clean_up.emit(());
                self.waits
            }
            Transition::Activate if is_out => return outcome.emit(Outcome::Failure),
            Transition::Activate => {
                activate.emit(());
                false
            }
            Transition::Deactivate => {
                deactivate.emit(());
                is_out
            }
            Transition::ShutDown => {
                shut_down.emit(());
                deactivate.emit(());
                is_out
            }
        };
        self.pending = waits.then_some(*order);
        if !waits {
            outcome.emit(Outcome::Success);
        }
    }

    /// Reports that the robot is configured, or that its configuration is undone.
    #[slot]
    fn done(&mut self, outcome: Event<Outcome>) {
        self.prepared(Outcome::Success, outcome);
    }

    /// Reports that it cannot be configured, or that its configuration cannot be undone.
    #[slot]
    fn refuse(&mut self, outcome: Event<Outcome>) {
        self.prepared(Outcome::Failure, outcome);
    }

    /// Reports that something is broken, at any time: the robot stops.
    #[slot]
    fn error(&mut self, deactivate: Event<()>, outcome: Event<Outcome>) {
        deactivate.emit(());
        self.answer(Outcome::Error, outcome);
    }

    fn prepared(&mut self, end: Outcome, outcome: Event<Outcome>) {
        if matches!(self.pending, Some(Transition::Configure | Transition::CleanUp)) {
            self.answer(end, outcome);
        }
    }

    fn answer(&mut self, end: Outcome, outcome: Event<Outcome>) {
        self.pending = None;
        outcome.emit(end);
    }
}
