//! State machines in a run: their calls, events and times.

use crate::{
    machine::{Running, Sent},
    run::Run,
};
use apex_dsl::{
    graph::{NodeId, PortId},
    program::SlotCall,
};
use apex_rt::{Ctx, Observer, turned};

impl<O: Observer> Run<'_, '_, O> {
    /// Observers see the first states of the machines.
    pub fn show_states(&mut self) {
        let code = self.code;
        code.numbers.states.values().for_each(|first| self.observer.activity(*first, true));
    }

    /// Calls a machine. Its events are triggered, and observers are told if it is in another state.
    pub fn call_machine(&mut self, node: NodeId, call: impl FnOnce(&mut Running<'_>) -> Sent) {
        let Some(machine) = self.state.machines.get_mut(&node) else { return };
        let left = machine.state();
        let sent = call(machine);
        let entered = machine.state();
        for (port, token) in sent {
            self.triggered(PortId { node, port }, token);
        }
        if let Some(first) = self.code.numbers.states.get(&node) {
            turned(self.observer, first + left, first + entered);
        }
    }

    /// A machine has been in a state for as long as its `after` with this number says.
    pub fn leave_state(&mut self, node: NodeId, wait: usize, call: &SlotCall, ctx: &Ctx) {
        self.call_machine(node, |machine| machine.expire(wait));
        self.late(node, call.deadline, ctx);
    }

    /// Starts and stops the times of the states of a machine.
    pub fn time_states(&mut self, node: NodeId, ctx: &Ctx) {
        let Some(machine) = self.state.machines.get_mut(&node) else { return };
        let waits = machine.take_waits();
        let Some(first) = self.code.program.wiring.first_wait(node) else { return };
        for (timeout, begins) in (first..).zip(waits) {
            match begins {
                Some(true) => self.start_timeout(timeout, ctx),
                Some(false) => self.state.timeouts[timeout].stop(),
                None => {}
            }
        }
    }
}
