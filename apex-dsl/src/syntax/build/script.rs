//! `test` and `tune` items.

use super::{Builder, push_doc};
use crate::{
    report::Diagnostic,
    syntax::{Rule, syntax_errors, tokens::unescape, tree::*},
};
use pest::iterators::Pair;

/// Operators for comparing a token with a value.
const COMPARISONS: [&str; 6] = ["==", "!=", "<=", ">=", "<", ">"];

impl Builder<'_> {
    pub(super) fn test(&mut self, pair: Pair<'_, Rule>) -> Option<TestItem> {
        let extent = self.span(&pair);
        let mut study = (pair.as_rule() == Rule::tune_item).then(StudyItem::default);
        let (mut docs, mut name, mut graph) = (String::new(), None, None);
        let (mut args, mut replaced, mut steps) = (vec![], vec![], vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut docs, &part),
                Rule::ident => name = Some(self.ident(&part)),
                Rule::path => graph = Some(self.path(part)),
                Rule::args => {
                    args = part.into_inner().filter(|p| p.as_rule() == Rule::arg).filter_map(|p| self.arg(p)).collect();
                }
                Rule::test_stmt | Rule::tune_stmt => {
                    let Some(stmt) = part.into_inner().next() else { continue };
                    match (stmt.as_rule(), &mut study) {
                        (Rule::replace_stmt, _) => replaced.extend(self.replaced(stmt)),
                        (Rule::bad_test, _) => self.bad(syntax_errors::in_test, &stmt),
                        (Rule::bad_tune, _) => self.bad(syntax_errors::in_tune, &stmt),
                        // What must never happen must not happen before this statement either.
                        (Rule::require_stmt, Some(study)) => {
                            steps.splice(0..0, self.study_statement(stmt, study));
                        }
                        (_, Some(study)) => steps.extend(self.study_statement(stmt, study)),
                        (_, None) => steps.extend(self.test_step(stmt)),
                    }
                }
                _ => {}
            }
        }
        let (name, graph) = (name?, graph?);
        let span = name.span.to(graph.span);
        Some(TestItem { docs, name, graph, args, replaced, steps, study, span, extent })
    }

    /// Adds a statement to a study, unless it is a step of its script, which is returned.
    fn study_statement(&mut self, pair: Pair<'_, Rule>, study: &mut StudyItem) -> Option<TestStep> {
        let rule = pair.as_rule();
        if !matches!(
            rule,
            Rule::vary_stmt | Rule::goal_stmt | Rule::require_stmt | Rule::seeds_stmt | Rule::holdout_stmt
        ) {
            return self.test_step(pair);
        }
        let (mut of, mut range, mut value, mut maximise, mut never) = (None, None, None, false, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::port_ref => of = Some(self.port_ref(part)),
                Rule::limits => range = self.range(part),
                Rule::expr => value = Some(self.expr(part)),
                Rule::goal_kw => maximise = part.as_str().starts_with("maximise"),
                Rule::ident => study.required.push(self.ident(&part)),
                Rule::condition => never = self.condition(part).map(TestStep::Never),
                _ => {}
            }
        }
        match (rule, of, value) {
            (Rule::vary_stmt, Some(of), _) => study.vary.push((of, range)),
            (Rule::goal_stmt, Some(of), share) => study.goals.push(GoalItem { of, maximise, share }),
            (Rule::seeds_stmt, _, Some(seeds)) => self.seeds(seeds, study),
            (Rule::holdout_stmt, _, Some(value)) => study.held_out.push(value),
            _ => {}
        }
        never
    }

    fn seeds(&mut self, seeds: Expr, study: &mut StudyItem) {
        if let Some(first) = &study.seeds {
            let error = Diagnostic::error("wrong-study", seeds.span, "the number of seeds is given twice");
            self.diagnostics.push(error.also(first.span, "first given here").note("remove one of the two"));
        } else {
            study.seeds = Some(seeds);
        }
    }

    fn replaced(&mut self, pair: Pair<'_, Rule>) -> Option<(PortRef, Instance)> {
        let (mut of, mut instance) = (None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::port_ref => of = Some(self.port_ref(part)),
                Rule::instance => instance = Some(self.instance(part)),
                _ => {}
            }
        }
        Some((of?, instance?))
    }

    fn test_step(&mut self, pair: Pair<'_, Rule>) -> Option<TestStep> {
        let rule = pair.as_rule();
        let (mut port, mut values, mut every, mut condition, mut limit) = (None, vec![], None, None, None);
        let mut recording = vec![];
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::ident => port = Some(self.ident(&part)),
                Rule::expr => values.push(self.expr(part)),
                Rule::every => every = part.into_inner().find(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p)),
                Rule::recording => {
                    let texts = part.into_inner().filter(|p| p.as_rule() == Rule::string);
                    recording.extend(texts.map(|text| unescape(text.as_str())));
                }
                Rule::condition => condition = self.condition(part),
                Rule::limit => {
                    let kind = if part.as_str().starts_with("by") { Limit::By } else { Limit::Within };
                    limit = part.into_inner().find(|p| p.as_rule() == Rule::expr).map(|p| (kind, self.expr(p)));
                }
                _ => {}
            }
        }
        Some(match rule {
            Rule::feed_stmt => match <[String; 2]>::try_from(recording) {
                Ok([file, channel]) => TestStep::FeedRecorded(port?, file, channel),
                Err(_) => TestStep::Feed(port?, values.pop(), every),
            },
            Rule::wait_stmt => TestStep::Wait(values.pop()?),
            Rule::never_stmt => TestStep::Never(condition?),
            _ => TestStep::Expect(condition?, limit),
        })
    }

    fn condition(&mut self, pair: Pair<'_, Rule>) -> Option<Condition> {
        let span = self.span(&pair);
        let (mut of, mut active, mut operator, mut value, mut tolerance) = (None, false, None, None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::port_ref => of = Some(self.port_ref(part)),
                Rule::active_kw => active = true,
                // Pairs include the white space behind an operator.
                Rule::compare => operator = COMPARISONS.into_iter().find(|c| *c == part.as_str().trim_end()),
                Rule::expr => value = Some(self.expr(part)),
                Rule::tolerance => {
                    tolerance = part.into_inner().find(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p));
                }
                _ => {}
            }
        }
        Some(Condition { of: of?, active, compare: operator.zip(value), tolerance, span })
    }
}
