//! Rust nodes of many forms, visible or hidden in many ways. Those whose types allow it can run: they pass on what they
//! get.

use super::{
    interface::{Node, port},
    kinds::Kind,
    maker::Maker,
    names::KEYWORDS,
    types::Type,
};

/// Form of a node. `{N}` is its name, `{T}` the type of its tokens, `{P}` that of its parameter with `{D}` as its
/// default; `{I} {O} {S} {E}` are an input, an output, a slot and an event, and `⟨…⟩` are bodies. Characters after
/// the name select its ports.
struct Shape {
    name: &'static str,
    ports: &'static str,
    text: &'static str,
}

const fn shape(name: &'static str, ports: &'static str, text: &'static str) -> Shape {
    Shape { name, ports, text }
}

const STATE: &str = "{#}\n#[derive(Default)]\n{V}struct {N} {\n    last: Option<u8>,\n}\n\n{#}\nimpl {N} {\n";

const SHAPES: &[Shape] = &[
    shape("pass", "io", "{#}\n{V}fn {N}({I}: &{T}) -> {T} {\n    ⟨::core::clone::Clone::clone({I})⟩\n}"),
    shape(
        "maybe",
        "io",
        "{#}\n{V}fn {N}({I}: &{T}) -> Option<{T}> {\n    ⟨::core::option::Option::Some(::core::clone::Clone::clone({I}))⟩\n}",
    ),
    shape("join", "i2o", "{#}\n{V}fn {N}({I}: &{T}, second: &{T}) -> {T} {\n    ⟨::core::clone::Clone::clone({I})⟩\n}"),
    shape(
        "optional",
        "io",
        "{#}\n{V}fn {N}({I}: &{T}, second: Option<&{T}>) -> {T} {\n    ⟨::core::clone::Clone::clone({I})⟩\n}",
    ),
    shape(
        "written",
        "iO",
        "{#}\n{V}fn {N}({I}: &{T}, {O}: &mut Out<{T}>) {\n    ⟨{O}.set(::core::clone::Clone::clone({I}))⟩\n}",
    ),
    shape(
        "event",
        "ie",
        "{#}\n{V}fn {N}({I}: &{T}, {E}: Event<{T}>) {\n    ⟨{E}.emit(::core::clone::Clone::clone({I}))⟩\n}",
    ),
    shape(
        "fallible",
        "io",
        "{#}\n{V}fn {N}({I}: &{T}) -> Result<{T}, String> {\n    ⟨::core::result::Result::Ok(::core::clone::Clone::clone({I}))⟩\n}",
    ),
    shape("ctx", "io", "{#}\n{V}fn {N}(context: &Ctx, {I}: &{T}) -> {T} {\n    ⟨::core::clone::Clone::clone({I})⟩\n}"),
    shape("sink", "i", "{#}\n{V}fn {N}({I}: &{T}) {\n    ⟨()⟩\n}"),
    shape(
        "tuned",
        "iop",
        "{#}\n{V}fn {N}({I}: &{T}, #[param(default = {D})] level: {P}) -> {T} {\n    ⟨::core::clone::Clone::clone({I})⟩\n}",
    ),
    shape(
        "Split",
        "iSplit",
        "{#}\n{V}fn {N}({I}: &{T}) -> {N}Both {\n    ⟨{N}Both { {O}: ::core::clone::Clone::clone({I}), other: ::core::option::Option::None }⟩\n}\n\n#[derive(Outputs)]\npub struct {N}Both {\n    pub {O}: {T},\n    pub other: Option<{T}>,\n}",
    ),
    shape("Ordered", "i2o", "{#}\n{V}fn {N}<T: PartialOrd>({I}: &T, second: &T) -> T {\n    loop {}\n}"),
    shape("Generic", "iog", "{#}\n{V}fn {N}<T: Clone>({I}: &T) -> T {\n    ⟨::core::clone::Clone::clone({I})⟩\n}"),
    shape(
        "Summed",
        "i2o",
        "{#}\n{V}fn {N}<T: std::ops::Add<Output = T> + Copy>({I}: &T, second: &T) -> T {\n    loop {}\n}",
    ),
    shape("Fixed", "io", "{#}\n{V}fn {N}<T: Copy + Into<f64>>({I}: &T) -> {T} {\n    loop {}\n}"),
    shape("Sized", "io", "{#}\n{V}fn {N}<const N: usize>({I}: &{T}) -> {T} {\n    loop {}\n}"),
    shape(
        "Holder",
        "sE",
        "{#}\n#[derive(Default)]\n{V}struct {N}<T> {\n    last: Option<T>,\n}\n\n{#}\nimpl<T: Clone> {N}<T> {\n    #[slot]\n    fn {S}(&mut self, token: &T, {E}: Event<T>) {\n        ⟨{E}.emit(::core::clone::Clone::clone(token))⟩\n    }\n}",
    ),
    shape(
        "Ring",
        "io",
        "{#}\n{V}struct {N}<const N: usize> {\n    last: [u8; N],\n}\n\n{#}\nimpl<const N: usize> {N}<N> {\n    fn process(&mut self, {I}: &{T}) -> {T} {\n        loop {}\n    }\n}",
    ),
    shape(
        "Fresh",
        "io",
        "{#}\n{V}struct {N} {\n    last: {T},\n}\n\n{#}\nimpl {N} {\n    fn process(&mut self, {I}: &{T}) -> {T} {\n        loop {}\n    }\n}",
    ),
    shape(
        "Keeper",
        "io",
        "{STATE}    fn process(&mut self, {I}: &{T}) -> {T} {\n        ⟨::core::clone::Clone::clone({I})⟩\n    }\n}",
    ),
    shape(
        "Taker",
        "sE",
        "{STATE}    #[slot]\n    fn {S}(&mut self, token: &{T}, {E}: Event<{T}>) {\n        ⟨{E}.emit(::core::clone::Clone::clone(token))⟩\n    }\n}",
    ),
    shape(
        "Fails",
        "sE",
        "{STATE}    #[slot]\n    fn {S}(&mut self, token: &{T}, {E}: Event<{T}>, context: &Ctx) -> Result<(), String> {\n        ⟨{E}.emit(::core::clone::Clone::clone(token));\n        ::core::result::Result::Ok(())⟩\n    }\n}",
    ),
    shape(
        "Latest",
        "so",
        "{STATE}    fn process(&mut self) -> Option<{T}> {\n        ⟨::core::option::Option::None⟩\n    }\n    #[slot]\n    fn {S}(&mut self, token: &{T}) {\n        ⟨()⟩\n    }\n}",
    ),
    shape(
        "Source",
        "o",
        "{STATE}    fn process(&mut self) -> {T} {\n        ⟨::core::default::Default::default()⟩\n    }\n}",
    ),
    shape(
        "Begins",
        "ioe",
        "{STATE}    fn process(&mut self, {I}: &{T}, {E}: Event<{T}>) -> {T} {\n        ⟨{E}.emit(::core::clone::Clone::clone({I}));\n        ::core::clone::Clone::clone({I})⟩\n    }\n    #[on_activate]\n    fn begin(&mut self) {}\n    #[on_deactivate]\n    fn end(&mut self) {}\n    #[no_message]\n    fn nothing(&mut self) {}\n}",
    ),
    shape(
        "Tuned",
        "iop",
        "{#}\n{V}struct {N} {\n    #[param(default = {D})]\n    level: {P},\n    last: Option<u8>,\n}\n\n{#}\nimpl {N} {\n    fn process(&mut self, {I}: &{T}) -> {T} {\n        ⟨::core::clone::Clone::clone({I})⟩\n    }\n}",
    ),
    shape(
        "Bound",
        "iop",
        "{#}\n{V}struct {N} {\n    #[param]\n    level: {P},\n}\n\n{#}\nimpl {N} {\n    fn process(&mut self, {I}: &{T}) -> {T} {\n        ⟨::core::clone::Clone::clone({I})⟩\n    }\n}",
    ),
    shape("pair", "io", "{#}\n{V}fn {N}({I}: &[{T}; 2]) -> {T} {\n    ⟨::core::clone::Clone::clone(&{I}[0])⟩\n}"),
    shape(
        "several",
        "io",
        "{#}\n{V}fn {N}<const COUNT: usize>({I}: [&{T}; COUNT]) -> {T} {\n    ⟨::core::clone::Clone::clone({I}[0])⟩\n}",
    ),
    shape(
        "Several",
        "i2o",
        "{STATE}    fn process<const COUNT: usize>(&mut self, second: &{T}, {I}: [Option<&{T}>; COUNT]) -> {T} {\n        ⟨::core::clone::Clone::clone(second)⟩\n    }\n}",
    ),
    shape(
        "double",
        "io",
        "{#}\n{V}fn {N}({I}: &{T}) -> [{T}; 2] {\n    ⟨[::core::clone::Clone::clone({I}), ::core::clone::Clone::clone({I})]⟩\n}",
    ),
];

/// A node with its bodies, or with those that never end if its type has no copies.
fn bodies(text: &str, can_run: bool) -> String {
    if can_run {
        return text.replace(['⟨', '⟩'], "");
    }
    let mut parts = text.split('⟨');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.filter_map(|part| part.split_once('⟩')).fold(first, |text, (_, rest)| text + "loop {}" + rest)
}

/// Forms whose types only rustc can check.
const BOUND: [&str; 8] = ["Ordered", "Generic", "Summed", "Fixed", "Sized", "Holder", "Ring", "Fresh"];

impl Maker {
    /// A node that takes (or, for a source, sends) tokens of this type, either existing or new.
    pub fn node(&mut self, ty: &'static Type) -> Node {
        let known: Vec<Node> = self.nodes.iter().filter(|n| n.takes(ty) && !n.has_rates()).cloned().collect();
        if !known.is_empty() && self.dice.one_in(2) {
            return self.dice.of(&known).clone();
        }
        let bound = self.strikes(Kind::Bounds, 2);
        let tuned = self.has(Kind::Values) || self.has(Kind::Constants);
        let name = match () {
            () if bound => *self.dice.of(&BOUND),
            () if tuned && self.dice.one_in(2) => *self.dice.of(&["tuned", "Tuned", "Bound"]),
            () => loop {
                let name = self.dice.of(SHAPES).name;
                let rate = matches!(name, "pair" | "double") && !self.dice.one_in(20);
                if !rate && (!BOUND.contains(&name) || name == "Generic" || name == "Holder") {
                    break name;
                }
            },
        };
        self.node_of(name, ty)
    }

    /// A source of tokens of this type.
    pub fn source(&mut self, ty: &'static Type) -> Node {
        self.node_of("Source", ty)
    }

    /// A new node of a form.
    pub fn node_of(&mut self, shape: &str, ty: &'static Type) -> Node {
        let shape = SHAPES.iter().find(|s| s.name == shape).unwrap_or(&SHAPES[0]);
        let mut name = format!("{}{}", shape.name, self.number());
        if self.strikes(Kind::RustNames, 3) {
            let odd = ["Node", "ArmNodes", "RobotState", "State", "react", "new", "nodes", "drop", "Some_", "tokens"];
            let odd = (*self.dice.of(&odd)).to_owned();
            if !self.nodes.iter().any(|n| n.name == odd) && !self.taken.contains(&odd) {
                name = odd;
            }
        }
        let [input, output, slot, event] = self.node_ports();
        let param = self.param_type();
        let ports = shape.ports;
        let has = |sign: char| ports.contains(sign);
        let ports_of = |on: bool, name: &str| if on { vec![port(name, ty)] } else { vec![] };
        let mut inputs = ports_of(has('i'), &input);
        if has('2') {
            inputs.push(port("second", ty));
        }
        let outputs = match ports {
            "iSplit" => vec![port(&output, ty), port("other", ty)],
            "iO" => vec![port(&output, ty)],
            _ => ports_of(has('o'), "out"),
        };
        let mut node = Node {
            name: name.clone(),
            generic: has('g').then(|| ty.name.to_owned()),
            inputs,
            outputs,
            slots: ports_of(has('s') && ports != "iSplit", &slot),
            events: ports_of((has('e') || has('E')) && ports != "iSplit", &event),
            params: vec![],
        };
        self.rust(ty.item);
        let mut text = shape.text.replace("{STATE}", STATE);
        if has('p') && ports != "iSplit" {
            self.rust(param.item);
            node.params.push(("level".to_owned(), param));
            text = text.replace("{P}", param.ty).replace("{D}", param.default);
        }
        text = text.replace("{N}", &name).replace("{T}", ty.name);
        for (sign, name) in [("{I}", &input), ("{O}", &output), ("{S}", &slot), ("{E}", &event)] {
            text = text.replace(sign, name);
        }
        let can_run = ty.clone && (ty.default || !text.contains("Default::default()"));
        let text = self.disguised(bodies(&text, can_run), &mut node);
        self.rust.push(text);
        self.nodes.push(node.clone());
        node
    }

    /// Names of an input, an output, a slot and an event.
    fn node_ports(&mut self) -> [String; 4] {
        let mut names = ["x", "y", "put", "done"].map(str::to_owned);
        if self.strikes(Kind::PortNames, 2) {
            let at = self.dice.below(4);
            let odd = [
                "ctx", "nodes", "state", "observer", "token", "inputs", "now", "made", "failed", "enable", "timeout",
                "tokens", "out", "disable", "late", "start", "_x", "events", "program", "O", "start_", "level", "a_b",
                "match_",
            ];
            names[at] = match self.dice.below(3) {
                0 => format!("r#{}", self.dice.of(KEYWORDS)),
                _ => (*self.dice.of(&odd)).to_owned(),
            };
            // Names of arguments and methods must be unique.
            let is_item = self.taken.contains(&names[at]);
            if is_item || names.iter().filter(|n| **n == names[at]).count() > 1 {
                names[at] = format!("other_{at}");
            }
        }
        names
    }

    /// Code of a node in the crate, with random visibility and attributes.
    fn disguised(&mut self, text: String, node: &mut Node) -> String {
        let mut mark = "#[node]".to_owned();
        if self.strikes(Kind::Attributes, 2) {
            let marks = [
                "#[apex_rt::node]",
                "#[::apex_rt::node]",
                "#[::apex_rt::prelude::node]",
                "#[node]\n#[deprecated]",
                "#[allow(unused)]\n#[node]",
                "#[cfg_attr(all(), node)]",
                "#[cfg_attr(any(), windows)]\n#[node]",
                "#[doc(hidden)]\n#[node]",
            ];
            mark = (*self.dice.of(&marks)).to_owned();
        }
        if self.strikes(Kind::Cfg, 2) {
            let marks = [
                "windows",
                "not(windows)",
                "unix",
                "not(unix)",
                "feature = \"fast\"",
                "not(feature = \"fast\")",
                "any(unix, windows)",
                "all(unix, windows)",
                "debug_assertions",
                "not(debug_assertions)",
                "target_pointer_width = \"64\"",
                "target_os = \"linux\"",
                "not(target_os = \"none\")",
                "unknown_thing",
                "not(unknown_thing)",
                "panic = \"unwind\"",
                "all()",
                "any()",
                "not(any())",
                "target_family = \"wasm\"",
                "doc",
                "not(doc)",
                "target_has_atomic = \"64\"",
            ];
            mark = format!("#[cfg({})]\n{mark}", self.dice.of(&marks));
        }
        let mut visible = "pub ".to_owned();
        let hides = self.strikes(Kind::Visibility, 2);
        if hides {
            visible = (*self.dice.of(&["", "", "pub(crate) ", "pub(self) ", "pub(in crate) ", "pub "])).to_owned();
        }
        if self.strikes(Kind::Attributes, 4) && text.contains("{V}fn") {
            // What a node passes on is copied, which a `const fn` cannot do.
            let form = self.word(&["unsafe ", "const "]);
            visible.push_str(if text.contains("loop {}") { form } else { "unsafe " });
        }
        let text = text.replace("{#}", &mark).replace("{V}", &visible);
        if hides && self.dice.one_in(2) { self.in_module(&text, node) } else { text }
    }

    /// Moves a node into a module, which the source file names or not.
    fn in_module(&mut self, text: &str, node: &mut Node) -> String {
        let module = format!("place{}", self.number());
        let name = node.name.clone();
        let open = *self.dice.of(&["pub mod", "mod", "pub(crate) mod"]);
        let indented = text.replace('\n', "\n    ");
        let module_text = format!("{open} {module} {{\n    use super::*;\n    {indented}\n}}");
        match self.dice.below(6) {
            0 => {
                node.name = format!("crate::{module}::{name}");
                module_text
            }
            1 if text.contains("pub ") => format!("{module_text}\npub use {module}::{name};"),
            2 if text.contains("pub ") => {
                node.name = format!("{name}_again");
                format!("{module_text}\npub use {module}::{name} as {name}_again;")
            }
            3 if text.contains("pub ") => format!("{module_text}\npub use {module}::*;"),
            4 => format!("pub fn {module}_around() {{\n    {indented}\n}}"),
            _ => module_text,
        }
    }
}

/// Forms with fields that are not parameters.
const STATEFUL: [&str; 11] =
    ["Holder", "Ring", "Fresh", "Keeper", "Taker", "Fails", "Latest", "Source", "Begins", "Tuned", "apex_nodes::flow"];

impl Node {
    /// `true` if it has a state.
    pub fn has_state(&self) -> bool {
        STATEFUL.iter().any(|shape| self.name.starts_with(shape))
    }

    /// `true` if it takes or sends several tokens per firing.
    fn has_rates(&self) -> bool {
        self.name.starts_with("pair") || self.name.starts_with("double")
    }
}
