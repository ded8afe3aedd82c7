//! `fsm` items.

use super::{Builder, push_doc};
use crate::syntax::{Rule, syntax_errors, tree::*};
use pest::iterators::Pair;

impl Builder<'_> {
    pub(super) fn machine(&mut self, pair: Pair<'_, Rule>) -> Option<FsmItem> {
        let extent = self.span(&pair);
        let (mut docs, mut name) = (String::new(), None);
        let (mut ports, mut states) = (vec![], vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut docs, &part),
                Rule::ident => name = Some(self.ident(&part)),
                Rule::fsm_stmt => match part.into_inner().next() {
                    Some(stmt) if stmt.as_rule() == Rule::port_stmt => ports.extend(self.port(stmt)),
                    Some(stmt) if stmt.as_rule() == Rule::state_item => states.extend(self.state(stmt)),
                    Some(stmt) => self.bad(syntax_errors::in_machine, &stmt),
                    None => {}
                },
                _ => {}
            }
        }
        Some(FsmItem { docs, name: name?, ports, states, extent })
    }

    fn state(&mut self, pair: Pair<'_, Rule>) -> Option<StateItem> {
        let extent = self.span(&pair);
        let (mut docs, mut name) = (String::new(), None);
        let (mut entry, mut exit, mut transitions, mut states) = (vec![], vec![], vec![], vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut docs, &part),
                Rule::ident => name = Some(self.ident(&part)),
                Rule::state_stmt => {
                    let Some(stmt) = part.into_inner().next() else { continue };
                    match stmt.as_rule() {
                        Rule::state_item => states.extend(self.state(stmt)),
                        Rule::transition => transitions.extend(self.transition(stmt)),
                        Rule::entry_exit => {
                            let is_entry = stmt.as_str().starts_with("entry");
                            let hook = if is_entry { &mut entry } else { &mut exit };
                            for actions in stmt.into_inner().filter(|p| p.as_rule() == Rule::actions) {
                                hook.extend(self.actions(actions));
                            }
                        }
                        _ => self.bad(syntax_errors::in_machine, &stmt),
                    }
                }
                _ => {}
            }
        }
        Some(StateItem { docs, name: name?, entry, exit, transitions, states, extent })
    }

    fn transition(&mut self, pair: Pair<'_, Rule>) -> Option<Transition> {
        let (mut cause, mut guard, mut target, mut returns, mut actions) = (None, None, None, None, vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::ident => cause = Some(Cause::Slot(self.ident(&part))),
                Rule::expr => cause = Some(Cause::After(self.expr(part))),
                Rule::guard => {
                    guard = part.into_inner().find(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p));
                }
                Rule::target => {
                    for part in part.into_inner() {
                        match part.as_rule() {
                            Rule::return_kw => {
                                returns = Some(Return { deep: part.as_str() == "resume", span: self.span(&part) });
                            }
                            _ => target = Some(self.ident(&part)),
                        }
                    }
                }
                Rule::actions => actions = self.actions(part),
                _ => {}
            }
        }
        Some(Transition { cause: cause?, guard, target, returns, actions })
    }

    fn actions(&mut self, pair: Pair<'_, Rule>) -> Vec<Action> {
        let actions = pair.into_inner().filter(|p| p.as_rule() == Rule::action).filter_map(|action| {
            let (mut event, mut value) = (None, None);
            for part in action.into_inner() {
                match part.as_rule() {
                    Rule::ident => event = Some(self.ident(&part)),
                    Rule::expr => value = Some(self.expr(part)),
                    _ => {}
                }
            }
            Some(Action { event: event?, value })
        });
        actions.collect()
    }
}
