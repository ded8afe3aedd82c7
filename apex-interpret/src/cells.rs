//! Cells between thread groups, which are run in turn.

use crate::{Value, ops::Run};
use apex_dsl::{
    graph::{NodeId, PortId},
    program::{Flag, Receiver, Sender},
    threads,
};
use apex_rt::{Ctx, Observer, Time};

/// Token on its way to another group.
struct Parcel {
    /// The token; `None` is ⊥.
    token: Option<Value>,
    /// It carries activity.
    active: bool,
    /// Time at which its source fired.
    stamp: Time,
}

/// State of a cell.
enum Content {
    /// A token can be put in.
    Free,
    /// A token waits.
    Full(Parcel),
    /// The receiver has taken the token, and is not done with it.
    Taken,
}

/// All cells of a program, and the groups that have to poll theirs.
pub struct Cells<'a> {
    ends: &'a [threads::Cell],
    contents: Vec<Content>,
    woken: Vec<bool>,
}

impl<'a> Cells<'a> {
    /// Empty cells between `groups` groups.
    pub fn new(ends: &'a [threads::Cell], groups: usize) -> Self {
        Self { ends, contents: ends.iter().map(|_| Content::Free).collect(), woken: vec![false; groups] }
    }

    /// Wakes all groups.
    pub fn wake_all(&mut self) {
        self.woken.fill(true);
    }

    /// Returns `true` if a group has been woken since the last call.
    pub fn take_woken(&mut self, group: usize) -> bool {
        std::mem::take(&mut self.woken[group])
    }

    /// Returns `true` if a group is awake.
    pub fn any_woken(&self) -> bool {
        self.woken.iter().any(|woken| *woken)
    }
}

impl<O: Observer> Run<'_, '_, O> {
    /// A token goes into its cell, or the other side is done with it. Returns `true` if that is a reason for another
    /// round.
    pub fn send_far(&mut self, sender: &Sender) -> bool {
        let cell = sender.end.cell;
        if self.state.conditions.has(sender.free) || !matches!(self.cells.contents[cell], Content::Free) {
            return false;
        }
        if !self.state.conditions.has(sender.token) {
            self.state.conditions.set(sender.free, true);
            if let Some(row) = sender.settles {
                self.state.conditions.settle(&self.code.program.rows, row);
            }
            if sender.carries {
                self.state.set(Flag::Active(sender.node), false);
            }
            return true;
        }
        self.state.conditions.set(sender.token, false);
        let active = sender.carries && self.state.take(Flag::Gains(sender.node));
        if active {
            self.state.set(Flag::Active(sender.node), true);
        }
        let token = self.state.tokens.get(&sender.from).cloned();
        let stamp = sender.stamp.map_or(Time::ZERO, |stamp| self.state.stamps[stamp]);
        self.cells.contents[cell] = Content::Full(Parcel { token, active, stamp });
        let receiver = self.cells.ends[cell].receiver;
        self.cells.woken[receiver] = true;
        false
    }

    /// A token comes out of its cell, or all that it caused has finished. Returns `true` if a token came.
    pub fn receive_far(&mut self, receiver: &Receiver, ctx: &Ctx) -> bool {
        let cell = receiver.end.cell;
        let all_free = self.state.conditions.all(&receiver.free);
        if all_free && self.state.holding.remove(&cell) {
            self.cells.contents[cell] = Content::Free;
            if let Some(sender) = self.cells.ends[cell].sender {
                self.cells.woken[sender] = true;
            }
        }
        let may_enter =
            !self.state.holding.contains(&cell) && (!receiver.is_silent || all_free) && self.state.steps > 0;
        if !may_enter || !matches!(self.cells.contents[cell], Content::Full(_)) {
            return false;
        }
        let Content::Full(parcel) = std::mem::replace(&mut self.cells.contents[cell], Content::Taken) else {
            return false;
        };
        self.put_token(PortId { node: receiver.node, port: 0 }, parcel.token);
        if receiver.carries && parcel.active {
            self.state.set(Flag::Active(receiver.node), true);
        }
        self.state.holding.insert(cell);
        let ctx = if receiver.is_stamped { ctx.since(parcel.stamp.min(ctx.now())) } else { *ctx };
        receiver.then.iter().for_each(|ops| self.outside(ops, &ctx));
        true
    }

    fn put_token(&mut self, port: PortId, token: Option<Value>) {
        match token {
            Some(token) => drop(self.state.tokens.insert(port, token)),
            None => drop(self.state.tokens.remove(&port)),
        }
    }

    /// Number of a node among all nodes, for observers.
    pub fn number(&self, node: NodeId) -> usize {
        self.code.numbers.own[node]
    }
}
