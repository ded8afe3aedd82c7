//! Lists in brackets, separated by commas.

use super::{
    doc::{Doc, width},
    layout::{Layout, nodes, only, rule},
};
use apex_dsl::syntax::{
    Rule,
    cst::{Child, Node},
};

/// Widest row of a matrix whose numbers are aligned in columns.
const WIDEST_ROW: usize = 80;

/// An element, and the comma behind it.
struct Element<'k> {
    value: &'k Child,
    comma: Option<&'k Child>,
}

/// Treatment of a comma.
#[derive(Clone, Copy)]
enum Comma {
    Stays,
    /// Written only if the list is broken.
    IfBroken,
    Goes,
}

impl<'t> Layout<'_, 't> {
    /// A list that fills its lines if the elements are short, and otherwise has one element per line.
    pub fn list(&self, node: &Node) -> Doc<'t> {
        match &node.kids[..] {
            [open, arg, .., close] if self.is_hugged(node) => {
                Doc::Concat(vec![self.kid(open), self.kid(arg), self.kid(close)])
            }
            kids => match self.columns(node) {
                Some(columns) => self.brackets(kids, |elements| self.rows(elements, &columns)),
                None if nodes(kids).all(is_short) => self.brackets(kids, |elements| Doc::Fill(self.items(elements))),
                None => self.brackets(kids, |elements| {
                    let items = self.items(elements).into_iter().enumerate();
                    Doc::Concat(items.flat_map(|(i, item)| [line(i), item]).collect())
                }),
            },
        }
    }

    /// `claim exclusive(a, b);`
    pub fn claim(&self, node: &Node) -> Doc<'t> {
        match &node.kids[..] {
            [word, kind, of @ .., semi] if !of.is_empty() => {
                let of = self.brackets(of, |elements| Doc::Fill(self.items(elements)));
                Doc::Concat(vec![self.kid(word), Doc::Space, self.kid(kind), of, self.kid(semi)])
            }
            kids => self.words(kids),
        }
    }

    /// `thread vision { cores = [1]; priority = 80 }`
    pub fn settings(&self, node: &Node) -> Doc<'t> {
        let is_brace = |kid: &Child| rule(kid) == Some(Rule::lbrace);
        let open = node.kids.iter().position(is_brace).unwrap_or(0);
        let (head, rest) = node.kids.split_at(open + 1);
        let [inner @ .., close] = rest else { return self.words(&node.kids) };
        let (settings, (inside, close)) = (elements(inner), self.closing(close));
        let mut body = vec![];
        for setting in &settings {
            let end = if setting.comma.is_some() { Doc::text(";") } else { Doc::NIL };
            body.extend([Doc::Line, self.kid(setting.value), self.separator(setting, end)]);
        }
        body.extend(inside);
        let end = if settings.is_empty() { Doc::SoftLine } else { Doc::Line };
        Doc::group(vec![self.words(head), Doc::indent(body), end, close])
    }

    /// The fields of a struct: `{ x: 1m, y: 0m }`
    pub fn fields(&self, node: &Node) -> Doc<'t> {
        let [open, inner @ .., close] = &node.kids[..] else { return self.words(&node.kids) };
        let (fields, (inside, close)) = (elements(inner), self.closing(close));
        let mut body = vec![];
        for (number, field) in fields.iter().enumerate() {
            let is_last = number + 1 == fields.len();
            let comma = self.comma(field, if is_last { Comma::IfBroken } else { Comma::Stays });
            body.extend([Doc::Line, self.kid(field.value), comma]);
        }
        body.extend(inside);
        let end = if fields.is_empty() { Doc::SoftLine } else { Doc::Line };
        Doc::group(vec![self.kid(open), Doc::indent(body), end, close])
    }

    /// A list in brackets: `kids` from the opening bracket to the closing one.
    fn brackets(&self, kids: &[Child], body: impl FnOnce(&[Element<'_>]) -> Doc<'t>) -> Doc<'t> {
        let [open, inner @ .., close] = kids else { return self.words(kids) };
        let elements = elements(inner);
        let (inside, close) = self.closing(close);
        let start = if elements.is_empty() { Doc::NIL } else { Doc::SoftLine };
        let comma = elements.last().map_or(Doc::NIL, |last| self.last_comma(last, elements.len()));
        let body = [start, body(&elements), comma].into_iter().chain(inside).collect();
        let (mut parts, open) = self.opening(open);
        parts.push(Doc::group(vec![open, Doc::indent(body), Doc::SoftLine, close]));
        Doc::Concat(parts)
    }

    /// The comments and the empty line before an opening bracket with which a statement begins, and the bracket. They
    /// are not in one line with the list, whether it is broken or not.
    fn opening(&self, open: &Child) -> (Vec<Doc<'t>>, Doc<'t>) {
        let token = self.first(open);
        if !token.begins {
            return (vec![], self.kid(open));
        }
        let mut before: Vec<Doc<'t>> = token.before.iter().flat_map(Self::before).collect();
        before.extend(token.blank.then_some(Doc::Blank));
        let after = token.after.iter().map(Doc::comment);
        (before, Doc::Concat([Doc::text(token.text)].into_iter().chain(after).collect()))
    }

    /// The elements with the commas between them.
    fn items(&self, elements: &[Element<'_>]) -> Vec<Doc<'t>> {
        let Some((last, others)) = elements.split_last() else { return vec![] };
        let others = others.iter().map(|e| Doc::Concat(vec![self.kid(e.value), self.comma(e, Comma::Stays)]));
        others.chain([self.kid(last.value)]).collect()
    }

    /// The comma behind the last of `count` elements.
    fn last_comma(&self, last: &Element<'_>, count: usize) -> Doc<'t> {
        // A type in parentheses is a tuple only with a comma.
        let is_tuple = rule(last.value) == Some(Rule::ty) && last.comma.is_some() && count == 1;
        self.comma(last, if is_tuple { Comma::Stays } else { Comma::IfBroken })
    }

    /// The comma behind an element, with its comments.
    fn comma(&self, element: &Element<'_>, comma: Comma) -> Doc<'t> {
        let text = match comma {
            Comma::Stays => Doc::text(","),
            Comma::IfBroken => Doc::Broken(",".into()),
            Comma::Goes => Doc::NIL,
        };
        self.separator(element, text)
    }

    /// The separator behind an element, with its comments.
    fn separator(&self, element: &Element<'_>, text: Doc<'t>) -> Doc<'t> {
        let token = element.comma.map(|comma| self.first(comma));
        let comments = token.into_iter().flat_map(|token| token.before.iter().chain(&token.after));
        Doc::Concat([text].into_iter().chain(comments.map(Doc::comment)).collect())
    }

    /// Returns `true` if the only argument is a list: its brackets and the parentheses open and close together.
    fn is_hugged(&self, args: &Node) -> bool {
        let [open, Child::Node(arg), rest @ ..] = &args.kids[..] else { return false };
        let is_list = nodes(&arg.kids).last().and_then(sole_value).is_some_and(|value| value.rule == Rule::list_expr);
        let has_no_comment = |kid: &Child| self.first(kid).before.is_empty() && self.first(kid).after.is_empty();
        let [commas @ .., close] = rest else { return false };
        args.rule == Rule::args
            && is_list
            && commas.iter().all(|kid| rule(kid).is_none() && has_no_comment(kid))
            && self.first(open).after.is_empty()
            && self.first(close).before.is_empty()
    }

    /// Widths of the columns, if this is a list of lists whose numbers can be aligned.
    fn columns(&self, list: &Node) -> Option<Vec<usize>> {
        if list.rule != Rule::list_expr {
            return None;
        }
        let rows = nodes(&list.kids).map(|row| sole_value(row).filter(|row| row.rule == Rule::list_expr));
        let mut widths: Vec<Vec<usize>> = vec![];
        for row in rows {
            widths.push(nodes(&row?.kids).map(|cell| Some(width(&self.node(cell).flat()?))).collect::<Option<_>>()?);
        }
        let count = widths.first()?.len();
        let columns: Vec<usize> =
            (0..count).map(|i| widths.iter().filter_map(|row| row.get(i)).copied().max().unwrap_or(0)).collect();
        let fits = columns.iter().sum::<usize>() + 2 * count <= WIDEST_ROW;
        (widths.len() > 1 && count > 0 && fits && widths.iter().all(|row| row.len() == count)).then_some(columns)
    }

    /// One row per line, in columns of these widths.
    fn rows(&self, rows: &[Element<'_>], columns: &[usize]) -> Doc<'t> {
        let mut parts = vec![];
        for (i, row) in rows.iter().enumerate() {
            parts.push(line(i));
            if let Child::Node(row) = row.value {
                parts.push(sole_value(row).map_or_else(|| self.node(row), |list| self.row(list, columns)));
            }
            if i + 1 < rows.len() {
                parts.push(self.comma(row, Comma::Stays));
            }
        }
        Doc::Concat(parts)
    }

    fn row(&self, row: &Node, columns: &[usize]) -> Doc<'t> {
        let [open, inner @ .., close] = &row.kids[..] else { return self.words(&row.kids) };
        let mut parts = vec![self.kid(open)];
        for (i, (cell, column)) in elements(inner).iter().zip(columns).enumerate() {
            let value = self.kid(cell.value);
            let pad = column.saturating_sub(value.flat().map_or(0, |text| width(&text)));
            let is_last = i + 1 == columns.len();
            let comma = self.comma(cell, if is_last { Comma::Goes } else { Comma::Stays });
            parts.extend([Doc::Broken(" ".repeat(pad).into()), value, comma]);
            parts.push(if is_last { Doc::NIL } else { Doc::Space });
        }
        parts.push(self.kid(close));
        Doc::Concat(parts)
    }
}

fn elements(inner: &[Child]) -> Vec<Element<'_>> {
    let mut elements: Vec<Element<'_>> = vec![];
    for kid in inner {
        match elements.last_mut() {
            Some(last) if rule(kid).is_none() => last.comma = Some(kid),
            _ => elements.push(Element { value: kid, comma: None }),
        }
    }
    elements
}

/// Line break before an element. The first element directly follows the opening bracket.
fn line<'t>(index: usize) -> Doc<'t> {
    if index == 0 { Doc::NIL } else { Doc::Line }
}

/// The value of an expression without operators.
fn sole_value(expr: &Node) -> Option<&Node> {
    match &expr.kids[..] {
        [Child::Node(primary)] if expr.rule == Rule::expr => Some(only(primary)),
        _ => None,
    }
}

/// Returns `true` if several of these elements may be written in one line.
fn is_short(element: &Node) -> bool {
    match element.rule {
        Rule::param => false,
        Rule::endpoint => matches!(only(element).rule, Rule::port_ref | Rule::all_ports),
        _ => !holds_list(element),
    }
}

fn holds_list(node: &Node) -> bool {
    matches!(node.rule, Rule::list_expr | Rule::use_group) || nodes(&node.kids).any(holds_list)
}
