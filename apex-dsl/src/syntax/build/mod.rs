//! Construction of the syntax tree from the pairs of pest.

mod expr;
mod machine;
mod script;

use super::{grammar::Rule, syntax_errors, tokens::unescape, tree::*};
use crate::{
    report::{Diagnostic, Diagnostics},
    source::{FileId, Span},
};
use pest::iterators::Pair;

/// Builder of the tree of one source file.
pub struct Builder<'a> {
    file: FileId,
    text: &'a str,
    diagnostics: &'a mut Diagnostics,
    broken: bool,
    broken_items: bool,
    /// Number of operators and values in the expressions that are being built.
    open: usize,
    /// Places, in ascending order, where the text was changed to make it parsable. Errors around them have been
    /// reported.
    edits: Vec<usize>,
    /// End of the original text. No span goes beyond it, because the rest was added to make the text parsable.
    end: usize,
}

impl<'a> Builder<'a> {
    /// A builder for `file`, whose text was changed at the places `edits`.
    pub fn new(file: FileId, text: &'a str, edits: Vec<usize>, diagnostics: &'a mut Diagnostics) -> Self {
        Self { file, text, diagnostics, broken: false, broken_items: false, open: 0, edits, end: text.len() }
    }

    /// The same builder for a text whose first `end` bytes were written by the user.
    pub fn until(self, end: usize) -> Self {
        Self { end, ..self }
    }

    fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        span_of(self.file, pair, self.end)
    }

    /// Builds the tree of the whole source file.
    pub fn file(mut self, pair: Pair<'_, Rule>) -> File {
        let mut file = File::default();
        for pair in pair.into_inner() {
            match pair.as_rule() {
                Rule::inner_doc => push_doc(&mut file.docs, &pair),
                Rule::item => {
                    file.imports_at.get_or_insert(pair.as_span().start());
                    for item in pair.into_inner() {
                        self.item(item, &mut file);
                    }
                }
                _ => {}
            }
        }
        file.broken = self.broken;
        file.broken_items = self.broken_items;
        file
    }

    fn item(&mut self, pair: Pair<'_, Rule>, file: &mut File) {
        match pair.as_rule() {
            Rule::use_item => {
                for tree in pair.into_inner().filter(|p| p.as_rule() == Rule::use_tree) {
                    self.use_tree(tree, &[], &mut file.uses);
                }
            }
            Rule::graph_item => {
                let graph = self.graph(pair);
                file.graphs.push(graph);
            }
            Rule::test_item | Rule::tune_item => file.tests.extend(self.test(pair)),
            Rule::fsm_item => file.machines.extend(self.machine(pair)),
            _ => {
                self.broken_items = true;
                self.bad(syntax_errors::item, &pair);
            }
        }
    }

    fn use_tree(&self, pair: Pair<'_, Rule>, prefix: &[Ident], uses: &mut Vec<Use>) {
        let mut path = prefix.to_vec();
        let mut alias = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::path => path.extend(self.path(part).segments),
                Rule::ident => alias = Some(self.ident(&part)),
                Rule::use_group => {
                    for tree in part.into_inner().filter(|p| p.as_rule() == Rule::use_tree) {
                        self.use_tree(tree, &path, uses);
                    }
                    return;
                }
                _ => {}
            }
        }
        if let Some(last) = path.last() {
            let name = alias.unwrap_or_else(|| last.clone());
            uses.push(Use { path, name });
        }
    }

    fn ident(&self, pair: &Pair<'_, Rule>) -> Ident {
        Ident { text: pair.as_str().to_owned(), span: self.span(pair) }
    }

    fn path(&self, pair: Pair<'_, Rule>) -> PathExpr {
        let span = self.span(&pair);
        let segments = pair.into_inner().filter(|p| p.as_rule() == Rule::name).map(|p| self.ident(&p)).collect();
        PathExpr { segments, span }
    }

    fn graph(&mut self, pair: Pair<'_, Rule>) -> GraphItem {
        let mut graph = GraphItem {
            docs: String::new(),
            robot: false,
            is_public: false,
            name: Ident { text: String::new(), span: self.span(&pair) },
            generics: vec![],
            params: vec![],
            base: None,
            ports: vec![],
            nodes: vec![],
            chains: vec![],
            claims: vec![],
            threads: vec![],
            records: vec![],
            extent: self.span(&pair),
        };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut graph.docs, &part),
                Rule::pub_kw => graph.is_public = true,
                Rule::graph_kw => graph.robot = part.as_str() == "robot",
                Rule::ident => graph.name = self.ident(&part),
                Rule::generics => graph.generics = part.into_inner().map(|p| self.ident(&p)).collect(),
                Rule::params => {
                    graph.params =
                        part.into_inner().filter(|p| p.as_rule() == Rule::param).map(|p| self.param(p)).collect();
                }
                Rule::base => graph.base = part.into_inner().find(|p| p.as_rule() == Rule::path).map(|p| self.path(p)),
                Rule::stmt => {
                    for stmt in part.into_inner() {
                        self.statement(stmt, &mut graph);
                    }
                }
                _ => {}
            }
        }
        graph
    }

    /// Reports text that could not be parsed, as explained by `explain`.
    fn bad(&mut self, explain: fn(FileId, usize, &str) -> Diagnostic, pair: &Pair<'_, Rule>) {
        self.broken = true;
        let (start, end) = (pair.as_span().start(), pair.as_span().end());
        let blanks = self.text[..start].trim_end().len();
        let next = self.edits.partition_point(|at| *at < blanks);
        if self.edits.get(next).is_some_and(|at| *at <= end) {
            return;
        }
        if self.diagnostics.is_full() {
            return self.diagnostics.leave_out();
        }
        self.diagnostics.push(explain(self.file, start, &self.text[start..end]));
    }

    fn param(&mut self, pair: Pair<'_, Rule>) -> ParamItem {
        let span = self.span(&pair);
        let mut docs = String::new();
        let mut name = Ident { text: String::new(), span };
        let mut ty = TypeExpr { kind: TypeKind::Tuple(vec![]), span };
        let (mut unit, mut default, mut range) = (None, None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut docs, &part),
                Rule::ident => name = self.ident(&part),
                Rule::ty => ty = self.ty(part),
                Rule::unit_tag => unit = part.into_inner().next().map(|p| self.ident(&p)),
                Rule::default => default = part.into_inner().next().map(|p| self.expr(p)),
                Rule::limits => range = self.range(part),
                _ => {}
            }
        }
        ParamItem { docs, name, ty, unit, default, range }
    }

    fn range(&mut self, pair: Pair<'_, Rule>) -> Option<RangeExpr> {
        let mut ends = vec![];
        let mut inclusive = false;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::expr => ends.push(self.expr(part)),
                Rule::range_op => inclusive = part.as_str() == "..=",
                _ => {}
            }
        }
        let high = ends.pop()?;
        let low = ends.pop()?;
        Some(RangeExpr { low, high, inclusive })
    }

    fn statement(&mut self, pair: Pair<'_, Rule>, graph: &mut GraphItem) {
        match pair.as_rule() {
            Rule::port_stmt => graph.ports.extend(self.port(pair)),
            Rule::node_stmt => graph.nodes.extend(self.node(pair)),
            Rule::claim_stmt => {
                let mut parts = pair.into_inner();
                let word = parts.next().map(|p| self.span(&p));
                if let (Some(word), Some(kind)) = (word, parts.next().map(|p| self.ident(&p))) {
                    let (mut of, mut span) = (vec![], word.to(kind.span));
                    for part in parts {
                        match part.as_rule() {
                            Rule::port_ref => of.push(self.port_ref(part)),
                            Rule::rparen => span = span.to(self.span(&part)),
                            _ => {}
                        }
                    }
                    graph.claims.push(Claim { kind, of, span });
                }
            }
            Rule::thread_stmt => graph.threads.extend(self.thread(pair)),
            Rule::record_stmt => graph.records.extend(self.record(pair)),
            Rule::chain_stmt => {
                let mut chain = Chain { ends: vec![], arrows: vec![] };
                for part in pair.into_inner() {
                    match part.as_rule() {
                        Rule::endpoint => chain.ends.extend(self.endpoint(part)),
                        Rule::arrow => {
                            let active = part.as_str().starts_with('=');
                            chain.arrows.push(Arrow { active, span: self.span(&part) });
                        }
                        _ => {}
                    }
                }
                graph.chains.push(chain);
            }
            _ => {
                self.bad(syntax_errors::statement, &pair);
            }
        }
    }

    fn thread(&mut self, pair: Pair<'_, Rule>) -> Option<ThreadItem> {
        let (mut name, mut settings) = (None, vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::ident => name = Some(self.ident(&part)),
                Rule::setting => {
                    let mut parts = part.into_inner();
                    let name = parts.next().map(|p| self.ident(&p));
                    let value = parts.find(|p| p.as_rule() == Rule::expr).map(|p| self.expr(p));
                    settings.extend(name.zip(value));
                }
                _ => {}
            }
        }
        Some(ThreadItem { name: name?, settings })
    }

    fn record(&mut self, pair: Pair<'_, Rule>) -> Option<RecordItem> {
        let mut parts = pair.into_inner();
        let (word, file) = (parts.next()?, parts.next()?);
        let span = self.span(&word).to(self.span(&file));
        let (mut options, mut ports) = (vec![], vec![]);
        for part in parts {
            match part.as_rule() {
                Rule::args => {
                    let args = part.into_inner().filter(|p| p.as_rule() == Rule::arg);
                    options.extend(args.filter_map(|arg| self.arg(arg)));
                }
                Rule::recorded => ports.extend(part.into_inner().next().map(|port| self.port_ref(port))),
                _ => {}
            }
        }
        Some(RecordItem { file: unescape(file.as_str()), options, ports, span })
    }

    /// A type with the unit behind it.
    fn measured(&self, ty: Option<TypeExpr>, tag: Pair<'_, Rule>) -> Option<TypeExpr> {
        let (ty, span) = (ty?, self.span(&tag));
        let unit = self.ident(&tag.into_inner().next()?);
        Some(TypeExpr { span: ty.span.to(span), kind: TypeKind::Measured(Box::new(ty), unit) })
    }

    fn port(&self, pair: Pair<'_, Rule>) -> Option<PortItem> {
        let mut docs = String::new();
        let (mut kind, mut name, mut ty, mut frame) = (PortKind::Input, None, None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut docs, &part),
                Rule::port_kind => {
                    kind = match part.as_str() {
                        "in" => PortKind::Input,
                        "out" => PortKind::Output,
                        "slot" => PortKind::Slot,
                        _ => PortKind::Event,
                    }
                }
                Rule::ident => name = Some(self.ident(&part)),
                Rule::ty => ty = Some(self.ty(part)),
                Rule::unit_tag => ty = self.measured(ty, part),
                Rule::frame => frame = part.into_inner().last().map(|name| self.frame(&name)),
                _ => {}
            }
        }
        Some(PortItem { docs, kind, name: name?, ty, frame })
    }

    /// The name of a frame, with or without quotes.
    fn frame(&self, pair: &Pair<'_, Rule>) -> Ident {
        match pair.as_rule() {
            Rule::string => Ident { text: unescape(pair.as_str()), span: self.span(pair) },
            _ => self.ident(pair),
        }
    }

    fn node(&mut self, pair: Pair<'_, Rule>) -> Option<NodeItem> {
        let mut docs = String::new();
        let (mut name, mut body) = (None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::doc => push_doc(&mut docs, &part),
                Rule::ident => name = Some(self.ident(&part)),
                Rule::instance => body = Some(NodeBody::Instance(self.instance(part))),
                Rule::handed_in => {
                    let mut parts = part.into_inner();
                    let ty = self.ty(parts.next()?);
                    body = Some(NodeBody::HandedIn(ty, parts.filter_map(|p| self.modifier(p)).collect()));
                }
                _ => {}
            }
        }
        Some(NodeItem { docs, name: name?, body: body? })
    }

    fn endpoint(&mut self, pair: Pair<'_, Rule>) -> Option<Endpoint> {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let inner = parts.next()?;
        Some(match inner.as_rule() {
            Rule::list => Endpoint::List(inner.into_inner().filter_map(|p| self.endpoint(p)).collect(), span),
            Rule::instance => Endpoint::Instance(Box::new(self.instance(inner))),
            Rule::all_ports => Endpoint::All(AllPorts { of: self.ports_of(inner.into_inner().next()?), span }),
            _ => {
                let port = self.port_ref(inner);
                let value = parts.next().and_then(|given| given.into_inner().find(|p| p.as_rule() == Rule::expr));
                Endpoint::Port(port, value.map(|value| Box::new(self.expr(value))))
            }
        })
    }

    fn ports_of(&self, pair: Pair<'_, Rule>) -> PortsOf {
        match (pair.as_rule(), pair.as_str()) {
            (Rule::own_side, "in") => PortsOf::In,
            (Rule::own_side, _) => PortsOf::Out,
            _ => PortsOf::Node(self.ident(&pair)),
        }
    }

    fn port_ref(&self, pair: Pair<'_, Rule>) -> PortRef {
        let span = self.span(&pair);
        PortRef { parts: pair.into_inner().map(|p| self.ident(&p)).collect(), span }
    }

    fn instance(&mut self, pair: Pair<'_, Rule>) -> Instance {
        let span = self.span(&pair);
        let mut path = PathExpr { segments: vec![], span };
        let (mut types, mut args, mut modifiers) = (vec![], vec![], vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::path => path = self.path(part),
                Rule::type_args => types = self.type_args(part),
                Rule::args => {
                    args = part.into_inner().filter(|p| p.as_rule() == Rule::arg).filter_map(|p| self.arg(p)).collect()
                }
                Rule::modifier => modifiers.extend(self.modifier(part)),
                _ => {}
            }
        }
        Instance { path, types, args, modifiers, span }
    }

    fn arg(&mut self, pair: Pair<'_, Rule>) -> Option<Arg> {
        let (mut name, mut value) = (None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = Some(self.ident(&part)),
                Rule::expr => value = Some(self.expr(part)),
                _ => {}
            }
        }
        Some(Arg { name, value: value? })
    }

    fn modifier(&mut self, pair: Pair<'_, Rule>) -> Option<Modifier> {
        let span = self.span(&pair);
        let inner = pair.into_inner().next()?;
        let rule = inner.as_rule();
        let mut parts = inner.into_inner().filter(|p| {
            !matches!(
                p.as_rule(),
                Rule::every_kw
                    | Rule::after_kw
                    | Rule::timeout_kw
                    | Rule::deadline_kw
                    | Rule::on_kw
                    | Rule::each_kw
                    | Rule::delay_kw
            )
        });
        let kind = match rule {
            Rule::every => ModifierKind::Every(self.expr(parts.next()?)),
            Rule::after => ModifierKind::After(self.expr(parts.next()?)),
            Rule::timeout => ModifierKind::Timeout(self.expr(parts.next()?)),
            Rule::deadline => ModifierKind::Deadline(self.expr(parts.next()?)),
            Rule::on => ModifierKind::On(self.ident(&parts.next()?)),
            Rule::delay => ModifierKind::Delay(parts.next().map(|p| self.expr(p))),
            Rule::pipelined => ModifierKind::Pipelined,
            Rule::skip => ModifierKind::Skip,
            Rule::essential => ModifierKind::Essential,
            Rule::restart => ModifierKind::Restart,
            _ => {
                let (mut parallel, mut port) = (false, None);
                for part in parts {
                    match part.as_rule() {
                        Rule::par_kw => parallel = true,
                        _ => port = Some(self.ident(&part)),
                    }
                }
                ModifierKind::Each { parallel, port }
            }
        };
        Some(Modifier { kind, span })
    }

    fn type_args(&self, pair: Pair<'_, Rule>) -> Vec<TypeExpr> {
        let mut types = vec![];
        for arg in pair.into_inner() {
            let span = self.span(&arg);
            let Some(inner) = arg.into_inner().next() else { continue };
            types.push(match inner.as_rule() {
                Rule::ty => self.ty(inner),
                _ => TypeExpr { kind: TypeKind::Const(inner.as_str().to_owned()), span },
            });
        }
        types
    }

    fn ty(&self, pair: Pair<'_, Rule>) -> TypeExpr {
        let span = self.span(&pair);
        let mut kind = TypeKind::Tuple(vec![]);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::path => kind = TypeKind::Path(self.path(part), vec![]),
                Rule::type_args => {
                    if let TypeKind::Path(_, args) = &mut kind {
                        *args = self.type_args(part);
                    }
                }
                Rule::array_ty => {
                    let mut parts = part.into_inner();
                    if let Some(element) = parts.next().map(|p| self.ty(p)) {
                        kind = TypeKind::Array(Box::new(element), parts.next().map(|n| n.as_str().to_owned()));
                    }
                }
                _ => kind = TypeKind::Tuple(part.into_inner().map(|p| self.ty(p)).collect()),
            }
        }
        TypeExpr { kind, span }
    }
}

fn push_doc(docs: &mut String, pair: &Pair<'_, Rule>) {
    if !docs.is_empty() {
        docs.push('\n');
    }
    // Indentation matters in Markdown, except for the first blank of each line.
    let line = &pair.as_str()[3..];
    docs.push_str(line.strip_prefix(' ').unwrap_or(line).trim_end());
}

/// The span of a pair in `file`, up to the byte `end`.
fn span_of(file: FileId, pair: &Pair<'_, Rule>, end: usize) -> Span {
    let span = pair.as_span();
    let trimmed = span.as_str().trim_end().len();
    Span::new(file, span.start().min(end), (span.start() + trimmed).min(end))
}
