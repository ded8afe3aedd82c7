//! Node signatures, read from the Rust sources of the node crates. rustc has the last word on types: the
//! catalog calls a mismatch only where it has seen both definitions.

mod items;
pub mod signature;
mod tree;
mod ty;
mod types;

use crate::{machine::Machine, source::World};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::PathBuf,
};

pub use items::{Default as DefaultValue, Item, Literal, read as read_items};
pub use tree::{DefId, ModuleId, Need};
pub use ty::Ty;
pub use types::{Match, Type};

use items::{ArgKind, ItemKind, NodeItem, NodeMethods};
use tree::{Def, Tree};

/// A crate to scan.
#[derive(Debug, Clone)]
pub struct CrateSpec {
    /// The name under which code refers to it.
    pub name: String,
    /// Its root file.
    pub root: PathBuf,
    /// Enabled features.
    pub features: BTreeSet<String>,
    /// Names of its dependencies that are not scanned.
    pub externs: BTreeSet<String>,
    /// Its dependencies among the scanned crates: name in its code → index.
    pub dependencies: BTreeMap<String, usize>,
}

/// Which crates there are, and from where the graph is seen.
#[derive(Debug, Clone, Default)]
pub struct Crates {
    /// Files below this folder are named by their path in it.
    pub root: PathBuf,
    /// All crates to scan.
    pub all: Vec<CrateSpec>,
    /// The crate that the generated code becomes part of.
    pub here: usize,
    /// The crates that `crate::` in a text may mean: the package's own, `here` first.
    pub own: Vec<usize>,
}

/// A node signature.
pub type SignatureId = usize;

/// A node type: what `#[node]` declares.
#[derive(Debug, Clone, Default)]
pub struct Signature {
    /// Its name.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Where it is declared.
    pub file: PathBuf,
    /// Line of its name, from 1.
    pub line: usize,
    /// Path by which generated code reaches it.
    pub path: Vec<String>,
    /// Whether it is a function (else a struct).
    pub is_function: bool,
    /// Names of type parameters and constants.
    pub generics: Vec<String>,
    /// Whether firings depend on earlier ones.
    pub stateful: bool,
    /// Parameters.
    pub params: Vec<ParamSig>,
    /// Ports: inputs, outputs, slots, events, in the order of the signature.
    pub ports: Vec<PortSig>,
    /// Arguments of `process`; `None` if it has none.
    pub process: Option<Vec<ArgSig>>,
    /// What `process` returns.
    pub returns: ReturnSig,
    /// The method that is called instead of `process` when a mandatory input holds ⊥.
    pub no_message: Option<String>,
    /// Its slots.
    pub slots: Vec<SlotSig>,
    /// The method that is called when the node becomes active.
    pub on_activate: Option<String>,
    /// The method that is called when the node is no longer active.
    pub on_deactivate: Option<String>,
    /// Whether its events take activity away instead of passing it on.
    pub deactivates: bool,
    /// What it cannot do without, and why.
    pub needs: Option<(Need, String)>,
}

/// A slot of a node type: a method.
#[derive(Debug, Clone)]
pub struct SlotSig {
    /// The port.
    pub port: usize,
    /// Its arguments: the port itself stands for the token.
    pub args: Vec<ArgSig>,
    /// `Result`: may fail.
    pub fallible: bool,
}

impl Signature {
    /// A state machine as a node: slots and events. If something happens when it starts, `begin` is a slot too.
    fn of_machine(machine: &Machine, (file, line): (PathBuf, usize)) -> Self {
        use crate::syntax::tree::PortKind;
        let port = |name: &str, kind, ty: &Type, index| PortSig {
            name: name.to_owned(),
            kind,
            ty: ty.clone(),
            rate: 1,
            optional: false,
            index,
            field: None,
            field_is_option: false,
            docs: String::new(),
        };
        let events = machine.events.iter().enumerate().map(|(i, (name, ty))| port(name, PortKind::Event, ty, i));
        let mut ports: Vec<PortSig> = events.collect();
        let mut slots = vec![];
        for (index, slot) in machine.slots.iter().enumerate() {
            ports.push(port(&slot.name, PortKind::Slot, &slot.ty, index));
            let token = slot.uses_token().then(|| ArgSig::Port(ports.len() - 1));
            let args = token.into_iter().chain(slot.events().into_iter().map(ArgSig::Port)).collect();
            slots.push(SlotSig { port: ports.len() - 1, args, fallible: false });
        }
        if !machine.begin.is_empty() {
            ports.push(port(Machine::BEGIN, PortKind::Slot, &Type::unit(), machine.slots.len()));
            let args = machine.begin.iter().map(|s| ArgSig::Port(s.event)).collect();
            slots.push(SlotSig { port: ports.len() - 1, args, fallible: false });
        }
        Self {
            name: machine.name.clone(),
            docs: machine.docs.clone(),
            file,
            line,
            path: vec![machine.name.clone()],
            stateful: true,
            ports,
            slots,
            ..Self::default()
        }
    }

    /// Whether the tokens of a firing at this port stand in an array.
    pub fn is_batched(&self, port: usize) -> bool {
        self.ports[port].rate > 1
    }
}

/// A parameter of a node type.
#[derive(Debug, Clone)]
pub struct ParamSig {
    /// Name.
    pub name: String,
    /// Documentation.
    pub docs: String,
    /// Type of the value.
    pub ty: Type,
    /// Unit of plain numbers.
    pub unit: Option<String>,
    /// The value where a text gives none.
    pub default: Option<DefaultValue>,
    /// Smallest and largest value, and whether the largest belongs to it.
    pub range: Option<(Option<f64>, Option<f64>, bool)>,
}

/// A port of a node type.
#[derive(Debug, Clone)]
pub struct PortSig {
    /// Name.
    pub name: String,
    /// Kind.
    pub kind: crate::syntax::tree::PortKind,
    /// Type of one token.
    pub ty: Type,
    /// Tokens per firing.
    pub rate: usize,
    /// Input: ⊥ reaches the node as `None`. Output: may be ⊥ although the node fired.
    pub optional: bool,
    /// The token type in generated code: `Input<index>`, `Output<index>`, `Slot<index>` or `Trigger<index>` of the
    /// node, and the field of a struct of outputs.
    pub index: usize,
    /// The field of a `#[derive(Outputs)]` struct.
    pub field: Option<(usize, String)>,
    /// Whether that field is an `Option`.
    pub field_is_option: bool,
    /// Documentation.
    pub docs: String,
}

/// An argument of `process`: the port, the context or the parameter that it stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArgSig {
    /// A port, by its number in [`Signature::ports`].
    Port(usize),
    /// `&Ctx`
    Ctx,
    /// A parameter, by number.
    Param(usize),
}

/// What `process` returns.
#[derive(Debug, Clone, Copy, Default)]
pub struct ReturnSig {
    /// Whether there is a value.
    pub value: bool,
    /// `Option`
    pub maybe: bool,
    /// `Result`
    pub fallible: bool,
    /// A struct of outputs.
    pub several: bool,
}

/// All node signatures and types that a graph can refer to.
#[derive(Debug, Default)]
pub struct Catalog {
    /// The node types.
    pub signatures: Vec<Signature>,
    tree: Tree,
    crates: Crates,
    /// The state machines of the texts that were checked last, by signature.
    pub machines: BTreeMap<SignatureId, Machine>,
    by_def: BTreeMap<DefId, SignatureId>,
    paths: BTreeMap<DefId, Vec<String>>,
}

impl Catalog {
    /// Scans `crates`.
    pub fn load(crates: Crates, world: &mut dyn World) -> Self {
        let tree = Tree::scan(&crates.all, world);
        let paths = if crates.all.is_empty() { BTreeMap::new() } else { tree.public_paths(crates.here) };
        let mut catalog = Self { tree, crates, paths, ..Self::default() };
        catalog.collect();
        catalog
    }

    /// The node types that are declared in Rust.
    pub fn rust_nodes(&self) -> &[Signature] {
        &self.signatures[..self.by_def.len()]
    }

    /// Forgets the machines of texts that were checked before.
    pub fn forget_machines(&mut self) {
        self.signatures.truncate(self.by_def.len());
        self.machines.clear();
    }

    /// Makes room for `count` machines and returns the number of the first.
    pub fn reserve_machines(&mut self, count: usize) -> SignatureId {
        let first = self.signatures.len();
        self.signatures.extend((0..count).map(|_| Signature::default()));
        first
    }

    /// Makes a state machine that is declared at `place` a node.
    pub fn add_machine(&mut self, id: SignatureId, machine: Machine, place: (PathBuf, usize)) {
        self.signatures[id] = Signature::of_machine(&machine, place);
        self.machines.insert(id, machine);
    }

    fn collect(&mut self) {
        let mut methods: BTreeMap<(ModuleId, &str), Vec<&NodeMethods>> = BTreeMap::new();
        for def in &self.tree.defs {
            if let ItemKind::Methods(m) = &def.kind {
                methods.entry((def.module, &m.node)).or_default().push(m);
            }
        }
        let mut found = vec![];
        for (id, def) in self.tree.defs.iter().enumerate() {
            match &def.kind {
                ItemKind::Function(node) => found.push((id, self.signature(id, node, &[]))),
                ItemKind::Struct(node) => {
                    let methods = methods.get(&(def.module, def.name.as_str())).map_or(&[][..], Vec::as_slice);
                    found.push((id, self.signature(id, node, methods)));
                }
                _ => {}
            }
        }
        for (def, signature) in found {
            self.by_def.insert(def, self.signatures.len());
            self.signatures.push(signature);
        }
    }

    fn signature(&self, id: DefId, node: &NodeItem, methods: &[&NodeMethods]) -> Signature {
        let def = &self.tree.defs[id];
        let is_function = matches!(def.kind, ItemKind::Function(_));
        let process = node.process.as_ref().or_else(|| methods.iter().find_map(|m| m.process.as_ref()));
        let mut builder = SignatureBuilder {
            catalog: self,
            module: def.module,
            generics: &node.generics,
            renamed: &[],
            ports: vec![],
            events: 0,
        };
        // The `impl` may call the parameters of the struct by other names.
        let with_process = methods.iter().find(|m| m.process.is_some());
        let renamed: Vec<(String, String)> = with_process
            .map(|m| {
                m.generics
                    .iter()
                    .zip(&node.generics)
                    .filter_map(|(a, b)| Some((a.name()?.to_owned(), b.clone())))
                    .collect()
            })
            .unwrap_or_default();
        builder.renamed = &renamed;
        let (args, returns) = process.map_or((None, ReturnSig::default()), |p| builder.process(p));
        let slots = methods.iter().flat_map(|m| &m.slots).enumerate().map(|(i, slot)| builder.slot(slot, i)).collect();
        let ports = builder.ports;
        let params: Vec<ParamSig> = node.params.iter().map(|p| self.param(p, def.module, &node.generics)).collect();
        let state = node.state.iter().map(|ty| self.type_of(ty, def.module, &node.generics));
        // Most crates lack nothing.
        let needs = self.lacks().and_then(|_| {
            let ports = ports.iter().map(|p| p.ty.needs());
            self.needs(def, ports.chain(params.iter().map(|p| p.ty.needs())).chain(state.map(|ty| ty.needs())))
        });
        Signature {
            needs,
            name: def.name.clone(),
            docs: node.docs.clone(),
            file: def.file.strip_prefix(&self.crates.root).unwrap_or(&def.file).to_owned(),
            line: def.line,
            path: self.paths.get(&id).cloned().unwrap_or_default(),
            is_function,
            generics: node.generics.clone(),
            stateful: node.stateful,
            params,
            ports,
            process: args,
            returns,
            no_message: methods.iter().find_map(|m| m.no_message.clone()),
            slots,
            on_activate: methods.iter().find_map(|m| m.on_activate.clone()),
            on_deactivate: methods.iter().find_map(|m| m.on_deactivate.clone()),
            deactivates: node.deactivates,
        }
    }

    /// What a node cannot do without whose tokens, parameters and state need this.
    fn needs(&self, def: &Def, types: impl Iterator<Item = Option<(Need, String)>>) -> Option<(Need, String)> {
        let krate = self.tree.modules[def.module].krate;
        let name = &self.crates.all[krate].name;
        if !self.tree.does_without[krate].can_lack_std {
            return Some((Need::Std, format!("its crate `{name}` is not `#![no_std]`")));
        }
        let feature = |word: &str| format!("it exists only with the feature `{word}` of `{name}`");
        match def.need {
            Some(Need::Std) => return Some((Need::Std, feature("std"))),
            Some(Need::Heap) => return Some((Need::Heap, feature("alloc"))),
            None => {}
        }
        let (need, of) = types.flatten().max_by_key(|(need, _)| *need)?;
        Some((need, format!("it has to do with `{of}`")))
    }

    /// What the crate that the program becomes part of does without, if it says so.
    pub fn lacks(&self) -> Option<Need> {
        let here = self.tree.does_without.get(self.crates.here)?;
        match (here.lacks_std, here.has_heap) {
            (false, _) => None,
            (true, true) => Some(Need::Std),
            (true, false) => Some(Need::Heap),
        }
    }

    /// On which condition something of a crate exists that is not there now, if it does.
    pub fn left_out(&self, names: &[&str]) -> Option<String> {
        let (krate, name, cfg) = self.tree.left_out.iter().find(|(_, name, _)| names.contains(&name.as_str()))?;
        Some(format!("`{name}` of `{}` exists only with `{cfg}`", self.crates.all[*krate].name))
    }

    fn param(&self, param: &items::ParamItem, module: ModuleId, generics: &[String]) -> ParamSig {
        ParamSig {
            name: param.name.clone(),
            docs: param.docs.clone(),
            ty: self.type_of(&param.ty, module, generics),
            unit: param.unit.clone(),
            default: param.default.clone(),
            range: param.range,
        }
    }

    /// The node types that `path` names where a text stands: `imports` are its `use` lines.
    pub fn nodes(&self, path: &[String]) -> Vec<SignatureId> {
        self.defs(path).iter().filter_map(|def| self.by_def.get(def).copied()).collect()
    }

    /// The types that `path` names, as [`Catalog::nodes`].
    pub fn types(&self, path: &[String]) -> Vec<DefId> {
        self.defs(path)
            .into_iter()
            .filter(|d| matches!(self.tree.defs[*d].kind, ItemKind::Type(_) | ItemKind::Alias(_)))
            .collect()
    }

    fn defs(&self, path: &[String]) -> Vec<DefId> {
        let found = self.crates.own.iter().map(|own| self.defs_in(*own, path)).find(|found| !found.is_empty());
        found.unwrap_or_default()
    }

    /// What `path` names in one of the package's own crates. A name without a path may stand in any module.
    fn defs_in(&self, krate: usize, path: &[String]) -> Vec<DefId> {
        let found = self.tree.resolve(self.tree.roots[krate], path);
        match path {
            [name] if found.is_empty() => {
                let is_meant = |d: &DefId| {
                    self.tree.defs[*d].name == *name && self.tree.modules[self.tree.defs[*d].module].krate == krate
                };
                (0..self.tree.defs.len()).filter(is_meant).collect()
            }
            _ => found,
        }
    }

    /// Whether `name` is a crate that a text can import from.
    pub fn is_crate(&self, name: &str) -> bool {
        name == "crate" || self.crates.own.iter().any(|own| self.crates.all[*own].dependencies.contains_key(name))
    }

    /// Whether `name` is a crate that is not scanned: its types can be named, and nothing is known of them.
    pub fn is_extern(&self, name: &str) -> bool {
        ["std", "core", "alloc"].contains(&name)
            || self.crates.own.iter().any(|own| self.crates.all[*own].externs.contains(name))
    }

    /// All definitions with this name.
    pub fn find(&self, name: &str) -> Vec<DefId> {
        (0..self.tree.defs.len()).filter(|def| self.tree.defs[*def].name == name).collect()
    }

    /// Names that may stand behind `path`, for suggestions.
    pub fn names_in(&self, path: &[String]) -> Vec<&str> {
        self.crates.own.iter().flat_map(|own| self.tree.names_in(self.tree.roots[*own], path)).collect()
    }

    /// Files in which a macro makes nodes that the scan cannot see.
    pub fn hidden(&self) -> &[PathBuf] {
        &self.tree.hidden
    }

    /// What is wrong with the Rust files that cannot be read, each as a sentence.
    pub fn broken(&self) -> impl Iterator<Item = String> {
        self.tree.broken.iter().map(|(file, line, reason)| {
            let file = file.strip_prefix(&self.crates.root).unwrap_or(file).display();
            format!("the nodes in {file} are not known, as its line {line} is no Rust: {reason}")
        })
    }

    /// The name of a definition.
    pub fn name(&self, def: DefId) -> &str {
        &self.tree.defs[def].name
    }

    /// Where a definition stands: file, and line from 1.
    pub fn place(&self, def: DefId) -> (PathBuf, usize) {
        let def = &self.tree.defs[def];
        (def.file.strip_prefix(&self.crates.root).unwrap_or(&def.file).to_owned(), def.line)
    }

    /// The crates that a text can import from.
    pub fn crate_names(&self) -> BTreeSet<&str> {
        let dependencies = self.crates.own.iter().flat_map(|own| self.crates.all[*own].dependencies.keys());
        dependencies.map(String::as_str).collect()
    }

    /// How generated code reaches a definition.
    pub fn path(&self, def: DefId) -> Option<&[String]> {
        self.paths.get(&def).map(Vec::as_slice)
    }
}

/// Collects the ports of one signature.
struct SignatureBuilder<'a> {
    catalog: &'a Catalog,
    module: ModuleId,
    generics: &'a [String],
    renamed: &'a [(String, String)],
    ports: Vec<PortSig>,
    /// How many events there are so far.
    events: usize,
}

impl SignatureBuilder<'_> {
    fn ty(&self, ty: &Ty) -> Type {
        let names: Vec<String> =
            self.renamed.iter().map(|(from, _)| from.clone()).chain(self.generics.iter().cloned()).collect();
        let ty = self.catalog.type_of(ty, self.module, &names);
        ty.rename(self.renamed)
    }

    fn port(
        &mut self,
        name: &str,
        kind: crate::syntax::tree::PortKind,
        ty: &Ty,
        batch: Option<usize>,
        optional: bool,
        index: usize,
    ) -> usize {
        let rate = batch.unwrap_or(1);
        let ty = self.ty(ty);
        self.ports.push(PortSig {
            name: name.to_owned(),
            kind,
            ty,
            rate,
            optional,
            index,
            field: None,
            field_is_option: false,
            docs: String::new(),
        });
        self.ports.len() - 1
    }

    fn process(&mut self, process: &items::Process) -> (Option<Vec<ArgSig>>, ReturnSig) {
        use crate::syntax::tree::PortKind::{Input, Output};
        let (mut inputs, mut outputs) = (0, 0);
        let next = |counter: &mut usize| {
            *counter += 1;
            *counter - 1
        };
        let mut args = vec![];
        for arg in &process.args {
            args.push(match &arg.kind {
                ArgKind::Input(ty, batch) => {
                    ArgSig::Port(self.port(&arg.name, Input, ty, *batch, false, next(&mut inputs)))
                }
                ArgKind::Optional(ty) => ArgSig::Port(self.port(&arg.name, Input, ty, None, true, next(&mut inputs))),
                ArgKind::Out(ty, batch) => {
                    ArgSig::Port(self.port(&arg.name, Output, ty, *batch, true, next(&mut outputs)))
                }
                ArgKind::Event(ty) => ArgSig::Port(self.event(&arg.name, ty)),
                ArgKind::Ctx => ArgSig::Ctx,
                ArgKind::Param(index) => ArgSig::Param(*index),
            });
        }
        let mut returns = ReturnSig { value: false, maybe: process.maybe, fallible: process.fallible, several: false };
        if let Some((ty, batch)) = &process.returns {
            returns.value = true;
            let maybe = process.maybe || process.fallible;
            match self.outputs_struct(ty) {
                Some(fields) => {
                    returns.several = true;
                    for (i, field) in fields.iter().enumerate() {
                        let port = self.port(&field.name, Output, &field.ty, None, field.maybe || maybe, outputs);
                        self.ports[port].field = Some((i, field.name.clone()));
                        self.ports[port].field_is_option = field.maybe;
                        self.ports[port].docs.clone_from(&field.docs);
                    }
                }
                None => {
                    self.port("out", Output, ty, *batch, maybe, outputs);
                }
            }
        }
        (Some(args), returns)
    }

    fn outputs_struct(&self, ty: &Ty) -> Option<Vec<items::OutputField>> {
        let Ty::Path(path, _) = ty else { return None };
        self.catalog.tree.resolve(self.module, path).into_iter().find_map(|def| {
            match &self.catalog.tree.defs[def].kind {
                ItemKind::Type(fields) => fields.clone(),
                _ => None,
            }
        })
    }

    /// An event is one port, however many methods may trigger it.
    fn event(&mut self, name: &str, ty: &Ty) -> usize {
        let kind = crate::syntax::tree::PortKind::Event;
        if let Some(known) = self.ports.iter().position(|p| p.kind == kind && p.name == name) {
            return known;
        }
        self.events += 1;
        self.port(name, kind, ty, None, false, self.events - 1)
    }

    fn slot(&mut self, slot: &items::SlotItem, index: usize) -> SlotSig {
        let port = self.port(&slot.name, crate::syntax::tree::PortKind::Slot, &slot.ty, None, false, index);
        self.ports[port].docs.clone_from(&slot.docs);
        let args = slot.args.iter().map(|arg| match &arg.kind {
            ArgKind::Event(ty) => ArgSig::Port(self.event(&arg.name, ty)),
            ArgKind::Ctx => ArgSig::Ctx,
            _ => ArgSig::Port(port),
        });
        SlotSig { port, args: args.collect(), fallible: slot.fallible }
    }
}
