//! Possible line breaks of a source file, by the rules of the grammar.

use super::{
    columns,
    doc::{Doc, width},
    print::WIDTH,
};
use apex_dsl::syntax::{
    Rule,
    cst::{Child, Comment, Node, Token},
};

/// Makes documents from the nodes of a syntax tree.
pub struct Layout<'a, 't> {
    tokens: &'a [Token<'t>],
}

impl<'a, 't> Layout<'a, 't> {
    /// A layout for a source file with these tokens.
    pub fn new(tokens: &'a [Token<'t>]) -> Self {
        Self { tokens }
    }

    /// The whole source file: graphs, machines and tests are surrounded by empty lines.
    pub fn file(&self, file: &Node) -> Doc<'t> {
        let mut parts = vec![];
        let mut may_follow = true;
        for node in nodes(&file.kids) {
            let inner = only(node);
            let stands_alone = node.rule == Rule::item && inner.rule != Rule::use_item;
            let blank = (stands_alone || !may_follow) && node.rule != Rule::EOI;
            parts.extend([if blank { Doc::Blank } else { Doc::Fresh }, self.node(inner)]);
            may_follow = !stands_alone;
        }
        Doc::Concat(parts)
    }

    /// Any node.
    pub fn node(&self, node: &Node) -> Doc<'t> {
        use Rule::*;
        match node.rule {
            graph_item | fsm_item | test_item | tune_item | state_item | record_stmt => self.block(node),
            port_stmt | node_stmt | chain_stmt | transition | entry_exit => self.statement(node, 0),
            instance | handed_in => self.instance(node),
            expr => self.expr(node),
            claim_stmt => self.claim(node),
            thread_stmt => self.settings(node),
            params | args | list | list_expr | use_group | generics | type_args | tuple_ty => self.list(node),
            fields => self.fields(node),
            _ => self.words(&node.kids),
        }
    }

    /// One part of a node.
    pub fn kid(&self, kid: &Child) -> Doc<'t> {
        match kid {
            Child::Node(node) => self.node(node),
            Child::Token(token) => self.token(*token),
        }
    }

    /// A token with its comments.
    fn token(&self, index: usize) -> Doc<'t> {
        let token = &self.tokens[index];
        // Nothing is written before a separator: comments there are moved behind it.
        let (before, after) = match token.text {
            "," | ";" => (&[][..], &token.before[..]),
            _ => (&token.before[..], &[][..]),
        };
        let mut parts: Vec<Doc<'t>> = before.iter().flat_map(Self::before).collect();
        if token.begins && token.blank {
            parts.push(Doc::Blank);
        }
        if token.text.starts_with("//") {
            parts.extend([Doc::Fresh, Doc::text(token.text), Doc::Fresh]);
        } else {
            parts.push(Doc::text(token.text));
        }
        parts.extend(after.iter().chain(&token.after).map(Doc::comment));
        Doc::Concat(parts)
    }

    /// A comment in front of a token.
    pub fn before(written: &Comment<'t>) -> Vec<Doc<'t>> {
        let blank = if written.blank { Doc::Blank } else { Doc::NIL };
        match written.ends_line {
            true => vec![Doc::Fresh, blank, Doc::comment(written), Doc::Fresh],
            false => vec![blank, Doc::comment(written), Doc::Space],
        }
    }

    /// The first token of a part.
    pub fn first(&self, kid: &Child) -> &'a Token<'t> {
        match kid {
            Child::Token(token) => &self.tokens[*token],
            // Every rule matches something.
            Child::Node(node) => self.first(&node.kids[0]),
        }
    }

    /// The text of a part that is a single token.
    pub fn word(&self, kid: &Child) -> Option<&'t str> {
        match kid {
            Child::Token(token) => Some(self.tokens[*token].text),
            Child::Node(node) if node.kids.len() == 1 => self.word(&node.kids[0]),
            Child::Node(_) => None,
        }
    }

    /// Parts with blanks between them where necessary.
    pub fn words(&self, kids: &[Child]) -> Doc<'t> {
        let mut parts = vec![];
        for (i, kid) in kids.iter().enumerate() {
            if i > 0 && self.are_apart(&kids[i - 1], kid) {
                parts.push(Doc::Space);
            }
            parts.push(self.kid(kid));
        }
        Doc::Concat(parts)
    }

    fn are_apart(&self, left: &Child, right: &Child) -> bool {
        use Rule::*;
        let tight = |kid: &Child| matches!(rule(kid), Some(range_op)) || matches!(self.word(kid), Some("." | "::"));
        let holds = matches!(rule(left), Some(prefix)) || matches!(self.word(left), Some("(" | "["));
        let hangs = matches!(rule(right), Some(args | given | params | type_args | generics | unit_tag))
            || matches!(self.word(right), Some("," | ";" | ":" | "(" | ")" | "]"));
        !(tight(left) || tight(right) || holds || hangs)
    }

    /// A head, and statements in braces.
    fn block(&self, node: &Node) -> Doc<'t> {
        let is_brace = |kid: &Child| rule(kid) == Some(Rule::lbrace);
        let open = node.kids.iter().position(is_brace).unwrap_or(0);
        let (head, rest) = node.kids.split_at(open + 1);
        let [statements @ .., close] = rest else { return self.words(head) };
        let (inside, close) = self.closing(close);
        let is_empty = statements.is_empty() && inside.is_empty() && self.first(&node.kids[open]).after.is_empty();
        let mut body = self.statements(statements);
        body.extend(inside);
        let end = if is_empty { Doc::NIL } else { Doc::Fresh };
        Doc::Concat(vec![self.words(head), Doc::indent(body), end, close])
    }

    /// The comments before a closing bracket, and the bracket.
    pub fn closing(&self, close: &Child) -> (Vec<Doc<'t>>, Doc<'t>) {
        let token = self.first(close);
        let mut inside = vec![];
        for written in &token.before {
            inside.extend([Doc::Fresh, if written.blank { Doc::Blank } else { Doc::NIL }, Doc::comment(written)]);
        }
        let after = token.after.iter().map(Doc::comment);
        (inside, Doc::Concat([Doc::text(token.text)].into_iter().chain(after).collect()))
    }

    fn statements(&self, kids: &[Child]) -> Vec<Doc<'t>> {
        let statements: Vec<&Node> = nodes(kids).map(only).collect();
        let follows = |a: &&Node, b: &&Node| a.rule == b.rule && !self.has_blank(b);
        let mut parts = vec![];
        for run in statements.chunk_by(follows) {
            let widths: Vec<Option<usize>> = run.iter().map(|statement| self.cell_width(statement)).collect();
            for (statement, pad) in run.iter().zip(columns::pads(&widths)) {
                parts.extend([Doc::Fresh, self.statement(statement, pad)]);
            }
        }
        parts
    }

    /// Returns `true` if there is an empty line before a statement.
    fn has_blank(&self, node: &Node) -> bool {
        let first = self.first(&node.kids[0]);
        first.blank || first.before.iter().any(|c| c.blank)
    }

    /// Width of the first cell of a statement, behind which neighbouring statements are aligned. `None` if it contains
    /// a comment.
    fn cell_width(&self, statement: &Node) -> Option<usize> {
        let cell = statement.kids[..cell(statement)].iter().filter(|kid| rule(kid) != Some(Rule::doc));
        let tokens: Vec<&Token<'t>> = cell.flat_map(|kid| self.all(kid)).collect();
        let is_plain = |(i, token): (usize, &&Token<'t>)| {
            token.after.is_empty() && token.before.iter().all(|comment| i == 0 && comment.ends_line)
        };
        let is_cell = !tokens.is_empty() && tokens.iter().enumerate().all(is_plain);
        is_cell.then(|| tokens.iter().map(|token| width(token.text)).sum())
    }

    /// All tokens of a part.
    fn all(&self, kid: &Child) -> Vec<&'a Token<'t>> {
        match kid {
            Child::Token(token) => vec![&self.tokens[*token]],
            Child::Node(node) => node.kids.iter().flat_map(|kid| self.all(kid)).collect(),
        }
    }

    /// A statement with `pad` blanks behind its first cell.
    fn statement(&self, node: &Node, pad: usize) -> Doc<'t> {
        let (head, rest) = node.kids.split_at(cell(node));
        match (node.rule, rest) {
            (Rule::chain_stmt, _) => self.chain(node, pad),
            (Rule::transition, _) => self.transition(node, pad),
            (Rule::port_stmt | Rule::node_stmt | Rule::entry_exit, [next, ..]) => {
                let is_apart = head.last().is_some_and(|last| self.are_apart(last, next));
                let space = if is_apart { Doc::Space } else { Doc::NIL };
                Doc::Concat(vec![self.words(head), Doc::pad(pad), space, self.words(rest)])
            }
            _ => self.node(node),
        }
    }

    /// A transition, which may be broken before its guard and before an arrow.
    fn transition(&self, node: &Node, pad: usize) -> Doc<'t> {
        let [on, slot, steps @ .., semi] = &node.kids[..] else { return self.words(&node.kids) };
        let steps = [Doc::NIL].into_iter().chain(steps.iter().map(|step| self.kid(step))).collect();
        let head = [self.kid(on), Doc::Space, self.kid(slot), Doc::pad(pad)];
        Doc::Concat(head.into_iter().chain([Doc::indent(vec![Doc::Fill(steps)]), self.kid(semi)]).collect())
    }

    /// A chain, which may be broken before an arrow. A list at its end that does not fit into a line begins in the
    /// current one.
    fn chain(&self, node: &Node, pad: usize) -> Doc<'t> {
        let [head, links @ .., semi] = &node.kids[..] else { return self.words(&node.kids) };
        let mut links: Vec<Doc<'t>> = links.chunks(2).map(|link| self.words(link)).collect();
        let is_wide = |link: &Doc<'t>| link.flat().is_some_and(|text| width(&text) > WIDTH - 8);
        let last = links.pop_if(|last| is_wide(last));
        let last = last.map_or(vec![], |last| vec![Doc::Space, last]);
        let links = [Doc::NIL].into_iter().chain(links).collect();
        let mut parts = vec![self.kid(head), Doc::pad(pad), Doc::indent(vec![Doc::Fill(links)])];
        parts.extend(last);
        parts.push(self.kid(semi));
        Doc::Concat(parts)
    }

    /// An instance with its modifiers, which may follow in the next line.
    fn instance(&self, node: &Node) -> Doc<'t> {
        let is_modifier = |kid: &Child| rule(kid) == Some(Rule::modifier);
        let end = node.kids.iter().position(is_modifier).unwrap_or(node.kids.len());
        let (made_of, modifiers) = node.kids.split_at(end);
        let modifiers = modifiers.iter().flat_map(|modifier| [Doc::Line, self.kid(modifier)]).collect();
        Doc::Concat(vec![self.words(made_of), Doc::group(vec![Doc::indent(modifiers)])])
    }

    /// An expression, which may be broken before an operator.
    fn expr(&self, node: &Node) -> Doc<'t> {
        let is_binary = |kid: &Child| rule(kid) == Some(Rule::binary);
        let mut operands = node.kids.chunk_by(|_, next| !is_binary(next)).map(|operand| self.words(operand));
        let first = operands.next().unwrap_or(Doc::NIL);
        let others: Vec<Doc<'t>> = operands.collect();
        if others.is_empty() {
            return first;
        }
        Doc::Concat(vec![first, Doc::indent(vec![Doc::Fill([Doc::NIL].into_iter().chain(others).collect())])])
    }
}

/// Number of parts in the first cell of a statement.
fn cell(statement: &Node) -> usize {
    use Rule::*;
    let has = |end: Rule| statement.kids.iter().position(|kid| rule(kid) == Some(end)).map(|at| at + 1);
    let end = match statement.rule {
        port_stmt => has(port_kind),
        node_stmt => has(colon).or_else(|| has(ident)),
        entry_exit => has(hook_kw),
        transition if has(guard).is_none() => has(ident),
        chain_stmt
            if nodes(&statement.kids).next().is_some_and(|head| matches!(only(head).rule, port_ref | all_ports)) =>
        {
            Some(1)
        }
        _ => None,
    };
    end.unwrap_or(0)
}

/// The rule of a part; `None` for a plain token.
pub fn rule(kid: &Child) -> Option<Rule> {
    match kid {
        Child::Node(node) => Some(node.rule),
        Child::Token(_) => None,
    }
}

/// The parts that are not plain tokens.
pub fn nodes(kids: &[Child]) -> impl Iterator<Item = &Node> {
    kids.iter().filter_map(|kid| match kid {
        Child::Node(node) => Some(node),
        Child::Token(_) => None,
    })
}

/// The single node in `node`, if the rule of `node` only chooses between other rules.
pub fn only(node: &Node) -> &Node {
    use Rule::*;
    match (node.rule, &node.kids[..]) {
        (item | stmt | fsm_stmt | state_stmt | test_stmt | tune_stmt | endpoint | primary, [Child::Node(inner)]) => {
            inner
        }
        _ => node,
    }
}
