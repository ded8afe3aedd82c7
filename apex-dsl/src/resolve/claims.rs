//! Resolution of the names in claims to nodes and nested graphs.

use super::{
    builder::{Body, Builder},
    standard::own_node,
    suggest::suggest,
    table::{Symbol, Table},
};
use crate::{
    graph::{Claim, ClaimKind, Subject},
    report::Diagnostic,
    syntax::tree::{self, PortRef},
};
use std::collections::BTreeMap;

/// Largest number of claims of a program.
const MAX_CLAIMS: usize = 256;

impl Builder<'_> {
    /// Resolves the claims of a graph body. The numbers of its nodes and scopes begin at `node` and `scope`.
    pub fn resolve_claims(&mut self, body: &Body<'_>, table: &Table, (node, scope): (usize, usize)) {
        if body.item.claims.is_empty() {
            return;
        }
        let nodes = self.nodes.iter_enumerated().skip(node).filter(|(_, n)| n.scope == body.scope);
        let mut subjects: BTreeMap<String, Subject> =
            nodes.map(|(id, n)| (n.name.clone(), Subject::Node(id))).collect();
        let scopes = self.scopes.iter_enumerated().skip(scope).filter(|(_, s)| s.parent == body.scope);
        subjects.extend(scopes.map(|(id, s)| (s.name.clone(), Subject::Scope(id))));
        for claim in &body.item.claims {
            if self.is_exhausted() || self.look(claim.of.len(), claim.span).is_none() {
                return;
            }
            let Some(made) = self.claim(body, claim, table, &subjects) else { continue };
            if self.claims.len() == MAX_CLAIMS {
                let message = format!("this program has more than {MAX_CLAIMS} claims");
                self.diagnostics.push(
                    Diagnostic::error("too-large", claim.span, message)
                        .note("a claim in a nested graph counts once for each use of the graph"),
                );
                return;
            }
            self.claims.push(made);
        }
    }

    fn claim(
        &mut self,
        body: &Body<'_>,
        claim: &tree::Claim,
        table: &Table,
        subjects: &BTreeMap<String, Subject>,
    ) -> Option<Claim> {
        let Some(kind) = ClaimKind::ALL.into_iter().find(|k| k.word() == claim.kind.text) else {
            let message = format!("there is no claim `{}`", claim.kind.text);
            let error = Diagnostic::error("unknown-claim", claim.kind.span, message);
            let error = suggest(error, &claim.kind, ClaimKind::ALL.into_iter().map(ClaimKind::word));
            self.diagnostics
                .push(error.note("claims are `exclusive(a, b, …)`, `reaches(a, b)`, `conserved` and `live`"));
            return None;
        };
        self.check_count(kind, claim)?;
        let found: Vec<Option<Subject>> =
            claim.of.iter().map(|name| self.subject(body, name, table, subjects)).collect();
        let of: Vec<Subject> = found.into_iter().collect::<Option<_>>()?;
        let mut seen = BTreeMap::new();
        for (subject, name) in of.iter().zip(&claim.of) {
            if let Some(first) = seen.insert(*subject, name.span) {
                let message =
                    format!("`{}` is named twice: the nodes of a claim must be different", name.parts[0].text);
                self.diagnostics.push(
                    Diagnostic::error("wrong-claim", name.span, message)
                        .also(first, "first named here")
                        .note("remove one of the two"),
                );
                return None;
            }
        }
        Some(Claim { kind, of, span: claim.span })
    }

    fn check_count(&mut self, kind: ClaimKind, claim: &tree::Claim) -> Option<()> {
        let (fits, wanted, form) = match (kind, claim.of.len()) {
            (ClaimKind::Exclusive, n) => (n >= 2, "at least two names", "exclusive(a, b)"),
            (ClaimKind::Reaches, n) => (n == 2, "two names", "reaches(a, b)"),
            (ClaimKind::Conserved | ClaimKind::Live, n) => (n == 0, "no names", kind.word()),
        };
        if fits {
            return Some(());
        }
        let message = match claim.of.len() {
            0 => format!("`{}` takes {wanted}, but none is given", kind.word()),
            1 => format!("`{}` takes {wanted}, but one is given", kind.word()),
            n => format!("`{}` takes {wanted}, but {n} are given", kind.word()),
        };
        self.diagnostics
            .push(Diagnostic::error("wrong-claim", claim.span, message).note(format!("write it as `claim {form};`")));
        None
    }

    fn subject(
        &mut self,
        body: &Body<'_>,
        name: &PortRef,
        table: &Table,
        subjects: &BTreeMap<String, Subject>,
    ) -> Option<Subject> {
        let first = name.parts.first()?;
        let text = &first.text;
        let error = match (table.get(text), &name.parts[1..]) {
            (Some((Symbol::Broken, _)), _) => return None,
            (Some((Symbol::Ports(..), _)), []) => match subjects.get(text) {
                Some(subject) => return Some(*subject),
                None => return None,
            },
            (Some((Symbol::Ports(..), _)), [rest, ..]) => {
                let message =
                    format!("a claim can only name nodes of its own graph, not `{}` inside one of them", rest.text);
                Diagnostic::error("wrong-claim", name.span, message).note(format!(
                    "name `{text}`, which is active while any node in it is, or write the claim in its graph"
                ))
            }
            (Some((Symbol::Own(_), declared)), _) => {
                let message = format!("`{text}` is a port, which is never active: a claim can only name nodes");
                Diagnostic::error("wrong-claim", name.span, message).also(declared, "declared here")
            }
            (None, _) if own_node(text).is_some() => {
                let message = format!("`{text}` is never active: a claim can only name nodes that can be active");
                Diagnostic::error("wrong-claim", name.span, message)
                    .note("name the node that activity comes from or goes to")
            }
            (None, _) => {
                self.unknown_name(body, table, first);
                return None;
            }
        };
        self.diagnostics.push(error);
        None
    }
}
