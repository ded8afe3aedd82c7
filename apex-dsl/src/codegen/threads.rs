//! A program that runs on several threads: a part for each thread group, the cells between them, and how all of it
//! reacts on one thread or is handed out to several.

use super::{
    cells::cell_name,
    generator::Generator,
    groups::group_info,
    names::Names,
    params::ParamRows,
    structs::{Field, around_text, node_structs, port_accessors},
    tokens::ident,
    view::{Lowered, ProgramView},
};
use crate::{
    analyse::Analysis,
    graph::{Graph, NodeId},
    threads::{Origin, Part, Split},
};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// The field of a part in the whole program.
pub fn part_name(part: &Part) -> Ident {
    format_ident!("on_{}", part.group)
}

impl Generator<'_> {
    /// All items of a program on several threads.
    pub fn threads(
        &self,
        graph: &Graph,
        analysis: &Analysis,
        split: &Split,
        used: &mut BTreeSet<String>,
    ) -> TokenStream {
        let parts = split.parts.iter().zip(self.names.beyond..);
        let names: Vec<Names> = parts.map(|(part, number)| self.names.of_part(part, number, used)).collect();
        let of_part = |i: usize| Generator { names: &names[i], part: Some((graph, &split.parts[i])), ..*self };
        let all = Program { generator: self, graph, split, parts: (0..names.len()).map(of_part).collect() };
        let place = |node: NodeId| {
            let field = split.parts.iter().find(|part| part.group == graph.group(node)).map(part_name);
            quote!(self.#field.nodes)
        };
        let params = self.parameters(graph, analysis);
        let mut code = quote!();
        let mut all_items = vec![];
        for (number, part) in split.parts.iter().enumerate() {
            let generator = of_part(number);
            let lowered = Lowered::new(&generator, &part.graph, &part.analysis);
            let view = ProgramView::new(&part.graph, &part.analysis, &lowered);
            let (items, react) = (generator.items(view), generator.react(view));
            let part_items = PartItems {
                is_active: generator.is_active(view),
                is_graph_active: generator.is_graph_active(view),
                waiting: generator.waiting(view),
                fields: generator.fields(&part.graph, &part.analysis),
            };
            let PartItems { is_active, is_graph_active, waiting, .. } = &part_items;
            let name = generator.program_name(&part.graph);
            let handle = all.handle(number, &params);
            code.extend(quote! {
                #items
                impl #name { #react #is_active #is_graph_active #waiting }
                #handle
            });
            all_items.push(part_items);
        }
        let (structs, program) = (all.structs(&all_items), all.program(analysis, &all_items));
        let parameters = params.implementation(&all.name(), &place);
        let moved = self.moved_tokens(graph);
        quote! { #code #structs #program #parameters #moved }
    }

    fn fields(&self, graph: &Graph, analysis: &Analysis) -> Fields {
        let mut fields = Fields::default();
        self.node_fields(graph, analysis, &mut fields.nodes, &mut fields.handed_in);
        fields
    }
}

/// The nodes of a part: their fields, and those that Rust makes.
#[derive(Default)]
struct Fields {
    nodes: BTreeMap<String, Field>,
    handed_in: Vec<(Ident, TokenStream)>,
}

/// Items of a part that the whole program refers to.
struct PartItems {
    is_active: TokenStream,
    is_graph_active: TokenStream,
    waiting: TokenStream,
    fields: Fields,
}

/// The program around its parts.
struct Program<'a> {
    generator: &'a Generator<'a>,
    graph: &'a Graph,
    split: &'a Split,
    /// The generators of the parts.
    parts: Vec<Generator<'a>>,
}

impl Program<'_> {
    fn name(&self) -> Ident {
        ident(&self.graph.name)
    }

    /// Name of the struct of a part.
    fn part_struct(&self, number: usize) -> Ident {
        self.parts[number].program_name(&self.split.parts[number].graph)
    }

    /// Names of the structs of a part that is handed out: its ends of cells, and the part with them.
    fn handle_structs(&self, number: usize) -> [Ident; 2] {
        ["Ends", "Group"].map(|kind| self.parts[number].item(&self.split.parts[number].graph, kind))
    }

    /// Handle of a thread group for the thread that runs it: the part with its ends of cells.
    fn handle(&self, number: usize, params: &ParamRows) -> TokenStream {
        let part = &self.split.parts[number];
        let (program, name) = (self.name(), self.part_struct(number));
        let [ends, handle] = self.handle_structs(number);
        let call = quote!(self.part.react_part(now, true, &mut self.ends, &self.wake, observer));
        let ports = quote!(self.part);
        let mailboxes = self.parts[number].port_mailboxes(&part.graph, &ports);
        let react = self.generator.recorded_react(self.graph, (number == 0).then_some(&ports), &call);
        let stop = self.parts[number].stop(&part.graph, &part.analysis, &quote!(self.part));
        let visit = params.visit(&|node| (self.graph.group(node) == part.group).then(|| quote!(self.part.nodes)));
        let fields = self.ends(number).map(|(cell, sends)| {
            let ty = self.generator.token_type(self.graph, self.split.cells[cell].from);
            let (field, end) = (cell_name(cell), if sends { quote!(CellSender) } else { quote!(CellReceiver) });
            quote! { #field: ::apex_rt::#end<'a, ::apex_rt::threads::CellMessage<#ty>>, }
        });
        quote! {
            struct #ends<'a> { #(#fields)* life: ::core::marker::PhantomData<&'a ()> }
            struct #handle<'a, W> { part: &'a mut #name, ends: #ends<'a>, wake: W }
            impl<W: ::apex_rt::threads::Wake> ::apex_rt::params::Parameters for #handle<'_, W> {
                const PARAMS: &'static [::apex_rt::params::ParamInfo] = <#program as ::apex_rt::params::Parameters>::PARAMS;
                #visit
            }
            impl<W: ::apex_rt::threads::Wake> ::apex_rt::Program for #handle<'_, W> {
                const INFO: ::apex_rt::Info = <#program as ::apex_rt::Program>::INFO;
                #mailboxes
                #[inline]
                #react
                #stop
            }
            impl<W: ::apex_rt::threads::Wake> ::apex_rt::threads::Group for #handle<'_, W> {
                #[inline]
                fn react_part<O: ::apex_rt::Observer>(&mut self, now: ::apex_rt::Time, begins: bool, observer: &mut O) -> ::apex_rt::Next {
                    self.part.react_part(now, begins, &mut self.ends, &self.wake, observer)
                }
            }
        }
    }

    /// The struct of the program, its cells, and the views on its nodes.
    fn structs(&self, all_items: &[PartItems]) -> TokenStream {
        let (graph, name) = (self.graph, self.name());
        let numbers = 0..self.split.parts.len();
        let parts: Vec<Ident> = self.split.parts.iter().map(part_name).collect();
        let part_types: Vec<Ident> = numbers.clone().map(|number| self.part_struct(number)).collect();
        let (cells, cell_types): (Vec<Ident>, Vec<TokenStream>) = self
            .split
            .cells
            .iter()
            .enumerate()
            .map(|(cell, c)| (cell_name(cell), self.generator.token_type(graph, c.from)))
            .unzip();
        let cells_name = self.generator.item(graph, "Cells");
        let docs = if graph.docs.is_empty() { format!("The graph `{}`.", graph.name) } else { graph.docs.clone() };
        let mut nodes = BTreeMap::new();
        for (part, part_items) in parts.iter().zip(all_items) {
            view_nodes(&part_items.fields.nodes, &quote!(self.#part.nodes), &mut nodes);
        }
        let nodes = node_structs(&self.generator.item(graph, "Nodes"), &name, &nodes, true);
        let (node_items, nodes_type, nodes_make) = (&nodes.item, &nodes.ty, &nodes.make);
        let handed_in: Vec<(Ident, TokenStream)> = all_items.iter().flat_map(|v| v.fields.handed_in.clone()).collect();
        let makes = numbers.zip(all_items).map(|(number, part_items)| {
            let own = &part_items.fields.handed_in;
            let (name, fields) = (&part_types[number], own.iter().map(|(field, _)| field));
            match self.parts[number].parts_struct(&self.split.parts[number].graph, own) {
                None => quote!(#name::new()),
                Some((given, _)) => quote!(#name::new(#given { #(#fields: parts.#fields),* })),
            }
        });
        let parts_struct = self.generator.parts_struct(graph, &handed_in);
        let (argument, default) = match &parts_struct {
            Some((given, _)) => (quote!(parts: #given), quote!()),
            None => {
                (quote!(), quote! { impl ::core::default::Default for #name { fn default() -> Self { Self::new() } } })
            }
        };
        let item = parts_struct.map(|(_, item)| item);
        let ports = self.ports();
        let inner = around_text();
        quote! {
            #[doc = #docs]
            pub struct #name { #(#inner #parts: #part_types,)* #inner cells: #cells_name }
            #inner struct #cells_name { #(#inner #cells: ::apex_rt::TokenCell<::apex_rt::threads::CellMessage<#cell_types>>,)* }
            #node_items
            #item
            impl #name {
                /// The program before its first reaction.
                pub fn new(#argument) -> Self {
                    Self {
                        #(#parts: #makes,)*
                        cells: #cells_name { #(#cells: ::apex_rt::TokenCell::new(::apex_rt::threads::CellMessage::new()),)* },
                    }
                }
                /// The nodes, by instance name.
                pub fn nodes(&self) -> #nodes_type { #nodes_make }
                #ports
            }
            #default
        }
    }

    /// The way to the ports of the program: they belong to the main group.
    fn ports(&self) -> TokenStream {
        let main = &self.split.parts[0];
        let part = part_name(main);
        let structs = self.parts[0].port_structs(&main.graph);
        let place = quote!(self.#part);
        port_accessors(&structs, &place)
    }

    /// Functions that react.
    fn program(&self, analysis: &Analysis, all_items: &[PartItems]) -> TokenStream {
        let (name, parts) = (self.name(), &self.split.parts);
        let count = parts.len();
        let fields: Vec<Ident> = parts.iter().map(part_name).collect();
        let numbers: Vec<syn::Index> = (0..count).map(syn::Index::from).collect();
        let (groups, receiving) = (self.groups(), self.receiving());
        let watch = self.watch(count);
        let last = (1..count).map(|i| {
            let (number, index) = (&numbers[i], i);
            quote! { spawn.spawn(#index, groups.#number); }
        });
        let any = |tokens: &dyn Fn(&PartItems) -> &TokenStream, call: TokenStream| {
            let has = fields.iter().zip(all_items).filter(|(_, part_items)| !tokens(part_items).is_empty());
            let calls = has.map(|(field, _)| quote!(|| self.#field.#call));
            quote!(false #(#calls)*)
        };
        let is_active = any(&|v| &v.is_active, quote!(is_active(node)));
        let is_graph_active = any(&|v| &v.is_graph_active, quote!(is_graph_active(graph)));
        let waiting = fields.iter().zip(all_items).filter(|(_, v)| !v.waiting.is_empty()).map(|(field, _)| field);
        let stops = |number: &usize| {
            let part = &parts[*number];
            !self.parts[*number].stop_nodes(&part.graph, &part.analysis).is_empty()
        };
        let stopping = (0..count).filter(stops).map(|number| &fields[number]);
        let info = self.info(analysis);
        let name_of_reaction = self.generator.reaction();
        let react = quote! {
                fn #name_of_reaction<O: ::apex_rt::Observer>(&mut self, now: ::apex_rt::Time, observer: &mut O) -> ::apex_rt::Next {
                    let woken = ::apex_rt::threads::ReadySet::all(#count);
                    let mut groups = self.groups(&woken);
                    let mut next = [::apex_rt::Next::Input; #count];
                    let mut counts = [0u32; #count];
                    for round in 0..::apex_rt::threads::MAX_ROUNDS {
                        #(
                            if woken.take(#numbers) {
                                next[#numbers] = ::apex_rt::threads::Group::react_part(&mut groups.#numbers, now, round == 0, observer);
                                counts[#numbers] += 1;
                                if let ::apex_rt::Next::Exit(code) = next[#numbers] { return ::apex_rt::Next::Exit(code); }
                            }
                        )*
                        if woken.is_none() {
                            return next.into_iter().fold(::apex_rt::Next::Input, ::apex_rt::Next::or);
                        }
                    }
                    observer.endless(&[#(#receiving),*], &counts);
                    ::apex_rt::Next::Now
                }
        };
        let main = part_name(&parts[0]);
        let mailboxes = self.parts[0].port_mailboxes(&parts[0].graph, &quote!(self.#main));
        let (own_react, react) = self.generator.around(self.graph, react, &quote!(self.#main));
        let recording = self.generator.recording(self.graph);
        let endless = parts.iter().filter(|p| p.analysis.asynchronous.endless).map(part_name);
        quote! {
            #info
            impl #name {
                /// Reacts at `now`, all thread groups in turn: runs until nothing is ready, and says when it wants to
                /// be called next.
                #[inline]
                pub fn react(&mut self, now: ::apex_rt::Time) -> ::apex_rt::Next { ::apex_rt::Program::react_with(self, now, &mut ()) }
                /// Sets how many steps a reaction of a thread group may take before it is reported as an endless loop.
                pub fn set_budget(&mut self, steps: u32) { #(self.#endless.set_budget(steps);)* }
                #groups
                #own_react
            }
            impl ::apex_rt::Program for #name {
                const INFO: ::apex_rt::Info = INFO;
                #mailboxes
                #recording
                #react
                fn on_threads<'a, W, S>(&'a mut self, wake: W, spawn: &mut S)
                where
                    W: ::apex_rt::threads::Wake + ::core::marker::Copy + ::core::marker::Send + 'a,
                    S: ::apex_rt::threads::Spawn<'a, Self::Inputs, Self::Events>,
                {
                    let groups = self.groups(wake);
                    #watch
                    #(#last)*
                    spawn.stay(0, groups.0);
                }
                fn is_active(&self, node: usize) -> bool { #is_active }
                fn is_graph_active(&self, graph: usize) -> bool { #is_graph_active }
                fn waiting(&self, mut found: impl FnMut(usize)) { #(self.#waiting.waiting(&mut found);)* }
                fn stop(&mut self) { #(self.#stopping.stop_nodes();)* }
            }
        }
    }

    /// The function that hands out the groups with their ends of all cells.
    fn groups(&self) -> TokenStream {
        let cells = (0..self.split.cells.len()).map(|cell| {
            let (field, sender, receiver) =
                (cell_name(cell), format_ident!("sender_{cell}"), format_ident!("receiver_{cell}"));
            quote! { let (#sender, #receiver) = self.cells.#field.ends(); }
        });
        let (mut types, mut makes) = (vec![], vec![]);
        for (number, part) in self.split.parts.iter().enumerate() {
            let ([ends, handle], field) = (self.handle_structs(number), part_name(part));
            let own = self.ends(number).map(|(cell, sends)| {
                let (name, side) = (cell_name(cell), if sends { "sender" } else { "receiver" });
                let end = format_ident!("{side}_{cell}");
                quote! { #name: #end, }
            });
            types.push(quote!(#handle<'_, W>));
            makes.push(quote! {
                #handle { part: &mut self.#field, ends: #ends { #(#own)* life: ::core::marker::PhantomData }, wake }
            });
        }
        // What goes to those who watch over the threads comes last.
        let watched = self.watched().map(|cell| format_ident!("sender_{cell}"));
        let watched_types =
            self.watched().map(|_| quote!(::apex_rt::CellSender<'_, ::apex_rt::threads::CellMessage<()>>));
        quote! {
            fn groups<W: ::apex_rt::threads::Wake + ::core::marker::Copy>(&mut self, wake: W) -> (#(#types,)* #(#watched_types,)*) {
                #(#cells)*
                (#(#makes,)* #(#watched,)*)
            }
        }
    }

    /// The cells that a group has an end of, and whether it sends.
    fn ends(&self, group: usize) -> impl Iterator<Item = (usize, bool)> + '_ {
        let cells = self.split.cells.iter().enumerate();
        cells
            .filter(move |(_, c)| c.sender == Some(group) || c.receiver == group)
            .map(move |(cell, c)| (cell, c.receiver != group))
    }

    /// The cells that only those use who watch over the threads.
    fn watched(&self) -> impl Iterator<Item = usize> + '_ {
        self.split.cells.iter().enumerate().filter(|(_, cell)| cell.sender.is_none()).map(|(number, _)| number)
    }

    /// Hands out the cells for the event that a node hangs, which stand behind the groups.
    fn watch(&self, groups: usize) -> TokenStream {
        let tells = self.watched().enumerate().map(|(i, cell)| {
            let (place, receiver) = (syn::Index::from(groups + i), self.split.cells[cell].receiver);
            quote! { spawn.watch(#receiver, groups.#place); }
        });
        quote! { #(#tells)* }
    }

    /// For each group the first node that takes something from another group: what tokens go round through.
    fn receiving(&self) -> Vec<usize> {
        let first = |group: usize| {
            let cell = self.split.cells.iter().find(|cell| cell.receiver == group || cell.sender == Some(group))?;
            let nodes = self.graph.connections.iter().filter(|c| c.from == cell.from).map(|c| c.to.node);
            nodes.chain([cell.from.node]).find(|node| self.graph.group(*node) == self.split.parts[group].group)
        };
        (0..self.split.parts.len()).map(|group| first(group).map_or(0, NodeId::index)).collect()
    }

    fn info(&self, analysis: &Analysis) -> TokenStream {
        let groups: Vec<TokenStream> =
            self.split.parts.iter().map(|part| group_info(self.graph, &part.group)).collect();
        let of_part = |part: &Part, nodes: Vec<NodeId>| {
            let is_node = |node: NodeId| if let Origin::Node(node) = part.origins[node] { Some(node) } else { None };
            nodes.into_iter().filter_map(is_node).collect::<Vec<NodeId>>()
        };
        let clusters =
            self.split.parts.iter().flat_map(|p| p.analysis.clusters.iter().map(move |c| of_part(p, c.schedule())));
        let clusters: Vec<Vec<NodeId>> = clusters.filter(|nodes| !nodes.is_empty()).collect();
        self.generator.info(self.graph, analysis, &clusters, &groups)
    }
}

/// The nodes of a part as references, in `into`.
fn view_nodes(fields: &BTreeMap<String, Field>, place: &TokenStream, into: &mut BTreeMap<String, Field>) {
    for (name, field) in fields {
        let field_name = ident(name);
        match field {
            Field::Node { ty, .. } => {
                let part_items = Field::Node { ty: quote!(&'a #ty), make: quote!(&#place.#field_name) };
                into.insert(name.clone(), part_items);
            }
            Field::Nested(inner) => {
                let nested = into.entry(name.clone()).or_insert_with(|| Field::Nested(BTreeMap::new()));
                if let Field::Nested(nested) = nested {
                    view_nodes(inner, &quote!(#place.#field_name), nested);
                }
            }
        }
    }
}
