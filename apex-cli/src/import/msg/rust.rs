//! Rust code of types: a module for each package, a struct for each message.

use super::{
    hash,
    parse::{Element, Field, Many, Role, Type},
    types::Types,
};
use crate::import::names;
use std::{collections::BTreeMap, fmt::Write as _};

/// Writes the modules of all own types.
pub fn write(types: &Types) -> Result<String, String> {
    let mut packages: BTreeMap<&str, String> = BTreeMap::new();
    for ty in types.own.values() {
        packages.entry(ty.package()).or_default().push_str(&one(ty, types)?);
    }
    let mut rust = String::from(
        "//! Messages of ROS 2, written by `apex import --msg`. Write them again instead of changing them.\n\
         extern crate alloc;\n\
         use ::apex_messages::{Action, Known, Message, Reason, Service, cdr::{Reader, Writer}};\n",
    );
    for (package, structs) in &packages {
        let _ = write!(
            rust,
            "/// Package `{package}`.\npub mod {} {{\nuse super::*;\n{structs}}}\n",
            names::snake(package)
        );
    }
    all(types, &mut rust)?;
    let file = syn::parse_file(&rust).map_err(|error| format!("the messages cannot be written as Rust: {error}"))?;
    Ok(prettyplease::unparse(&file))
}

/// Writes the table of all messages.
// Writing into a string cannot fail.
fn all(types: &Types, rust: &mut String) -> Result<(), String> {
    rust.push_str("/// All messages, in the order of their names.\npub const ALL: &[Known] = &[\n");
    for ty in types.own.values().filter(|ty| ty.role == Role::Message) {
        let path = path(&ty.name, types)?.replacen("super::", "", 1);
        let _ = writeln!(rust, "Known::of::<{path}>(),");
    }
    rust.push_str("];\n");
    Ok(())
}

fn one(ty: &Type, types: &Types) -> Result<String, String> {
    // Names the type if one of its parts is missing.
    types.parts(ty)?;
    match ty.role {
        Role::Message => message(ty, types),
        Role::Service => of_parts(ty, types, "Service", &[("Request", "_Request"), ("Response", "_Response")]),
        Role::Action => of_parts(
            ty,
            types,
            "Action",
            &[
                ("Goal", "_Goal"),
                ("Result", "_Result"),
                ("Feedback", "_Feedback"),
                ("SendGoal", "_SendGoal"),
                ("GetResult", "_GetResult"),
                ("FeedbackMessage", "_FeedbackMessage"),
            ],
        ),
        Role::Event => Ok(String::new()),
    }
}

/// Writes a service or an action.
fn of_parts(ty: &Type, types: &Types, role: &str, parts: &[(&str, &str)]) -> Result<String, String> {
    let (name, whole, hash) = (ty.rust_name(), &ty.name, hash::of(ty, types)?);
    let mut rust = format!(
        "/// `{whole}`.\n#[derive(Debug, Clone, Copy, PartialEq, Eq)]\npub struct {name};\n\
         impl {role} for {name} {{\nconst NAME: &'static str = \"{whole}\";\nconst HASH: &'static str = \"{hash}\";\n"
    );
    for (part, suffix) in parts {
        let _ = writeln!(rust, "type {part} = {};", path(&format!("{whole}{suffix}"), types)?);
    }
    rust.push_str("}\n");
    Ok(rust)
}

fn message(ty: &Type, types: &Types) -> Result<String, String> {
    let (name, whole) = (ty.rust_name(), &ty.name);
    let mut rust = format!("/// `{whole}`.\n#[derive(Debug, Clone, PartialEq)]\npub struct {name} {{\n");
    let (mut defaults, mut writes, mut reads) = (String::new(), String::new(), String::new());
    for field in &ty.fields {
        let ident = ident(&field.name);
        let _ = writeln!(rust, "pub {ident}: {},", rust_type(field, types)?);
        let _ = writeln!(defaults, "{ident}: {},", default(field, whole)?);
        writes.push_str(&write_field(field, &ident));
        let _ = writeln!(reads, "{ident}: {},", read_field(field));
    }
    rust.push_str("}\n");
    if !ty.constants.is_empty() {
        let _ = writeln!(rust, "impl {name} {{");
        for constant in &ty.constants {
            let value = constant.ty.value(&constant.value).unwrap_or_default();
            let text = constant.ty.rust().replace('&', "&'static ");
            let _ = writeln!(rust, "pub const {}: {text} = {value};", constant.name);
        }
        rust.push_str("}\n");
    }
    let (definition, hash) = (types.definition(ty)?, hash::of(ty, types)?);
    // The byte of a message without fields.
    let (empty_write, empty_read) =
        if ty.fields.is_empty() { ("to.number(0_u8);", "from.empty()?;") } else { ("", "") };
    // Stamps and frames may be others outside of the program.
    let (write, read) = if whole == "std_msgs/msg/Header" {
        let writes = writes.replace("self.", "header.");
        let read = format!("from.number_of_header()?; let header = Self {{ {reads} }}; Ok(from.incoming(header))");
        (format!("let header = to.outgoing(self); {writes}"), read)
    } else {
        (format!("{writes} {empty_write}"), format!("{empty_read} Ok(Self {{ {reads} }})"))
    };
    // Inlined functions are compiled where they are used: a program uses few of the messages.
    let _ = write!(
        rust,
        "impl Default for {name} {{\n#[inline] fn default() -> Self {{ Self {{ {defaults} }} }}\n}}\n\
         impl Message for {name} {{\n\
         const NAME: &'static str = \"{whole}\";\n\
         const DEFINITION: &'static str = {definition:?};\n\
         const HASH: &'static str = \"{hash}\";\n\
         #[inline] fn write(&self, to: &mut Writer<'_>) {{ {write} }}\n\
         #[inline] fn read(from: &mut Reader<'_>) -> Result<Self, Reason> {{ {read} }}\n}}\n"
    );
    Ok(rust)
}

/// Name of a field in Rust.
fn ident(name: &str) -> String {
    match name {
        "self" | "super" | "crate" | "Self" => format!("{name}_"),
        name if syn::parse_str::<syn::Ident>(name).is_err() => format!("r#{name}"),
        name => name.to_owned(),
    }
}

/// Path of a struct from the module of a package.
fn path(name: &str, types: &Types) -> Result<String, String> {
    let ty = types.get(name)?;
    let root = if types.own.contains_key(name) { "super" } else { "::apex_messages" };
    Ok(format!("{root}::{}::{}", names::snake(ty.package()), ty.rust_name()))
}

fn rust_type(field: &Field, types: &Types) -> Result<String, String> {
    let element = match &field.element {
        Element::Plain(plain) => plain.rust().to_owned(),
        Element::Text(_) => "alloc::string::String".to_owned(),
        Element::Message(name) => path(name, types)?,
    };
    Ok(match field.many {
        Many::One => element,
        Many::Array(count) => format!("[{element}; {count}]"),
        Many::List(_) => format!("alloc::vec::Vec<{element}>"),
    })
}

/// Value of a field by default.
fn default(field: &Field, whole: &str) -> Result<String, String> {
    let Some(value) = &field.default else {
        return Ok(match (field.many, &field.element) {
            (Many::Array(count), Element::Plain(plain)) => {
                format!("[{}; {count}]", plain.value("0").unwrap_or_default())
            }
            (Many::Array(_), _) => "core::array::from_fn(|_| Default::default())".to_owned(),
            _ => "Default::default()".to_owned(),
        });
    };
    let wrong = || format!("`{whole}`: the default of `{}` is `{value}`, which is not a value of its type", field.name);
    let one = |text: &str| match &field.element {
        Element::Plain(plain) => plain.value(text).ok_or_else(wrong),
        Element::Text(_) => Ok(format!("alloc::string::String::from({:?})", text.trim_matches(['"', '\'']))),
        Element::Message(_) => Err(wrong()),
    };
    match field.many {
        Many::One => one(value),
        Many::Array(_) | Many::List(_) => {
            let list = value.strip_prefix('[').and_then(|list| list.strip_suffix(']')).ok_or_else(wrong)?;
            let values = list.split(',').map(str::trim).filter(|value| !value.is_empty()).map(one);
            let values = values.collect::<Result<Vec<_>, _>>()?;
            let is_right = match field.many {
                Many::Array(count) => values.len() == count,
                Many::List(most) => most.is_none_or(|most| values.len() <= most),
                Many::One => true,
            };
            let vec = if matches!(field.many, Many::List(_)) { "alloc::vec!" } else { "" };
            if is_right { Ok(format!("{vec}[{}]", values.join(", "))) } else { Err(wrong()) }
        }
    }
}

fn write_field(field: &Field, ident: &str) -> String {
    let is_list = matches!(field.many, Many::List(_));
    let length = if is_list { format!("to.length(self.{ident}.len());") } else { String::new() };
    let one = |value: &str| match &field.element {
        Element::Plain(_) => format!("to.number({value});"),
        Element::Text(_) => format!("to.text(&{value});"),
        Element::Message(_) => format!("Message::write(&{value}, to);"),
    };
    match (field.many, &field.element) {
        (Many::One, _) => one(&format!("self.{ident}")),
        (_, Element::Plain(_)) => format!("{length}to.numbers(&self.{ident});"),
        (_, Element::Text(_)) => format!("{length}for element in &self.{ident} {{ to.text(element); }}"),
        (_, Element::Message(_)) => format!("{length}for element in &self.{ident} {{ Message::write(element, to); }}"),
    }
}

fn read_field(field: &Field) -> String {
    let most = |most: Option<usize>| most.map_or_else(|| "usize::MAX".to_owned(), |most| most.to_string());
    let one = match &field.element {
        Element::Plain(_) => "from.number()".to_owned(),
        Element::Text(bound) => format!("from.text_of({})", most(*bound)),
        Element::Message(_) => "Message::read(from)".to_owned(),
    };
    match (field.many, &field.element) {
        (Many::One, _) => format!("{one}?"),
        (Many::Array(_), Element::Plain(_)) => "from.array()?".to_owned(),
        (Many::Array(_), _) => format!("from.array_of(|from| {one})?"),
        (Many::List(bound), Element::Plain(_)) => format!("from.list({})?", most(bound)),
        (Many::List(bound), _) => format!("from.list_of({}, |from| {one})?", most(bound)),
    }
}

#[cfg(test)]
mod tests {
    use super::{super::parse::Plain, *};

    #[test]
    fn names_that_rust_reserves_are_raw() {
        assert_eq!(["type", "x", "self", "match"].map(ident), ["r#type", "x", "self_", "r#match"]);
    }

    #[test]
    fn defaults_are_those_of_their_types() {
        let field =
            |element, many, value: &str| Field { name: "f".to_owned(), element, many, default: Some(value.to_owned()) };
        let number = |many, value| default(&field(Element::Plain(Plain::U8), many, value), "p/msg/M");
        assert_eq!(number(Many::One, "255"), Ok("255".to_owned()));
        assert!(number(Many::One, "256").is_err_and(|why| why.contains("`p/msg/M`: the default of `f` is `256`")));
        assert_eq!(number(Many::Array(2), "[1, 2]"), Ok("[1, 2]".to_owned()));
        assert!(number(Many::Array(2), "[1]").is_err() && number(Many::List(Some(1)), "[1, 2]").is_err());
        let text = default(&field(Element::Text(None), Many::One, "\"a b\""), "p/msg/M");
        assert_eq!(text, Ok("alloc::string::String::from(\"a b\")".to_owned()));
    }
}
