//! Node signatures, read from the Rust sources of the node crates. rustc has the last word on types: the catalog
//! reports a mismatch only if it has seen both definitions.

mod cfg;
mod constants;
mod docs;
mod impls;
mod items;
pub mod library;
mod reach;
mod rust;
mod signature;
mod structs;
mod traits;
mod tree;
mod ty;
mod types;

use crate::{index::IdVec, source::World};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

pub use cfg::Conditions;
pub use constants::{Constant, is_path};
pub use docs::{first_sentence, linkless};
pub use items::{Default as DefaultValue, Item, Literal, read as read_items};
pub use reach::Site;
pub use signature::{ArgSig, MachineSig, ParamSig, PortSig, ReturnSig, Signature, SignatureId, SlotSig, WaitSig};
pub use structs::{Field, Struct, Structure};
pub use traits::Trait;
pub use tree::{DefId, ModuleId, Need};
pub use ty::Ty;
pub use types::{DURATION, Match, PRIMITIVES, STD, TIME, Type};

use items::{ArgKind, ItemKind, NodeItem, NodeMethods};
use tree::{Def, Tree};

/// A crate to scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CrateSpec {
    /// Name by which code refers to the crate.
    pub name: String,
    /// Root file.
    pub root: PathBuf,
    /// Enabled features.
    pub features: BTreeSet<String>,
    /// Names of its dependencies that are not scanned.
    pub externs: BTreeSet<String>,
    /// Dependencies among the scanned crates: name in its code → index.
    pub dependencies: BTreeMap<String, usize>,
}

/// Crates to scan, and the place from which the graph refers to them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Crates {
    /// Folder to which the names of files are relative.
    pub root: PathBuf,
    /// All crates to scan.
    pub all: Vec<CrateSpec>,
    /// The crate that the generated code becomes part of.
    pub here: usize,
    /// Crates of the package, `here` first: `crate::` in a source file refers to one of them.
    pub own: Vec<usize>,
    /// Place of the generated code.
    pub site: Site,
    /// Conditions of the compilation, as reported by rustc.
    pub conditions: Conditions,
}

/// A world with Rust files.
pub trait RustFiles: World {
    /// The items of a Rust file. A world may cache them between runs.
    ///
    /// # Errors
    /// As [`World::read`].
    fn items(&mut self, path: &Path) -> Result<Arc<[Item]>, String> {
        self.read(path).map(|text| read_items(&text).into())
    }
}

/// All node signatures and types that a graph can refer to.
#[derive(Debug, Default)]
pub struct Catalog {
    /// The node types.
    pub signatures: IdVec<SignatureId, Signature>,
    tree: Tree,
    crates: Crates,
    by_def: BTreeMap<DefId, SignatureId>,
    /// Current module of the generated code; `None` is outside of all scanned crates.
    site: Option<ModuleId>,
    paths: BTreeMap<DefId, Vec<String>>,
}

impl Catalog {
    /// Scans `crates`.
    pub fn load(crates: Crates, world: &mut dyn RustFiles) -> Self {
        let tree = Tree::scan(&crates.all, &crates.own, &crates.conditions, world);
        let site = reach::site(&tree, &crates);
        let paths = tree.paths(site);
        let mut catalog = Self { tree, crates, site, paths, ..Self::default() };
        catalog.collect();
        catalog
    }

    /// Node types that are declared in Rust.
    pub fn rust_nodes(&self) -> impl Iterator<Item = (SignatureId, &Signature)> {
        self.signatures.iter_enumerated().take(self.by_def.len())
    }

    /// Removes the state machines of source files that were checked before.
    pub fn forget_machines(&mut self) {
        self.signatures.truncate(self.by_def.len());
    }

    /// Makes room for `count` state machines and returns their numbers.
    pub fn reserve_machines(&mut self, count: usize) -> Vec<SignatureId> {
        (0..count).map(|_| self.signatures.push(Signature::default())).collect()
    }

    /// Stores the signature of a state machine, whose number is reserved.
    pub fn add_machine(&mut self, id: SignatureId, signature: Signature) {
        self.signatures[id] = signature;
    }

    /// Returns `name` if it names a type in a module, but not one of the runtime.
    fn own_type<'n>(&self, module: ModuleId, name: &'n str) -> Option<&'n str> {
        let found = self.tree.resolve(module, &[name.to_owned()]);
        let is_own = |def: &Def| {
            let krate = self.tree.modules[def.module].krate;
            matches!(def.kind, ItemKind::Type(_) | ItemKind::Alias(_)) && self.crates.all[krate].name != "apex_rt"
        };
        found.iter().any(|def| is_own(&self.tree.defs[*def])).then_some(name)
    }

    /// Makes a signature of each node definition. Definitions that `#[node]` would misunderstand become
    /// [`ItemKind::Refused`].
    fn collect(&mut self) {
        let mut methods: BTreeMap<(ModuleId, &str), Vec<&NodeMethods>> = BTreeMap::new();
        for def in &self.tree.defs {
            if let ItemKind::Methods(m) = &def.kind {
                methods.entry((def.module, &m.node)).or_default().push(m);
            }
        }
        let (mut found, mut refused) = (vec![], vec![]);
        for (id, def) in self.tree.defs.iter_enumerated() {
            let (node, methods) = match &def.kind {
                ItemKind::Function(node) => (node, &[][..]),
                ItemKind::Struct(node) => {
                    (node, methods.get(&(def.module, def.name.as_str())).map_or(&[][..], Vec::as_slice))
                }
                _ => continue,
            };
            if let Some(name) = self.other_type(def, methods) {
                let reason = format!("its `{name}` is not the `{name}` of Apex: give the other type a different name");
                refused.push((id, reason));
                continue;
            }
            let signature = self.signature(id, node, methods);
            match signature.wrong_unit() {
                Some(reason) => refused.push((id, reason)),
                None => found.push((id, signature)),
            }
        }
        for (id, reason) in refused {
            self.tree.defs[id].kind = ItemKind::Refused(reason);
        }
        for (def, signature) in found {
            self.by_def.insert(def, self.signatures.push(signature));
        }
    }

    /// Name of a type of Apex among the arguments that means another type here. `#[node]` knows these types by their
    /// names only.
    fn other_type(&self, def: &Def, methods: &[&NodeMethods]) -> Option<&'static str> {
        let process = match &def.kind {
            ItemKind::Function(node) => node.process.as_ref(),
            _ => None,
        };
        let slots = methods.iter().flat_map(|m| &m.slots).flat_map(|slot| &slot.args);
        let processes = process.into_iter().chain(methods.iter().filter_map(|m| m.process.as_ref()));
        processes.flat_map(|process| &process.args).chain(slots).find_map(|arg| match arg.kind {
            ArgKind::Ctx => self.own_type(def.module, "Ctx"),
            ArgKind::Event(..) => self.own_type(def.module, "Event"),
            ArgKind::Out(..) => self.own_type(def.module, "Out"),
            ArgKind::Input(..) | ArgKind::Optional(_) | ArgKind::Many(..) | ArgKind::Param(_) => None,
        })
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
        // The `impl` may use other names for the type parameters of the struct.
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
        let state: Vec<Type> = node.state.iter().map(|ty| self.type_of(ty, def.module, &node.generics)).collect();
        // Most crates can use everything.
        let needs = self.lacks().and_then(|_| {
            let ports = ports.iter().map(|p| p.ty.needs());
            self.needs(def, ports.chain(params.iter().map(|p| p.ty.needs())).chain(state.iter().map(Type::needs)))
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
            bounds: node.bounds.iter().chain(methods.iter().flat_map(|m| &m.bounds)).cloned().collect(),
            stateful: node.stateful,
            state,
            params,
            ports,
            process: args,
            returns,
            no_message: methods.iter().find_map(|m| m.no_message.clone()),
            slots,
            on_activate: methods.iter().find_map(|m| m.on_activate.clone()),
            on_deactivate: methods.iter().find_map(|m| m.on_deactivate.clone()),
            on_stop: methods.iter().find_map(|m| m.on_stop.clone()),
            machine: None,
            deactivates: node.deactivates,
            computed: node.computed,
            keeps_frame: node.keeps_frame,
        }
    }

    /// Part of the Rust libraries that a node needs, and the reason. `types` are the needs of its tokens, parameters
    /// and state.
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
        Some((need, format!("it uses `{of}`")))
    }

    /// Smallest part of the Rust libraries that the crate of the program does without. `None` if it uses the standard
    /// library.
    pub fn lacks(&self) -> Option<Need> {
        let here = self.tree.does_without.get(self.crates.here)?;
        match (here.lacks_std, here.has_heap) {
            (false, _) => None,
            (true, true) => Some(Need::Std),
            (true, false) => Some(Need::Heap),
        }
    }

    /// Describes the condition under which one of these names would exist, if an item with this name was left out.
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
            is_silence: param.is_silence,
        }
    }

    /// Node types that `path` names in a source file.
    pub fn nodes(&self, path: &[String]) -> Vec<SignatureId> {
        self.defs(path).iter().filter_map(|def| self.by_def.get(def).copied()).collect()
    }

    /// Types that `path` names in a source file.
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

    /// Definitions that `path` names in one of the package's own crates. A name without a path may be in any module.
    fn defs_in(&self, krate: usize, path: &[String]) -> Vec<DefId> {
        let found = self.tree.resolve(self.tree.roots[krate], path);
        match path {
            [name] if found.is_empty() => {
                let is_meant = |d: &&DefId| self.tree.modules[self.tree.defs[**d].module].krate == krate;
                self.tree.named(name).iter().filter(is_meant).copied().collect()
            }
            _ => found,
        }
    }

    /// Returns `true` if `name` is a scanned crate that a source file can import from.
    pub fn is_crate(&self, name: &str) -> bool {
        name == "crate" || self.crates.own.iter().any(|own| self.crates.all[*own].dependencies.contains_key(name))
    }

    /// Returns `true` if `name` is a crate that is not scanned: its types can be named, but nothing else is known.
    pub fn is_extern(&self, name: &str) -> bool {
        ["std", "core", "alloc"].contains(&name)
            || self.crates.own.iter().any(|own| self.crates.all[*own].externs.contains(name))
    }

    /// Returns `true` if generated code can name a crate: one of the standard library, or on which the package depends.
    pub fn knows_crate(&self, name: &str) -> bool {
        self.is_crate(name) || self.is_extern(name)
    }

    /// Returns `true` if generated code can name all crates of a type.
    pub fn can_name(&self, ty: &Type) -> bool {
        self.foreign_crate(ty).is_none()
    }

    /// A crate of a type that the package does not depend on: only a library that it uses does.
    pub fn foreign_crate<'t>(&self, ty: &'t Type) -> Option<&'t str> {
        let of_all = |types: &'t [Type]| types.iter().find_map(|ty| self.foreign_crate(ty));
        match ty {
            Type::Named(name, args) => {
                let krate = name.split_once("::").map(|(krate, _)| krate);
                krate.filter(|name| *name != "apex_rt" && !self.knows_crate(name)).or_else(|| of_all(args))
            }
            Type::Def(_, _, args) | Type::Tuple(args) => of_all(args),
            Type::Array(inner, _) | Type::Ref(inner) | Type::Measured(inner, _) => self.foreign_crate(inner),
            Type::Primitive(_) | Type::Alias(..) | Type::Param(_) | Type::Unknown(_) => None,
        }
    }

    /// Returns `true` if the crate of the program has no preludes, and so no attributes of tools.
    pub fn lacks_prelude(&self) -> bool {
        self.tree.does_without.get(self.crates.here).is_some_and(|without| without.lacks_prelude)
    }

    /// All definitions with this name.
    pub fn find(&self, name: &str) -> Vec<DefId> {
        self.tree.named(name).to_vec()
    }

    /// For an item with this name that is marked `#[node]` but is not a node: the reason, the file and the line.
    pub fn refused(&self, name: &str) -> Option<(&str, &Path, usize)> {
        self.tree.named(name).iter().find_map(|def| match &self.tree.defs[*def] {
            Def { kind: ItemKind::Refused(reason), file, line, .. } => {
                Some((reason.as_str(), file.strip_prefix(&self.crates.root).unwrap_or(file), *line))
            }
            _ => None,
        })
    }

    /// Returns `true` if `path` names an item that is marked `#[node]` but is not a node.
    pub fn is_refused(&self, path: &[String]) -> bool {
        self.defs(path).iter().any(|def| matches!(self.tree.defs[*def].kind, ItemKind::Refused(_)))
    }

    /// Names that may follow `path`, for suggestions.
    pub fn names_in(&self, path: &[String]) -> Vec<&str> {
        self.crates.own.iter().flat_map(|own| self.tree.names_in(self.tree.roots[*own], path)).collect()
    }

    /// Files in which a macro makes nodes that the scan cannot see.
    pub fn hidden(&self) -> &[PathBuf] {
        &self.tree.hidden
    }

    /// Errors of the Rust files that cannot be read, each as a sentence.
    pub fn broken(&self) -> impl Iterator<Item = String> {
        self.tree.broken.iter().map(|(file, line, reason)| {
            let file = file.strip_prefix(&self.crates.root).unwrap_or(file).display();
            format!("the nodes in {file} are unknown: line {line} cannot be read ({reason})")
        })
    }

    /// Returns `true` if a definition is a type.
    pub fn is_type(&self, def: DefId) -> bool {
        matches!(self.tree.defs[def].kind, ItemKind::Type(_) | ItemKind::Alias(_))
    }

    /// Smallest and largest number of type arguments of a type; `None` for a generic alias, whose parameters are not
    /// known.
    pub fn arguments(&self, def: DefId) -> Option<(usize, usize)> {
        match &self.tree.defs[def].kind {
            ItemKind::Type(ty) => Some(ty.arguments),
            ItemKind::Alias(Some(_)) => Some((0, 0)),
            _ => None,
        }
    }

    /// Returns `true` if an argument of a type may be a number.
    pub fn takes_number(&self, def: DefId, argument: usize) -> bool {
        match &self.tree.defs[def].kind {
            ItemKind::Type(ty) => ty.numbers.contains(&argument),
            // The parameters of a generic alias are not known.
            _ => true,
        }
    }

    /// Names of the types in the package's own crates.
    pub fn own_types(&self) -> impl Iterator<Item = &str> {
        let is_own = |def: &&Def| self.crates.own.contains(&self.tree.modules[def.module].krate);
        let is_type = |def: &&Def| matches!(def.kind, ItemKind::Type(_) | ItemKind::Alias(_));
        self.tree.defs.iter().filter(is_own).filter(is_type).map(|def| def.name.as_str())
    }

    /// Returns `true` if the module `parent` may have items that the scan does not see, for example from a macro.
    pub fn may_hide(&self, parent: &[String]) -> bool {
        self.crates.own.iter().any(|own| self.tree.may_hide(self.tree.roots[*own], parent))
    }

    /// The name of a definition.
    pub fn name(&self, def: DefId) -> &str {
        &self.tree.defs[def].name
    }

    /// Place of a definition: file, and line from 1.
    pub fn place(&self, def: DefId) -> (PathBuf, usize) {
        let def = &self.tree.defs[def];
        (def.file.strip_prefix(&self.crates.root).unwrap_or(&def.file).to_owned(), def.line)
    }

    /// Scanned crates that a source file can import from.
    pub fn crate_names(&self) -> BTreeSet<&str> {
        let dependencies = self.crates.own.iter().flat_map(|own| self.crates.all[*own].dependencies.keys());
        dependencies.map(String::as_str).collect()
    }

    /// Path by which generated code reaches a definition.
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
    /// Number of events among the ports.
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
            any_number: false,
            failure: false,
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
                ArgKind::Many(ty, optional) => {
                    let port = self.port(&arg.name, Input, ty, None, *optional, next(&mut inputs));
                    self.ports[port].any_number = true;
                    ArgSig::Port(port)
                }
                ArgKind::Out(ty, batch) => {
                    ArgSig::Port(self.port(&arg.name, Output, ty, *batch, true, next(&mut outputs)))
                }
                ArgKind::Event(ty, fails) => ArgSig::Port(self.event(&arg.name, ty, *fails)),
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
                ItemKind::Type(ty) => ty.outputs.clone(),
                _ => None,
            }
        })
    }

    /// Number of the port of an event. An event is one port, however many methods may trigger it.
    fn event(&mut self, name: &str, ty: &Ty, fails: bool) -> usize {
        let kind = crate::syntax::tree::PortKind::Event;
        if let Some(known) = self.ports.iter().position(|p| p.kind == kind && p.name == name) {
            self.ports[known].failure |= fails;
            return known;
        }
        self.events += 1;
        let port = self.port(name, kind, ty, None, false, self.events - 1);
        self.ports[port].failure = fails;
        port
    }

    fn slot(&mut self, slot: &items::SlotItem, index: usize) -> SlotSig {
        let port = self.port(&slot.name, crate::syntax::tree::PortKind::Slot, &slot.ty, None, false, index);
        self.ports[port].docs.clone_from(&slot.docs);
        let args = slot.args.iter().map(|arg| match &arg.kind {
            ArgKind::Event(ty, fails) => ArgSig::Port(self.event(&arg.name, ty, *fails)),
            ArgKind::Ctx => ArgSig::Ctx,
            _ => ArgSig::Port(port),
        });
        SlotSig { port, method: slot.name.clone(), args: args.collect(), fallible: slot.fallible }
    }
}
