//! The signatures of the nodes that were found.

use super::{
    catalog::Catalog,
    items::{self, ArgKind, ItemKind, NodeItem, NodeMethods},
    signature::{ArgSig, ParamSig, PortSig, ReturnSig, Signature, SlotSig},
    tree::{Def, DefId, ModuleId, Need},
    ty::Ty,
    types::Type,
};
use crate::syntax::tree::PortKind;
use std::collections::BTreeMap;

impl Catalog {
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
    pub(super) fn collect(&mut self) {
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
        kind: PortKind,
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
        use PortKind::{Input, Output};
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
        let kind = PortKind::Event;
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
        let port = self.port(&slot.name, PortKind::Slot, &slot.ty, None, false, index);
        self.ports[port].docs.clone_from(&slot.docs);
        let args = slot.args.iter().map(|arg| match &arg.kind {
            ArgKind::Event(ty, fails) => ArgSig::Port(self.event(&arg.name, ty, *fails)),
            ArgKind::Ctx => ArgSig::Ctx,
            _ => ArgSig::Port(port),
        });
        SlotSig { port, method: slot.name.clone(), args: args.collect(), fallible: slot.fallible }
    }
}
