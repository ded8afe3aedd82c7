//! Contents of a graph file.

use super::{
    known,
    known::MESSAGE,
    names::{self, Taken},
    ports::{Kind, Port, PortId},
    wrong::Wrong,
    yaml::{Value, Yaml},
};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum depth of nested graphs, as in the language.
const MAX_DEPTH: usize = 64;

/// A graph; graphs nested in it are nodes with a graph.
#[derive(Debug)]
pub struct Graph {
    /// Name in the source file.
    pub name: String,
    pub nodes: Vec<Node>,
    pub connections: Vec<Connection>,
    /// Own ports that have a connection inside or outside.
    pub ports: BTreeSet<(Kind, u32)>,
}

#[derive(Debug)]
pub struct Node {
    /// Name in the source file.
    pub name: String,
    /// Type as spelled in the graph file.
    pub ty: String,
    /// Parameters that have a value, by their names in the source file.
    pub params: Vec<(String, Param)>,
    /// Names of these parameters.
    pub param_names: BTreeSet<String>,
    /// Thread group.
    pub group: Option<String>,
    pub enabled: bool,
    pub graph: Option<Graph>,
}

#[derive(Debug)]
pub struct Connection {
    pub from: PortId,
    pub to: PortId,
    pub active: bool,
}

impl Connection {
    /// `true` if a `Signal` goes between the ends: in CS::APEX any token is a signal, but here `enable` and similar
    /// slots take `()`.
    pub fn needs_signal(&self) -> bool {
        !self.from.sends_signals() && self.to.takes_signals()
    }
}

/// Value of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub enum Param {
    Int(i64),
    Float(f64),
    Bool(bool),
    Text(String),
    List(Vec<Param>),
    /// No value that could be written: a button, a colour wheel.
    None,
}

/// Data common to all graphs of a file.
struct File {
    graph_names: Taken,
    /// Thread groups by node; the key contains the ids of the node and of all graphs around it.
    groups: BTreeMap<String, String>,
}

/// Reads a graph (`.apex`), or a snippet that contains a graph (`.apexs`).
pub fn read(yaml: &Yaml, file_name: &str) -> Result<Graph, Wrong> {
    let snippet = yaml.get("yaml").filter(|_| yaml.get("nodes").is_none());
    let name = yaml.get("name").filter(|_| snippet.is_some());
    let name = name.and_then(|n| n.scalar("").ok()).filter(|n| !n.is_empty()).unwrap_or(file_name);
    let yaml = snippet.unwrap_or(yaml);
    let mut file = File { graph_names: Taken::default(), groups: groups(yaml)? };
    file.graph_names.reserve(MESSAGE.to_owned());
    take_types(yaml, &mut file.graph_names);
    file.graph(yaml, name, "", 0)
}

/// Reserves the names of all node types, which graphs cannot have.
fn take_types(yaml: &Yaml, taken: &mut Taken) {
    for node in yaml.get("nodes").and_then(|nodes| nodes.list("").ok()).into_iter().flatten() {
        let ty = node.get("type").and_then(|ty| ty.scalar("").ok()).unwrap_or_default();
        taken.reserve(known::find(ty).map_or_else(|| names::camel(ty), |known| known.ours.1.to_owned()));
        node.get("subgraph").into_iter().for_each(|graph| take_types(graph, taken));
    }
}

/// Reads the named thread groups; other assignments are ignored.
fn groups(yaml: &Yaml) -> Result<BTreeMap<String, String>, Wrong> {
    let mut groups = BTreeMap::new();
    let Some(threads) = yaml.get("threads") else { return Ok(groups) };
    let list = |key| threads.get(key).map_or(Ok(&[][..]), |list| list.list(&format!("`{key}`")));
    let mut names = BTreeMap::new();
    for group in list("groups")? {
        let id = group.need("id", "a thread group")?.scalar("`id`")?;
        names.insert(id, group.need("name", "a thread group")?.scalar("`name`")?);
    }
    for assignment in list("assignments")? {
        let uuid = assignment.need("uuid", "an assignment")?.scalar("`uuid`")?;
        let id = assignment.need("id", "an assignment")?.scalar("`id`")?;
        if let Some(name) = names.get(id) {
            groups.insert(uuid.to_owned(), names::snake(name));
        }
    }
    Ok(groups)
}

impl File {
    fn graph(&mut self, yaml: &Yaml, name: &str, path: &str, depth: usize) -> Result<Graph, Wrong> {
        if depth > MAX_DEPTH {
            return Err(Wrong::new(yaml.line, format!("graphs are nested more than {MAX_DEPTH} levels deep")));
        }
        let name = self.graph_names.unique(names::camel(name));
        let mut graph = Graph { name, nodes: vec![], connections: vec![], ports: BTreeSet::new() };
        let mut places: BTreeMap<&str, (usize, usize)> = BTreeMap::new();
        let mut taken = Taken::default();
        for node in yaml.need("nodes", "a graph")?.list("`nodes`")? {
            let uuid = node.need("uuid", "a node")?;
            let id = uuid.scalar("`uuid`")?;
            if let Some((_, line)) = places.insert(id, (graph.nodes.len(), uuid.line)) {
                let message = format!("the node `{id}` occurs twice, first in line {line}");
                return Err(Wrong::new(uuid.line, message));
            }
            graph.nodes.push(self.node(node, id, path, depth, &mut taken)?);
        }
        for connection in yaml.get("connections").map_or(Ok(&[][..]), |c| c.list("`connections`"))? {
            graph.connect(connection, |id| places.get(id).map(|(index, _)| *index))?;
        }
        Ok(graph)
    }

    fn node(&mut self, yaml: &Yaml, id: &str, path: &str, depth: usize, taken: &mut Taken) -> Result<Node, Wrong> {
        let ty = yaml.need("type", "a node")?.scalar("`type`")?;
        // A default label is the id of the node, or that of the node from which it was copied.
        let label = yaml.get("label").and_then(|label| label.scalar("").ok());
        let label = label.filter(|label| !label.is_empty() && !label.starts_with(ty)).unwrap_or(id);
        let path = if path.is_empty() { id.to_owned() } else { format!("{path}:|:{id}") };
        let graph = yaml.get("subgraph").map(|graph| self.graph(graph, label, &path, depth + 1)).transpose()?;
        let params = yaml.get("state").and_then(|state| state.get("params"));
        // The parameters of a graph only describe its ports.
        let params = params.filter(|_| graph.is_none()).map_or(Ok(vec![]), read_params)?;
        Ok(Node {
            name: taken.unique(names::snake(label)),
            ty: ty.to_owned(),
            param_names: params.iter().map(|(name, _)| name.clone()).collect(),
            params,
            group: self.groups.get(&path).cloned(),
            enabled: yaml.get("enabled").is_none_or(|e| e.value != Value::Scalar("false".to_owned())),
            graph,
        })
    }
}

impl Graph {
    /// Reads the connections of one source.
    fn connect(&mut self, yaml: &Yaml, node: impl Fn(&str) -> Option<usize>) -> Result<(), Wrong> {
        let from = yaml.need("uuid", "a connection")?;
        let source = PortId::read(from.scalar("`uuid`")?, from.line, &node)?;
        if !source.is_source() {
            return Err(Wrong::new(from.line, format!("`{}` sends nothing", from.scalar("")?)));
        }
        let targets = yaml.need("targets", "a connection")?.list("`targets`")?;
        let types = yaml.get("types").map_or(Ok(&[][..]), |types| types.list("`types`"))?;
        if !types.is_empty() && types.len() != targets.len() {
            let message = format!("there are {} `targets`, but {} `types`", targets.len(), types.len());
            return Err(Wrong::new(yaml.line, message));
        }
        for (index, target) in targets.iter().enumerate() {
            let to = PortId::read(target.scalar("a target")?, target.line, &node)?;
            if to.is_source() {
                return Err(Wrong::new(target.line, format!("`{}` takes nothing", target.scalar("")?)));
            }
            let active = match types.get(index).map(|ty| (ty.scalar("a type"), ty.line)) {
                None | Some((Ok("default"), _)) => false,
                Some((Ok("active"), _)) => true,
                Some((Ok(other), line)) => {
                    return Err(Wrong::new(line, format!("the type `{other}` is neither `default` nor `active`")));
                }
                Some((Err(wrong), _)) => return Err(wrong),
            };
            self.note_ports(&source);
            self.note_ports(&to);
            self.connections.push(Connection { from: source.clone(), to, active });
        }
        Ok(())
    }

    /// A port of a graph is there because something is connected to it.
    fn note_ports(&mut self, end: &PortId) {
        match end {
            PortId::Own(kind, k) => drop(self.ports.insert((*kind, *k))),
            PortId::Whole(_) | PortId::Plugin(..) => {}
            PortId::Node(index, port) => {
                let graph = self.nodes[*index].graph.as_mut();
                graph.and_then(|graph| port.of_graph().map(|port| graph.ports.insert(port)));
            }
        }
    }

    /// Connected ports of each node.
    pub fn connected(&self) -> Vec<BTreeSet<&Port>> {
        let mut connected = vec![BTreeSet::new(); self.nodes.len()];
        for end in self.connections.iter().flat_map(|c| [&c.from, &c.to]) {
            if let PortId::Node(node, port) = end {
                connected[*node].insert(port);
            }
        }
        connected
    }
}

/// Reads the parameters that have a value, by their names in the source file.
fn read_params(yaml: &Yaml) -> Result<Vec<(String, Param)>, Wrong> {
    let (mut taken, mut params) = (Taken::default(), vec![]);
    for (name, entry) in yaml.map("`params`")? {
        let param = read_param(entry)?;
        let is_empty = matches!(&param, Param::List(items) if items.is_empty());
        if param != Param::None && !is_empty {
            params.push((taken.unique(names::snake(name)), param));
        }
    }
    Ok(params)
}

/// Type of the value under a key.
#[derive(Clone, Copy)]
enum Form {
    Int,
    Float,
    Bool,
    Text,
}

/// Keys under which a parameter can have its value, in order of precedence.
const FORMS: [(&str, Form); 8] = [
    ("txt", Form::Text),
    ("string", Form::Text),
    ("value", Form::Text),
    ("double", Form::Float),
    ("int", Form::Int),
    ("bool", Form::Bool),
    ("list", Form::Text),
    ("values", Form::Int),
];

/// Reads the value of a parameter, or the two ends of an interval. Its key depends on the type.
fn read_param(yaml: &Yaml) -> Result<Param, Wrong> {
    let Some((value, form)) = FORMS.iter().find_map(|(key, form)| Some((yaml.get(key)?, *form))) else {
        return Ok(Param::None);
    };
    let is_angle = yaml.get("type").is_some_and(|ty| ty.scalar("").is_ok_and(|ty| ty == "angle"));
    let form = if is_angle { Form::Float } else { form };
    match &value.value {
        Value::Scalar(_) => form.read(value),
        Value::List(items) => {
            let items: Vec<Param> = items.iter().map(|item| form.read(item)).collect::<Result<_, _>>()?;
            // A list with a value that cannot be written has no value itself.
            Ok(if items.contains(&Param::None) { Param::None } else { Param::List(items) })
        }
        Value::Map(_) => Ok(Param::None),
    }
}

impl Form {
    /// Reads one value. A structured value has no form that could be written.
    fn read(self, yaml: &Yaml) -> Result<Param, Wrong> {
        let Value::Scalar(text) = &yaml.value else { return Ok(Param::None) };
        let (param, what) = match self {
            Self::Text => (Some(Param::Text(text.clone())), "a text"),
            Self::Int => (text.parse().ok().map(Param::Int), "a whole number"),
            Self::Bool => (text.parse().ok().map(Param::Bool), "`true` or `false`"),
            Self::Float => (read_float(text), "a number"),
        };
        param.ok_or_else(|| Wrong::new(yaml.line, format!("this is not {what}")))
    }
}

/// A number as YAML writes it; an infinite number or NaN cannot be written.
fn read_float(text: &str) -> Option<Param> {
    let bare = text.trim_start_matches(['+', '-']).to_ascii_lowercase();
    if [".inf", ".nan", "inf", "nan"].contains(&&*bare) {
        return Some(Param::None);
    }
    text.parse().ok().map(|x: f64| if x.is_finite() { Param::Float(x) } else { Param::None })
}
