//! Compares a recorded run with the Petri net of its graph.

use super::script;
use apex_dsl::{
    catalog::{Catalog, Signature},
    checked::CheckedProgram,
    claims::MAX_STATES,
    graph::{ConnectionId, Graph, Library, NodeId, NodeKind, PortId, Value},
    machine::Machines,
    passes,
    report::{Diagnostics, Severity},
    source::Sources,
    syntax::tree::PortKind,
};
use apex_host::{Disk, Seen, Workspace};
use apex_petri::{Call, Net, Origin, Replay};
use std::{
    cell::{Ref, RefCell},
    collections::{BTreeMap, BTreeSet},
    path::Path,
    time::Duration,
};

/// The parts of the compiler that nets need.
pub struct Checker {
    catalog: RefCell<Catalog>,
}

/// A checked graph with its net.
pub struct Checked {
    /// The program.
    pub program: CheckedProgram,
    /// The state machines in its source file.
    pub machines: Machines,
    /// Net of its graph.
    pub net: Net,
}

/// One entry of a recorded run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Record {
    /// `R`: a reaction begins at this time in ns.
    Begin(u64),
    /// `F`: a node fires.
    Fired(NodeId),
    /// `H`: a slot takes the token on a connection.
    Handled(ConnectionId),
    /// `A`: a node becomes active (`true`) or inactive (`false`).
    Activity(NodeId, bool),
    /// `T`: tokens of the previous call; `None` is ⊥.
    Took(Vec<Option<i64>>),
    /// `E`: the reaction ends.
    End,
}

/// Failure of a run: the number of the record, counted from 0, and the reason.
pub type Failure = (usize, String);

impl Record {
    /// Description of the record; `name` returns the names of nodes.
    pub fn named(&self, name: &dyn Fn(NodeId) -> String, checked: &Checked) -> String {
        match self {
            Self::Begin(now) => format!("reaction at {now} ns"),
            Self::Fired(node) => format!("fired {}", name(*node)),
            Self::Handled(connection) => {
                let c = &checked.program.graph.connections[*connection];
                format!(
                    "handled {} -> {}",
                    checked.program.graph.end_name(c.from),
                    checked.program.graph.end_name(c.to)
                )
            }
            Self::Activity(node, active) => format!("{} {}active", name(*node), if *active { "" } else { "in" }),
            Self::Took(tokens) => format!("  took {tokens:?}"),
            Self::End => "reaction ends".to_owned(),
        }
    }
}

impl Checker {
    /// Checker with the nodes of this package.
    #[allow(clippy::new_without_default)]
    pub fn new() -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let workspace = Workspace::load(folder).expect("this package has a workspace");
        let mut disk = Disk::new(Some(&workspace.cache_folder()));
        let catalog = Catalog::load(workspace.crates(&Seen::Crate("oracle", false)), &mut disk);
        disk.save();
        Self { catalog: RefCell::new(catalog) }
    }

    /// The last program of `text` with its net, or the errors of the text. Nested graphs are written before it.
    ///
    /// # Errors
    /// Returns the errors of the text.
    pub fn check(&self, text: &str) -> Result<Checked, String> {
        self.check_within(text, MAX_STATES)
    }

    /// The same with claims that are decided by at most `states` states.
    ///
    /// # Errors
    /// Returns the errors of the text.
    pub fn check_within(&self, text: &str, states: usize) -> Result<Checked, String> {
        let mut sources = Sources::default();
        let root = sources.add(Path::new(env!("CARGO_MANIFEST_DIR")).join("text.afg"), text);
        let mut diagnostics = Diagnostics::default();
        let mut disk = Disk::new(None);
        let mut catalog = self.catalog.borrow_mut();
        let checked = passes::check_all(root, &mut catalog, &mut sources, &mut disk, states, &mut diagnostics);
        drop(catalog);
        let errors: Vec<String> = diagnostics
            .sorted()
            .into_iter()
            .filter(|d| d.severity == Severity::Error)
            .map(|d| format!("{}: {}", d.code, d.message))
            .collect();
        if !errors.is_empty() {
            return Err(errors.join("\n"));
        }
        let program = checked.programs.into_iter().next_back().ok_or("there is no program")?;
        let net = apex_petri::net(&program.graph, &self.catalog.borrow()).map_err(|e| e.to_string())?;
        Ok(Checked { program, machines: checked.texts.machines, net })
    }

    /// The node types.
    pub fn catalog(&self) -> Ref<'_, Catalog> {
        self.catalog.borrow()
    }

    /// Replays a run on the net.
    pub fn judge(&self, checked: &Checked, records: &[Record]) -> Result<(), Failure> {
        judge(&self.catalog.borrow(), checked, records)
    }
}

/// Reads a run with one record per line.
pub fn read(text: &str) -> Vec<Record> {
    text.lines().filter_map(record).collect()
}

fn record(line: &str) -> Option<Record> {
    let mut words = line.split_whitespace();
    let kind = words.next()?;
    let numbers: Vec<Option<i64>> = words.map(|w| w.parse().ok()).collect();
    let first = numbers.first().copied().flatten().unwrap_or_default();
    Some(match kind {
        "R" => Record::Begin(first as u64),
        "F" => Record::Fired(NodeId::from(first as usize)),
        "H" => Record::Handled(ConnectionId::from(first as usize)),
        "A" => Record::Activity(NodeId::from(first as usize), numbers.get(1) == Some(&Some(1))),
        "T" => Record::Took(numbers),
        "E" => Record::End,
        _ => return None,
    })
}

/// Identifiers and parameters of the scripted nodes of a graph.
pub fn script_of(graph: &Graph, catalog: &Catalog) -> BTreeMap<NodeId, (i64, script::Parameters)> {
    let scripts = graph.nodes.iter_enumerated().filter_map(|(node, n)| {
        let NodeKind::Library(library) = &n.kind else { return None };
        Some((node, script(&catalog.signatures[library.signature], library)?))
    });
    scripts.collect()
}

/// Identifier and parameters of a scripted node.
pub fn script(signature: &Signature, library: &Library) -> Option<(i64, script::Parameters)> {
    let value = |name: &str| signature.params.iter().position(|p| p.name == name).and_then(|i| library.params.get(i));
    let (Some(id), Some(Value::List(list))) = (value("id").and_then(integer), value("script")) else { return None };
    let list: Vec<i64> = list.iter().filter_map(integer).collect();
    Some((id, list.try_into().ok()?))
}

/// The number that a constant is.
pub fn integer(value: &Value) -> Option<i64> {
    match value {
        Value::Number(number) => number.integer().and_then(|i| i64::try_from(i).ok()).or(Some(number.value as i64)),
        _ => None,
    }
}

/// Maximum number of choices that are tried.
const MAX_CHOICES: usize = 500;

/// Nodes that act late from this record on.
type Late = (BTreeSet<NodeId>, usize);

/// Replays a run on the net. Unrecorded transitions may occur early or late.
pub fn judge(catalog: &Catalog, checked: &Checked, records: &[Record]) -> Result<(), Failure> {
    let replay = |late: Late| replay(catalog, checked, records, late);
    let Err((step, early)) = replay(Late::default()) else { return Ok(()) };
    let undecided = apex_petri::undecided(&checked.program.graph, &checked.net);
    let Err((other, late)) = replay((undecided.clone(), 0)) else { return Ok(()) };
    let steps = records.iter().filter(|record| !matches!(record, Record::Took(_)));
    let reactions = steps.zip(1..).filter(|(record, _)| matches!(record, Record::Begin(_)));
    match choices(&undecided, reactions.map(|(_, step)| step)).take(MAX_CHOICES).any(|late| replay(late).is_ok()) {
        true => Ok(()),
        false => Err((step, format!("{early}\n  (if ⊥ comes late: step {other}: {late})"))),
    }
}

/// Choices of nodes that act late: all but one, one, or all from one of the reactions on, one, and then any.
fn choices(undecided: &BTreeSet<NodeId>, reactions: impl Iterator<Item = usize>) -> impl Iterator<Item = Late> {
    let nodes: Vec<NodeId> = undecided.iter().copied().take(u64::BITS as usize - 1).collect();
    let all = (1_u64 << nodes.len()) - 1;
    let ones: Vec<u64> = (0..nodes.len()).map(|i| 1 << i).collect();
    let others: Vec<u64> = ones.iter().map(|one| all & !one).collect();
    let later: Vec<(u64, usize)> = reactions
        .flat_map(|from| ones.iter().chain([&all]).map(move |mask| (*mask, from)).collect::<Vec<_>>())
        .collect();
    let masks = others.into_iter().chain(ones).map(|mask| (mask, 0)).chain(later).chain((1..all).map(|mask| (mask, 0)));
    masks.map(move |(mask, from)| {
        let late = nodes.iter().enumerate().filter(|(i, _)| mask & 1 << i != 0);
        (late.map(|(_, node)| *node).collect(), from)
    })
}

fn replay(catalog: &Catalog, checked: &Checked, records: &[Record], (late, from): Late) -> Result<(), Failure> {
    let Checked { program: CheckedProgram { graph, .. }, net, .. } = checked;
    let scripts = script_of(graph, catalog);
    let by_id: BTreeMap<i64, NodeId> = scripts.iter().map(|(node, (id, _))| (*id, *node)).collect();
    let sends = |call: Call, port: usize| match scripts.get(&call.node) {
        Some((id, parameters)) => {
            script::sends(*id, *parameters, &graph.nodes[call.node].ports[port].name, call.nth as i64)
        }
        None => true,
    };
    let is_connected = |node: NodeId, port: usize| graph.incoming(PortId { node, port }).is_some();
    // For each input of the node that fired last whether it is connected.
    let mut inputs: Vec<bool> = vec![];
    let replay = Replay::new(graph, catalog, net, &sends).map_err(|why| (0, why))?;
    let mut replay = replay.hesitating(late, from);
    for (step, record) in records.iter().enumerate() {
        let result = match record {
            Record::Begin(now) => {
                replay.begin(Duration::from_nanos(*now));
                Ok(())
            }
            // Nodes in the body of an `each` have larger indices than all others.
            Record::Fired(node) if node.index() >= graph.nodes.len() => Ok(()),
            Record::Fired(node) => {
                let ports = graph.nodes[*node].ports.iter().enumerate();
                let own = ports.filter(|(_, p)| p.kind == PortKind::Input && p.parameter.is_none());
                inputs = own.map(|(port, _)| is_connected(*node, port)).collect();
                replay.fired(*node)
            }
            Record::Handled(connection) => {
                inputs.clear();
                replay.handled(*connection)
            }
            Record::Activity(node, active) => replay.activity(*node, *active),
            Record::Took(tokens) => {
                let found: Vec<Option<Origin>> =
                    tokens.iter().map(|t| t.map(|value| origin(graph, &by_id, value))).collect();
                let is_open = |i: usize| found.len() == inputs.len() && !inputs[i];
                let found: Vec<Option<Origin>> =
                    found.iter().enumerate().filter(|(i, f)| f.is_some() || !is_open(*i)).map(|(_, f)| *f).collect();
                replay.took(&found)
            }
            Record::End => replay.end(),
        };
        result.map_err(|wrong| (step, wrong.to_string()))?;
    }
    Ok(())
}

/// Origin of a value. One that no scripted node made is one of the text.
fn origin(graph: &Graph, by_id: &BTreeMap<i64, NodeId>, value: i64) -> Origin {
    let nowhere = Origin::given(graph);
    let Some((id, port, call)) = script::origin(value) else { return nowhere };
    let Some(node) = by_id.get(&id).copied() else { return nowhere };
    let Some(port) = graph.nodes[node].ports.iter().position(|p| p.name == port && p.kind.sends()) else {
        return nowhere;
    };
    Origin { end: PortId { node, port }, call }
}
