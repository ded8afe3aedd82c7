//! Operations: what a program does, one after the other.

use super::{BlockId, Fire, Flag, SlotCall};
use crate::{
    analyse::{ClusterId, Run},
    graph::{NodeId, PortId},
    machine::Move,
};
use std::collections::BTreeMap;

/// Operations in sequence.
pub type Ops = Vec<Op>;

/// Operation of a program.
#[derive(Debug)]
#[allow(missing_docs, reason = "the fields are called what they are")]
pub enum Op {
    // Activity
    /// Makes a node active. `then` happens if it was not.
    Activate { node: NodeId, then: Ops },
    /// Makes a node inactive. `then` happens if it was active.
    Deactivate { node: NodeId, then: Ops },
    /// Lets count what the tokens at the inputs of a node carried (A1): `gains` happens for activity, `loses` for the
    /// end of it if there is none. Empty where tokens never carry such a thing.
    TakeActivity { node: NodeId, gains: Ops, loses: Ops },
    /// Moves the activity at the input of a delay into it.
    HoldActivity(NodeId),
    /// Removes the activity that a delay holds.
    ClearHeld(NodeId),
    /// Lets the activity of a node go along with the token at a port, if there is one (A2, A5). `then` happens if it
    /// did.
    Pass { port: PortId, then: Ops },
    /// Lets the activity that the token of a delay carries go along with it.
    PassHeld(PortId),
    /// Calls the method of a node that is called when it becomes active, or inactive.
    Hook { node: NodeId, active: bool },
    /// Looks at the claims about activity.
    CheckClaims,
    /// Sets a flag, or clears it.
    Set(Flag, bool),
    /// Removes activity from all tokens on their way.
    ForgetTokens,
    /// Removes what `cancel` remembers for `resume`.
    ForgetCancelled(NodeId),
    /// Gives a node the activity back that `interrupt` took from it: `then` happens if it did.
    GiveBack { interrupt: NodeId, node: NodeId, then: Ops },
    /// Takes activity away.
    Cancel(Cancel),

    // Events and tokens
    /// Empties an event before its node may trigger it.
    Clear(PortId),
    /// Triggers an event without a value.
    Trigger(PortId),
    /// Sends the token at a port over its asynchronous connections, if there is one.
    Send(PortId),
    /// Takes the token of a slot away while `body` happens.
    Taking { port: PortId, body: Ops },
    /// Raises the condition that a cluster has finished, by its row.
    Settle(usize),
    /// Calls a slot if a token waits for it, and unless the program ends if `unless_exit`.
    Serve { slot: usize, unless_exit: bool },
    /// Calls slots for as long as a token waits for one of them.
    ServeCircle(Vec<usize>),

    // Slots
    /// Calls the method of a slot; `None` if it has none, which is a fault of the compiler. The token is taken away if
    /// `taken`.
    Call { slot: usize, taken: bool, call: Option<SlotCall> },
    /// Shows a probe the token of a slot.
    SeeSlot { slot: usize, taken: bool },
    /// Puts the token of a slot into the mailbox of an event of the program, of which `room` is the condition that it
    /// is empty.
    PutOut { slot: usize, taken: bool, room: Option<usize> },
    /// Ends the program.
    Exit(u8),
    /// Takes all activity away, and triggers `start`.
    Reset,
    /// Performs `cancel` or `resume`, by its port.
    Interrupt(PortId),
    /// Happens if a flag is set, or if it is not.
    If { flag: Flag, is: bool, then: Ops },
    /// Moves a state machine to another state.
    Move { node: NodeId, how: Move },
    /// Shows observers the initial states of state machines.
    ShowStates,
    /// Starts and stops the times of the states of a machine, which may have moved.
    TimeStates(NodeId),
    /// Calls the method of a machine that has been in a state for as long as its `after` with this number says.
    LeaveState { node: NodeId, wait: usize, call: SlotCall },

    // Time
    /// Starts the time of a timeout.
    StartTimeout(usize),
    /// Ends the time of a timeout.
    StopTimeout(usize),
    /// Sets a timer to its next time.
    Advance(usize),
    /// Starts the times of silences.
    Hear(Vec<usize>),
    /// Makes a firing as old as the oldest of its tokens: those of clusters, and those with these stamps. `leaves` if
    /// clusters downstream need it.
    Stamp { upstream: Vec<ClusterId>, stamps: Vec<usize>, leaves: Option<ClusterId> },

    // Clusters
    /// Takes the token that waits in a delay or at an input of the program, and comes in at this port.
    Take(PortId),
    /// Declares a token before the blocks that use it.
    Declare(PortId),
    /// Happens if all tokens are there.
    Block { block: BlockId, tokens: Vec<PortId>, body: Ops },
    /// Fires nodes of a region with several rates: the firings of each in turn.
    Iteration { runs: Vec<Run>, firings: BTreeMap<NodeId, Ops> },
    /// Takes a token that a delay holds, or one of this iteration if it holds no more.
    TakeDelayed(NodeId),
    /// Happens if a token has arrived at each of the inputs.
    IfArrived { inputs: Vec<PortId>, body: Ops },
    /// Fires a node.
    Fire { node: NodeId, fire: Fire },
    /// Happens if one of the tokens was sent.
    IfSent { tokens: Vec<PortId>, then: Ops },
    /// Shows observers the token at an output.
    Observe(PortId),
    /// Leaves a token in the program for other clusters.
    Store(PortId),
    /// Puts the tokens of an iteration into a delay.
    HoldIteration(NodeId),
}

impl Op {
    /// The operations inside of one.
    pub fn inner(&self) -> Vec<&[Op]> {
        match self {
            Self::Activate { then, .. }
            | Self::Deactivate { then, .. }
            | Self::Pass { then, .. }
            | Self::GiveBack { then, .. }
            | Self::If { then, .. }
            | Self::IfSent { then, .. }
            | Self::Taking { body: then, .. }
            | Self::Block { body: then, .. }
            | Self::IfArrived { body: then, .. } => vec![then],
            Self::TakeActivity { gains, loses, .. } => vec![gains, loses],
            Self::Cancel(cancel) => cancel.takes.iter().map(|taken| &*taken.then).collect(),
            Self::Iteration { firings, .. } => firings.values().map(|ops| &**ops).collect(),
            _ => vec![],
        }
    }
}

/// Taking activity out of nodes.
#[derive(Debug)]
pub struct Cancel {
    /// The node of the slot `cancel`.
    pub interrupt: NodeId,
    /// It remembers for `resume`.
    pub remembers: bool,
    /// It may have activity itself, which the token of `cancel` brought.
    pub is_reached: bool,
    /// From which nodes.
    pub takes: Vec<Taken>,
    /// Its event `cancelled`, if it is connected, and whether activity goes along.
    pub cancelled: Option<(PortId, bool)>,
}

/// Taking activity out of one node.
#[derive(Debug)]
pub struct Taken {
    /// The node.
    pub node: NodeId,
    /// Flags of tokens on their way to it.
    pub on_the_way: Vec<Flag>,
    /// The nodes to which `resume` gives it back.
    pub remember: Vec<NodeId>,
    /// Operations if there was activity.
    pub then: Ops,
}

/// Operations of the connection to a slot, after it was entered.
#[derive(Debug, Default)]
pub struct Served {
    /// Events that it may trigger, emptied.
    pub clear: Ops,
    /// Operations if its node has become active, or inactive.
    pub turned: Ops,
    /// The call.
    pub call: Ops,
    /// Operations after the call.
    pub after: Ops,
}
