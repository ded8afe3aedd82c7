//! `test` and `tune` items as Rust tests: the program that is made for them, and their scripts. A study is a test that
//! `cargo test` ignores; `apex tune` has it run the script again and again.

use super::{
    condition::holds,
    generator::Generator,
    text::module,
    threads::part_name,
    tokens::{constant, duration, ident},
};
use crate::{
    graph::{Graph, NodeId, PortId, Subject},
    script::{Observed, Script, Seen, Step, Study, Until, What},
};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;
use syn::Ident;

impl Generator<'_> {
    /// The field of a probe.
    pub fn probe(&self, node: NodeId) -> Ident {
        format_ident!("probe_{}", self.index(node))
    }

    /// Keeps a copy of a token, which is an `Option<&T>`, for the test.
    pub fn see(&self, graph: &Graph, probe: NodeId, from: PortId, token: &TokenStream) -> TokenStream {
        let (probe, copy) = (self.probe(probe), self.clone(graph, from, &quote!(token)));
        quote! { if let Some(token) = #token { outputs.#probe.saw(#copy); } }
    }

    /// Place of the ports that a node represents: the part of its thread group.
    fn ports_of(&self, graph: &Graph, node: NodeId) -> TokenStream {
        match self.parts.iter().find(|part| part.group == graph.group(node)).map(part_name) {
            Some(part) => quote!(program.#part),
            None => quote!(program),
        }
    }

    /// The tests of `program`: a module with the program and their scripts, and beside it the functions that Rust's
    /// tests know.
    pub fn tests(&self, graph: &Graph, scripts: &[Script], program: TokenStream) -> TokenStream {
        let module_name = format_ident!("tests_of_{}", graph.name);
        let runs = scripts.iter().map(|script| match &script.study {
            Some(study) => self.study(graph, script, study),
            None => self.script(graph, script),
        });
        let module = module(&module_name, &graph.name, quote! { #program #(#runs)* });
        let tests = scripts.iter().map(|script| {
            let (test, run, docs) = (ident(&script.name), run(&script.name), &script.docs);
            let docs = (!docs.is_empty()).then(|| quote!(#[doc = #docs]));
            let ignored = script.study.is_some().then(|| quote!(#[ignore = "a study, which `apex tune` runs"]));
            quote! {
                #docs
                #[cfg(test)]
                #[test]
                #ignored
                fn #test() { #module_name::#run() }
            }
        });
        quote! {
            #[cfg(test)]
            #module
            #(#tests)*
        }
    }

    /// The function that runs the script of a test.
    fn script(&self, graph: &Graph, script: &Script) -> TokenStream {
        let (run, name, program) = (run(&script.name), &script.name, ident(&graph.name));
        let drains = self.drains(
            graph,
            script,
            |_, name| quote!(timeline.token(#name, &(&::apex_rt::shown::Shown(token)).shown());),
        );
        let steps = script.steps.iter().enumerate().map(|(number, step)| self.step(graph, number, step, false));
        // In the module its name hides no others.
        quote! {
            pub fn #run() {
                use ::apex_rt::shown::{ByDebug as _, ByType as _};
                let program = #program::new();
                let mut test = ::apex_rt::testing::Test::new(#name, program, |program, timeline| { #(#drains)* });
                #(#steps)*
                test.finish();
            }
        }
    }

    /// The function that serves the runs of a study.
    fn study(&self, graph: &Graph, script: &Script, study: &Study) -> TokenStream {
        let (name, program, count) = (&script.name, ident(&graph.name), study.goals.len());
        let drains = self.drains(graph, script, |node, _| {
            let goals = study.goals.iter().enumerate().filter(|(_, goal)| goal.of.probe == node);
            let goals = goals.map(|(i, goal)| {
                let seen = part_of_token(&goal.of);
                match goal.of.ty.without_unit().name() {
                    "Duration" => quote!(timeline.goal(#i, (*#seen).as_secs_f64());),
                    _ => quote!(timeline.goal(#i, *#seen as f64);),
                }
            });
            quote!(#(#goals)*)
        });
        let steps = script.steps.iter().enumerate().map(|(number, step)| self.step(graph, number, step, true));
        let vary = study.vary.iter().map(|varied| {
            let (targets, integer) = (&varied.targets, varied.integer);
            quote! { (&[#(#targets),*], #integer) }
        });
        let (seeds, recordings) = (&study.seed_params, &study.recordings);
        let required = study.required.iter().map(|test| {
            let function = ident(test);
            quote! { (#test, super::#function as fn()) }
        });
        let run = run(name);
        quote! {
            pub fn #run() {
                const STUDY: ::apex_rt::testing::Study = ::apex_rt::testing::Study {
                    vary: &[#(#vary),*],
                    seeds: &[#(#seeds),*],
                    recordings: &[#(#recordings),*],
                    required: &[#(#required),*],
                };
                ::apex_rt::testing::serve(&STUDY, #program::new, || {
                    let program = #program::new();
                    let drain = |program: &mut #program, timeline: &mut ::apex_rt::testing::Timeline| { #(#drains)* };
                    let mut test = ::apex_rt::testing::Test::of_study(#name, program, drain, #count);
                    #(#steps)*
                    test.goals()
                });
            }
        }
    }

    /// Code that takes the tokens out of each probe, and compares them with what the statements expect or forbid; a
    /// check has the number of its statement. `more` is done with each token besides. Probes inside the graph that
    /// only other tests of the program look at are emptied.
    fn drains(&self, graph: &Graph, script: &Script, more: impl Fn(NodeId, &str) -> TokenStream) -> Vec<TokenStream> {
        let mut numbers = 0..;
        let mut drain = |node: NodeId| {
            let (field, name, ports) = (self.probe(node), &graph.nodes[node].name, self.ports_of(graph, node));
            let tokens = quote!(#ports.outputs.#field.take());
            let checks = checks(script, node);
            let inside = name.strip_prefix("probe ");
            if checks.is_empty() && inside.is_some() && script.study.is_none() {
                return quote! { drop(#tokens); };
            }
            let checks = checks.values().zip(numbers.by_ref()).map(|(checks, number)| {
                let number = Literal::usize_unsuffixed(number);
                quote! { timeline.arrives(#number); #(#checks)* }
            });
            let more = more(node, inside.unwrap_or(name));
            quote! {
                for token in #tokens {
                    let token = &token;
                    #(#checks)*
                    #more
                }
            }
        };
        graph.nodes.ids().filter(|node| graph.nodes[*node].kind.is_probe()).map(&mut drain).collect()
    }

    fn step(&self, graph: &Graph, number: usize, step: &Step, repeats: bool) -> TokenStream {
        match step {
            Step::Feed { port, values, every, span } => {
                let (name, ty) = (ident(&graph.nodes[*port].name), &graph.nodes[*port].ports[0].ty);
                let values = values.iter().map(|value| constant(value, ty));
                let token = self.token_type(graph, PortId { node: *port, port: 0 });
                let every = match every {
                    Some(period) => {
                        let period = duration(*period);
                        quote!(Some(#period))
                    }
                    None => quote!(None),
                };
                let ports = self.ports_of(graph, *port);
                let (shown, place) = (&graph.nodes[*port].name, self.position(*span));
                quote! {
                    test.feed::<#token>(
                        (#shown, #place), &[#(#values),*], #every, |program, token| #ports.inputs.#name.put(token),
                    );
                }
            }
            Step::FeedRecorded { port, file, channel, span } => {
                let place = self.position(*span);
                self.feed_recorded(graph, *port, &place, file, channel, repeats)
            }
            Step::Wait(time) => {
                let time = duration(*time);
                quote! { test.wait(#time); }
            }
            Step::Expect(seen, until) => {
                let (text, place) = (&seen.text, self.position(seen.span));
                let until = match until {
                    Some(Until::By(time)) => {
                        let time = duration(*time);
                        quote!(Some(::apex_rt::testing::Until::By(#time)))
                    }
                    Some(Until::Within(time)) => {
                        let time = duration(*time);
                        quote!(Some(::apex_rt::testing::Until::Within(#time)))
                    }
                    None => quote!(None),
                };
                match self.observed_state(seen) {
                    Some(state) => quote! { test.expect_state(|program| #state, #until, #text, #place); },
                    None => quote! { test.expect(#number, #until, #text, #place); },
                }
            }
            Step::Never(seen) => {
                let (text, place) = (&seen.text, self.position(seen.span));
                match self.observed_state(seen) {
                    Some(state) => quote! { test.never_state(|program| #state, #text, #place); },
                    None => quote! { test.never(#number, #text, #place); },
                }
            }
        }
    }

    /// Feeds a recording. A script that is repeated, also with other recordings, reads each only once.
    fn feed_recorded(
        &self,
        graph: &Graph,
        port: NodeId,
        place: &str,
        file: &str,
        channel: &str,
        repeats: bool,
    ) -> TokenStream {
        if self.channels.is_none() {
            let message = format!("`recording(\"{file}\", …)` in a test needs the feature `record` of `apex-rt`");
            return quote! { ::core::compile_error!(#message); };
        }
        let (name, token) = (ident(&graph.nodes[port].name), self.token_type(graph, PortId { node: port, port: 0 }));
        let text = self.sources.get(graph.span.file).path.display().to_string();
        let ports = self.ports_of(graph, port);
        let frame = graph.nodes[port].ports[0].frame.as_ref().map(|frame| &frame.text);
        let in_frame = frame.map(|frame| quote!(.in_frame(#frame)));
        let read = |file: TokenStream| quote!(::apex_rt::record::tokens::<#token>(#text, #file, #channel, ::apex_rt::__codec!(#token)) #in_frame);
        let tokens = match repeats {
            true => {
                let read = read(quote!(file));
                quote!(::apex_rt::testing::recorded(#file, #channel, |file| #read))
            }
            false => read(quote!(#file)),
        };
        let shown = &graph.nodes[port].name;
        quote! {
            let tokens = #tokens;
            test.feed_at((#shown, #place), tokens, |program, token| #ports.inputs.#name.put(token));
        }
    }

    /// The state that is observed, as an expression; `None` if tokens are.
    fn observed_state(&self, seen: &Seen) -> Option<TokenStream> {
        match &seen.what {
            What::Active(Subject::Node(node)) => {
                let node = node.index();
                Some(quote!(::apex_rt::Program::is_active(program, #node)))
            }
            What::Active(Subject::Scope(scope)) => {
                let graph = scope.index() - 1;
                Some(quote!(::apex_rt::Program::is_graph_active(program, #graph)))
            }
            What::InState(machine, states) => {
                let first = self.names.states.get(machine)?;
                let states = states.iter().map(|state| first + state);
                Some(quote!([#(#states),*].iter().any(|state| ::apex_rt::Program::is_active(program, *state))))
            }
            What::Token(..) => None,
        }
    }
}

/// The function that runs a script, in the module of its program.
fn run(test: &str) -> Ident {
    format_ident!("run_{test}")
}

/// The checks of the tokens of a probe, by the field that they look at: each field is expected apart from the others.
fn checks(script: &Script, probe: NodeId) -> BTreeMap<&[String], Vec<TokenStream>> {
    let mut checks: BTreeMap<&[String], Vec<TokenStream>> = BTreeMap::new();
    for (check, step) in script.steps.iter().enumerate() {
        let (Step::Expect(seen, _) | Step::Never(seen)) = step else { continue };
        let What::Token(of, condition) = &seen.what else { continue };
        if of.probe != probe {
            continue;
        }
        let meets = quote!(timeline.meets(#check););
        checks.entry(&of.fields).or_default().push(match condition {
            None => meets,
            Some(condition) => {
                let (seen, condition) = (part_of_token(of), holds(condition, &of.ty));
                quote!(if { let token = #seen; #condition } { #meets })
            }
        });
    }
    checks
}

/// A reference to what is observed of `token`.
pub fn part_of_token(of: &Observed) -> TokenStream {
    let fields = of.fields.iter().map(|field| ident(field));
    if of.fields.is_empty() { quote!(token) } else { quote!((&token #(.#fields)*)) }
}
