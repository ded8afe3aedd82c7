//! Tokens that are sent to another thread group, and taken from one.

use crate::{
    Value,
    cells::{Content, Parcel},
    run::Run,
};
use apex_dsl::{
    graph::{NodeId, PortId},
    program::{Flag, Receiver, Sender},
};
use apex_rt::{Ctx, Observer, Time};

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
