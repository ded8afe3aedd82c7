//! Rust skeletons of the node types that the library lacks: ports and parameters, without behaviour.

use super::{
    graph::{Graph, Param},
    known,
    known::{MESSAGE, NOTE},
    names,
    ports::{Kind, Port},
    text,
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write as _,
};

/// Signature of a type, collected from all its nodes.
#[derive(Default)]
pub struct Type<'a> {
    params: BTreeMap<String, &'a Param>,
    /// For each input, `true` if it is connected in all nodes.
    inputs: BTreeMap<String, bool>,
    outputs: BTreeSet<String>,
    slots: BTreeSet<String>,
    events: BTreeSet<String>,
}

/// Types that are not in the library.
pub fn types(top: &Graph) -> BTreeMap<&str, Type<'_>> {
    let mut types: BTreeMap<&str, Type<'_>> = BTreeMap::new();
    text::visit(top, &mut |graph| {
        for (node, ports) in graph.nodes.iter().zip(graph.connected()) {
            if node.graph.is_some() || node.ty == NOTE || known::find(&node.ty).is_some() {
                continue;
            }
            let is_new = !types.contains_key(&*node.ty);
            let ty = types.entry(&node.ty).or_default();
            for (name, param) in &node.params {
                ty.params.entry(name.clone()).or_insert(param);
            }
            let named = ports.into_iter().filter(|p| p.common().is_none()).map(|p| (p, text::port_name(node, p)));
            ty.add(named.collect(), is_new);
        }
    });
    types
}

impl Type<'_> {
    /// Adds the connected ports of one node.
    fn add(&mut self, ports: Vec<(&Port, String)>, is_first: bool) {
        let connected: BTreeSet<&String> = ports.iter().map(|(_, name)| name).collect();
        for (name, mandatory) in &mut self.inputs {
            *mandatory &= connected.contains(name);
        }
        for (port, name) in ports {
            let (Port::Number(kind, _) | Port::Param(kind, _)) = port;
            match kind {
                // The port of a parameter is part of the parameter.
                Kind::In if self.params.contains_key(&name) => {}
                Kind::In => drop(self.inputs.entry(name).or_insert(is_first)),
                Kind::Out => drop(self.outputs.insert(name)),
                Kind::Slot => drop(self.slots.insert(name)),
                Kind::Event => drop(self.events.insert(name)),
            }
        }
    }

    // Writing into a string cannot fail.
    fn write(&self, ty: &str, rust: &mut String) {
        let name = names::camel(ty);
        let _ = writeln!(rust, "/// Placeholder for `{}`: takes all tokens and sends none.", one_line(ty));
        rust.push_str("#[node]\n");
        if self.params.is_empty() {
            let _ = writeln!(rust, "#[derive(Default)]\npub struct {name};");
        } else {
            let _ = writeln!(rust, "pub struct {name} {{");
            for (name, param) in &self.params {
                let (ty, default) = rust_value(param);
                let _ = writeln!(rust, "#[param(default = {default})]\npub {name}: {ty},");
            }
            rust.push_str("}\n");
        }
        let _ = writeln!(rust, "#[node]\nimpl {name} {{");
        // Events are arguments of the functions that can trigger them.
        let has_process = !self.inputs.is_empty() || !self.outputs.is_empty() || self.slots.is_empty();
        if has_process {
            self.method("process", &self.process_arguments(), rust);
        }
        for (index, slot) in self.slots.iter().enumerate() {
            let mut arguments = vec![("token".to_owned(), format!("&{MESSAGE}"))];
            arguments.extend(self.event_arguments().filter(|_| index == 0 && !has_process));
            rust.push_str("#[slot]\n");
            self.method(slot, &arguments, rust);
        }
        rust.push_str("}\n");
    }

    fn process_arguments(&self) -> Vec<(String, String)> {
        let input = |(name, mandatory): (&String, &bool)| {
            (name.clone(), if *mandatory { format!("&{MESSAGE}") } else { format!("Option<&{MESSAGE}>") })
        };
        let outputs = self.outputs.iter().map(|name| (name.clone(), format!("&mut Out<{MESSAGE}>")));
        self.inputs.iter().map(input).chain(outputs).chain(self.event_arguments()).collect()
    }

    fn event_arguments(&self) -> impl Iterator<Item = (String, String)> {
        self.events.iter().map(|name| (name.clone(), format!("Event<{MESSAGE}>")))
    }

    fn method(&self, name: &str, arguments: &[(String, String)], rust: &mut String) {
        let list: Vec<String> = arguments.iter().map(|(name, ty)| format!("{name}: {ty}")).collect();
        let names: Vec<&str> = arguments.iter().map(|(name, _)| name.as_str()).collect();
        let body = match names.as_slice() {
            [] => String::new(),
            [only] => format!("let _ = {only};"),
            names => format!("let _ = ({});", names.join(", ")),
        };
        let _ = writeln!(rust, "fn {name}(&mut self, {}) {{ {body} }}", list.join(", "));
    }
}

/// Type and default of a parameter in Rust.
fn rust_value(param: &Param) -> (String, String) {
    match param {
        Param::Int(value) => ("i64".to_owned(), value.to_string()),
        Param::Float(value) => ("f64".to_owned(), format!("{value:?}")),
        Param::Bool(value) => ("bool".to_owned(), value.to_string()),
        Param::Text(value) => ("String".to_owned(), format!("String::from({value:?})")),
        Param::List(values) => {
            let ty = match values[..] {
                [Param::Text(_), ..] => "&'static str",
                [Param::Float(_), ..] => "f64",
                [Param::Bool(_), ..] => "bool",
                _ => "i64",
            };
            (format!("&'static [{ty}]"), format!("&{}", text::value(param)))
        }
        Param::None => ("i64".to_owned(), "0".to_owned()),
    }
}

fn one_line(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}

/// The Rust file.
pub fn write(top: &Graph) -> Result<String, String> {
    let mut rust = format!(
        "//! Nodes of a graph of CS::APEX, to be completed. Ports have the type `{MESSAGE}` until you give them others.\n\
         use apex_rt::prelude::*;\n\n\
         /// Type of the ports whose types are not known yet.\n\
         #[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]\npub struct {MESSAGE};\n"
    );
    for (ty, shown) in types(top) {
        rust.push('\n');
        shown.write(ty, &mut rust);
    }
    let file = syn::parse_file(&rust).map_err(|e| format!("the nodes cannot be written as Rust: {e}"))?;
    // `prettyplease` puts no empty lines between items.
    let rust = prettyplease::unparse(&file);
    Ok(rust.replace("\n///", "\n\n///").replace("\n#[node]\nimpl", "\n\n#[node]\nimpl"))
}
