//! Libraries for state machines: the ring of 16 states.

use crate::{Ran, timed};
use apex_bench::nodes::{Entered, Symbols};

/// Input symbol of the ring.
pub enum Symbol {
    /// To the next state.
    Next,
    /// Back to the first state.
    Reset,
}

fn read(symbols: &mut Symbols) -> Symbol {
    if symbols.is_reset() { Symbol::Reset } else { Symbol::Next }
}

/// statig: a method for each state and one for each entry.
pub mod statig {
    use super::{Entered, Ran, Symbol, Symbols, read, timed};
    use statig::prelude::*;

    /// The ring.
    #[derive(Default)]
    pub struct Ring {
        sink: Entered,
    }

    macro_rules! ring {
        ($($state:ident $name:literal $enter:ident $number:literal => $next:ident,)+) => {
            #[state_machine(initial = "State::s0()")]
            impl Ring {
                $(
                    #[state(entry_action = $name)]
                    fn $state(event: &Symbol) -> Outcome<State> {
                        match event {
                            Symbol::Next => Transition(State::$next()),
                            Symbol::Reset => Transition(State::s0()),
                        }
                    }

                    #[action]
                    fn $enter(&mut self) {
                        self.sink.s(&$number);
                    }
                )+
            }
        };
    }

    #[rustfmt::skip]
    ring! {
        s0 "enter1" enter1 1 => s1,
        s1 "enter2" enter2 2 => s2,
        s2 "enter3" enter3 3 => s3,
        s3 "enter4" enter4 4 => s4,
        s4 "enter5" enter5 5 => s5,
        s5 "enter6" enter6 6 => s6,
        s6 "enter7" enter7 7 => s7,
        s7 "enter8" enter8 8 => s8,
        s8 "enter9" enter9 9 => s9,
        s9 "enter10" enter10 10 => s10,
        s10 "enter11" enter11 11 => s11,
        s11 "enter12" enter12 12 => s12,
        s12 "enter13" enter13 13 => s13,
        s13 "enter14" enter14 14 => s14,
        s14 "enter15" enter15 15 => s15,
        s15 "enter16" enter16 16 => s0,
    }

    /// Runs the ring with its symbols.
    pub fn fsm16(ticks: u64) -> Ran {
        let mut symbols = Symbols::default();
        let mut ring = Ring::default().uninitialized_state_machine().init();
        let time = timed(|| {
            for _ in 0..ticks {
                ring.handle(&read(&mut symbols));
            }
        });
        Ran { time, checksum: ring.inner().sink.checksum() }
    }
}

/// smlang: a table of transitions with actions.
pub mod smlang {
    use super::{Entered, Ran, Symbol, Symbols, read, timed};
    use seq_macro::seq;
    use smlang::statemachine;

    statemachine! {
        transitions: {
            *S0 + Next / enter2 = S1,
            S1 + Next / enter3 = S2,
            S2 + Next / enter4 = S3,
            S3 + Next / enter5 = S4,
            S4 + Next / enter6 = S5,
            S5 + Next / enter7 = S6,
            S6 + Next / enter8 = S7,
            S7 + Next / enter9 = S8,
            S8 + Next / enter10 = S9,
            S9 + Next / enter11 = S10,
            S10 + Next / enter12 = S11,
            S11 + Next / enter13 = S12,
            S12 + Next / enter14 = S13,
            S13 + Next / enter15 = S14,
            S14 + Next / enter16 = S15,
            S15 + Next / enter1 = S0,
            _ + Reset / enter1 = S0,
        }
    }

    struct Context {
        sink: Entered,
    }

    seq!(N in 1..=16 {
        impl StateMachineContext for Context {
            #(
                fn enter~N(&mut self) -> Result<(), ()> {
                    self.sink.s(&N);
                    Ok(())
                }
            )*
        }
    });

    /// Runs the ring with its symbols.
    pub fn fsm16(ticks: u64) -> Ran {
        let (mut symbols, mut sink) = (Symbols::default(), Entered::default());
        sink.s(&1);
        let mut ring = StateMachine::new(Context { sink });
        let time = timed(|| {
            for _ in 0..ticks {
                let event = match read(&mut symbols) {
                    Symbol::Next => Events::Next,
                    Symbol::Reset => Events::Reset,
                };
                ring.process_event(event).expect("every state takes every event");
            }
        });
        Ran { time, checksum: ring.context().sink.checksum() }
    }
}
