//! Rows of generated code: constants that say what tokens at a port do to activity and to other nodes, and the parts
//! of the state that the functions of `apex_rt::Wired` work on.

use super::{
    generator::Generator,
    tokens::{ident, nanos},
    view::ProgramView,
};
use crate::{
    analyse::{Delivery, blockers},
    graph::{NodeId, PortId},
    program::{Carries, Flag, Port, Send, Slot},
};
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, format_ident, quote};
use syn::Ident;

/// A row in the making: a constant, with the methods that add to it.
struct Row(TokenStream);

impl Row {
    fn number(&mut self, method: &str, number: Option<usize>) {
        if let Some(number) = number {
            let number = Literal::usize_unsuffixed(number);
            self.add(method, &quote!(#number));
        }
    }

    fn list(&mut self, method: &str, numbers: impl IntoIterator<Item = usize>) {
        let mut numbers = numbers.into_iter().map(Literal::usize_unsuffixed).peekable();
        if numbers.peek().is_some() {
            self.add(method, &quote!(&[#(#numbers),*]));
        }
    }

    fn add(&mut self, method: &str, arguments: &TokenStream) {
        let method = format_ident!("{method}");
        self.0.extend(quote!(.#method(#arguments)));
    }
}

impl Generator<'_> {
    /// The module with the rows: of the nodes that can be active, of the ports whose tokens have effects, and of the
    /// connections to slots.
    pub fn row_constants(&self, view: ProgramView<'_>) -> TokenStream {
        let nodes = view.labels.nodes.iter().map(|(node, name)| {
            let (name, row) = (ident(name), self.row_of_node(view, *node));
            quote! { pub const #name: Node = #row; }
        });
        let ports = view.wiring.ports().map(|port| {
            let (name, row) = (ident(&view.labels.ports[&port.end]), self.row_of_port(view, port));
            quote! { pub const #name: Port = #row; }
        });
        let anyway = view.wiring.ports().filter(|port| port.sends.iter().any(|send| send.absent)).map(|port| {
            let mut row = Row(quote!(Port::NEW));
            add_sends(&mut row, view, port.sends.iter().filter(|send| send.absent));
            let (name, row) = (anyway(view, port), row.0);
            quote! { pub const #name: Port = #row; }
        });
        let rows: TokenStream = nodes.chain(ports).chain(anyway).chain(self.slot_table(view)).collect();
        let module = self.rows_module(view);
        match rows.is_empty() {
            true => quote!(),
            false => quote! {
                /// Effects of tokens on activity and on other nodes.
                mod #module { use super::*; use ::apex_rt::rows::{Node, Port, Slot}; #rows }
            },
        }
    }

    /// Name of the module with the rows of a program or of a part of one. A program has the name that the text gives
    /// it.
    fn rows_module(&self, view: ProgramView<'_>) -> Ident {
        match self.part {
            Some((_, part)) => format_ident!("rows_of_{}", part.group),
            None if view.graph.name == "rows" => ident("rows_"),
            None => ident("rows"),
        }
    }

    /// The row of a port.
    pub fn port_row(&self, view: ProgramView<'_>, port: PortId) -> TokenStream {
        let (module, name) = (self.rows_module(view), ident(&view.labels.ports[&port]));
        quote!(#module::#name)
    }

    /// The rows of the connections to slots.
    pub fn slot_rows(&self, view: ProgramView<'_>) -> TokenStream {
        let module = self.rows_module(view);
        quote!(#module::SLOTS)
    }

    fn row_of_node(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        let number = Literal::usize_unsuffixed(self.index(node));
        let mut row = Row(quote!(Node::new(#number)));
        if let Some(timeout) = view.wiring.timeout(node) {
            let (number, after) = (Literal::usize_unsuffixed(timeout), nanos(view.wiring.timeouts[timeout].after));
            row.add("timeout", &quote!(#number, #after));
        }
        if !view.program.lower.is_observed(node) {
            row.add("unobserved", &quote!());
        }
        row.0
    }

    fn row_of_port(&self, view: ProgramView<'_>, port: &Port) -> TokenStream {
        let mut row = Row(quote!(Port::NEW));
        let number = |flag: &Flag| self.flag(*flag).1;
        if let Some(along) = &port.passes {
            // A delay keeps what its tokens carry, and has no activity of its own.
            if let Some(name) = view.labels.nodes.get(&port.end.node) {
                let name = ident(name);
                row.add("passes", &quote!(#name));
            }
            let (carries, gains): (Vec<&Flag>, Vec<&Flag>) =
                along.iter().partition(|flag| matches!(flag, Flag::Carries(_)));
            row.list("carries", carries.into_iter().map(number));
            row.list("gains", gains.into_iter().map(number));
        }
        row.list("loses", port.takes_away.iter().map(number));
        add_sends(&mut row, view, port.sends.iter().filter(|send| !send.absent));
        row.0
    }

    /// The table of connections to slots.
    fn slot_table(&self, view: ProgramView<'_>) -> Option<TokenStream> {
        let blockers = if view.wiring.may_get_stuck { blockers(view.graph, view.analysis) } else { vec![] };
        let rows = view.wiring.slots.iter().enumerate().map(|(number, slot)| {
            let mut row = self.slot_row(view, number, slot);
            let before = blockers.get(number).into_iter().flatten();
            row.list("after", before.map(|token| view.analysis.asynchronous.slot(*token)));
            row.0
        });
        let (rows, count) = (rows.collect::<Vec<_>>(), view.wiring.slots.len());
        (count > 0).then(|| quote! { pub const SLOTS: &[Slot; #count] = &[#(#rows),*]; })
    }

    /// The row of a connection to a slot.
    fn slot_row(&self, view: ProgramView<'_>, number: usize, slot: &Slot) -> Row {
        let node = Literal::usize_unsuffixed(self.index(slot.node));
        let mut row = Row(quote!(Slot::new(#node)));
        row.number("on", self.connection(slot.connection));
        row.number("frees", slot.frees);
        row.number("stamp", view.program.lower.stamp(slot.connection));
        let number = Literal::usize_unsuffixed(number);
        let node = || match view.labels.nodes.get(&slot.node) {
            Some(name) => ident(name).into_token_stream(),
            None => self.no_row(view, slot.node),
        };
        match slot.carries_to(view.graph) {
            Carries::Nothing => {}
            Carries::Always => row.add("always_activates", &node()),
            Carries::Sometimes => {
                let node = node();
                row.add("activates", &quote!(#number, #node));
            }
            Carries::Away => row.add("deactivates", &node()),
        }
        row
    }

    /// The row of a node that can be active.
    pub fn node_constant(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        match view.labels.nodes.get(&node) {
            Some(name) => {
                let (module, name) = (self.rows_module(view), ident(name));
                quote!(#module::#name)
            }
            None => self.no_row(view, node),
        }
    }

    fn no_row(&self, view: ProgramView<'_>, node: NodeId) -> TokenStream {
        self.bug(view.graph.nodes[node].span, "a node that becomes active has no row")
    }

    /// The parts of the state that rows refer to.
    pub fn wired(&self, view: ProgramView<'_>) -> TokenStream {
        let wiring = view.wiring;
        let core = self.item(view.graph, "Core");
        let sets = self.activity_state(view).into_iter().filter_map(|set| {
            let name = ["active", "gains", "loses", "carries"].into_iter().find(|name| set.name == name)?;
            let name = ident(name);
            Some(quote! { #[inline(always)] fn #name(&mut self) -> &mut [u64] { &mut self.#name.0 } })
        });
        let stamps = (!view.analysis.stamps.connections.is_empty()).then(|| {
            quote! { #[inline(always)] fn stamps(&mut self) -> &mut [::apex_rt::Time] { &mut self.stamps } }
        });
        let timeouts = (!wiring.timeouts.is_empty()).then(|| {
            let open = wiring
                .has_agenda()
                .then(|| quote! { #[inline(always)] fn open_agenda(&mut self) { self.agenda.open(); } });
            quote! {
                #[inline(always)]
                fn timeouts(&mut self) -> &mut [::apex_rt::Timeout] { &mut self.timeouts }
                #open
            }
        });
        let is_queued = !wiring.slots.is_empty() && view.analysis.asynchronous.delivery == Delivery::Queued;
        let queue =
            is_queued.then(|| quote! { #[inline(always)] fn queue(&mut self, slot: u16) { self.queue.push(slot); } });
        let bits = (wiring.bits.words() > 0).then(|| {
            quote! {
                #[inline(always)]
                fn raise(&mut self, bit: usize) { self.dispatcher.raise(bit); }
                #[inline(always)]
                fn occupy(&mut self, bit: usize) { self.dispatcher.clear(bit); }
            }
        });
        quote! { impl ::apex_rt::Wired for #core { #(#sets)* #stamps #timeouts #queue #bits } }
    }

    /// A token at a port goes off, if it is there; observers see events.
    pub fn send(&self, view: ProgramView<'_>, port: &Port) -> TokenStream {
        let goes = |absent: bool| port.sends.iter().any(|send| send.absent == absent && has_effect(view, send));
        let anyway = goes(true).then(|| {
            let name = anyway(view, port);
            let module = self.rows_module(view);
            quote! { core.send(&#module::#name, &true, ctx); }
        });
        let (row, present) = (self.port_row(view, port.end), self.waits(view.graph, port.end));
        let sent = match (goes(false), self.observed_event(view.graph, port.end)) {
            (false, None) => quote!(),
            (true, None) => {
                let token = self.kept(port.end);
                quote! { core.send(&#row, #token, ctx); }
            }
            (false, Some(observed)) => quote! { if #present { #observed } },
            (true, Some(observed)) => quote! { if #present { #observed core.send(&#row, &true, ctx); } },
        };
        quote! { #anyway #sent }
    }
}

/// Name of the row of the connections on which a port sends ⊥, too.
fn anyway(view: ProgramView<'_>, port: &Port) -> Ident {
    format_ident!("{}_ANYWAY", view.labels.ports[&port.end])
}

/// Returns `true` if a token that goes off on a connection changes the state.
fn has_effect(view: ProgramView<'_>, send: &Send) -> bool {
    send.queued.is_some() || send.raises.is_some() || view.program.lower.stamp(send.connection).is_some()
}

fn add_sends<'a>(row: &mut Row, view: ProgramView<'_>, sends: impl Iterator<Item = &'a Send> + Clone) {
    row.list("queues", sends.clone().filter_map(|send| send.queued));
    row.list("raises", sends.clone().filter_map(|send| send.raises));
    let goes = |send: &&Send| send.queued.is_some() || send.raises.is_some();
    row.list("occupies", sends.clone().filter(goes).filter_map(|send| send.occupies));
    row.list("stamps", sends.filter_map(|send| view.program.lower.stamp(send.connection)));
}
