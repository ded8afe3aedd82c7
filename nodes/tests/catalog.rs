//! Agreement of the catalog with rustc: `library.afg` uses every node of the library as described by the catalog, and
//! is compiled here. `APEX_UPDATE_EXPECTATIONS=1` writes it again.

use apex_dsl::catalog::{Catalog, Signature, Type};
use apex_host::{Disk, Seen, Workspace};
use std::{fmt::Write as _, fs, path::Path};

mod programs {
    #![allow(missing_docs)]
    apex_macros::graph!("library.afg");
}

/// Type for the type parameters of a node: a time for those that need a stamp.
fn argument(signature: &Signature) -> &'static str {
    if signature.bounds.iter().any(|bound| bound.contains("Stamped")) { "apex_rt::Time" } else { "f64" }
}

/// Type as spelled in a source file, with `argument` for type parameters.
fn spell(ty: &Type, argument: &str, catalog: &Catalog) -> Option<String> {
    let all = |types: &[Type]| {
        let types = types.iter().map(|t| spell(t, argument, catalog)).collect::<Option<Vec<_>>>();
        types.map(|types| types.join(", "))
    };
    let with =
        |name: String, args: &[Type]| Some(if args.is_empty() { name } else { format!("{name}<{}>", all(args)?) });
    match ty {
        Type::Primitive(name) => Some(name.clone()),
        Type::Param(_) => Some(argument.to_owned()),
        Type::Named(name, args) => with(name.clone(), args),
        Type::Def(def, _, args) => with(catalog.path(*def)?.join("::").trim_start_matches("::").to_owned(), args),
        Type::Alias(def, ..) => Some(catalog.path(*def)?.join("::").trim_start_matches("::").to_owned()),
        Type::Tuple(parts) => all(parts).map(|parts| format!("({parts})")),
        Type::Unknown(number) if number.parse::<u64>().is_ok() => Some(number.clone()),
        Type::Measured(number, unit) => Some(format!("{}[{unit}]", spell(number, argument, catalog)?)),
        Type::Array(..) | Type::Ref(_) | Type::Unknown(_) => None,
    }
}

/// A valid value for a parameter without a default.
fn value(ty: &Type, unit: &str) -> String {
    match ty {
        Type::Ref(inner) if matches!(&**inner, Type::Primitive(name) if name == "str") => "\"file.csv\"".to_owned(),
        Type::Ref(inner) => value(inner, unit),
        Type::Array(element, len) => {
            let count = len.as_ref().and_then(|n| n.parse().ok()).unwrap_or(1);
            format!("[{}]", vec![value(element, unit); count].join(", "))
        }
        Type::Named(name, _) if name == "String" => "\"file.csv\"".to_owned(),
        _ => match ty.name() {
            "bool" => "true".to_owned(),
            "f32" | "f64" => format!("1{unit}"),
            "Articulated" => "apex_nodes::nav::Articulated::PATSY".to_owned(),
            _ => "1".to_owned(),
        },
    }
}

/// A graph with this node only, with all its ports and parameters in use.
fn graph(number: usize, signature: &Signature, catalog: &Catalog) -> String {
    use apex_dsl::syntax::tree::PortKind;
    let path = signature.path.join("::");
    let argument = argument(signature);
    let types = if signature.generics.is_empty() {
        String::new()
    } else {
        format!("<{}>", vec![argument; signature.generics.len()].join(", "))
    };
    let params = signature.params.iter().filter(|p| p.default.is_none());
    let params: Vec<String> =
        params.map(|p| format!("{} = {}", p.name, value(&p.ty, p.unit.as_deref().unwrap_or_default()))).collect();
    let mut text = format!(
        "graph Use{number} {{\n    node it = {}{types}({});\n",
        path.trim_start_matches("::"),
        params.join(", ")
    );
    for port in &signature.ports {
        let Some(ty) = spell(&port.ty, argument, catalog) else { continue };
        let (name, id) = (&port.name, format!("{}_{}", port.kind.word(), port.name));
        let _ = match port.kind {
            PortKind::Input if port.any_number => {
                writeln!(text, "    in {id}: {ty};\n    in {id}_2: {ty};\n    [{id}, {id}_2] -> it.{name};")
            }
            PortKind::Input => writeln!(text, "    in {id}: {ty};\n    {id} -> it.{name};"),
            PortKind::Output => writeln!(text, "    out {id}: {ty};\n    it.{name} -> {id};"),
            PortKind::Slot => writeln!(text, "    slot {id}: {ty};\n    {id} -> it.{name};"),
            PortKind::Event => writeln!(text, "    event {id}: {ty};\n    it.{name} -> {id};"),
        };
    }
    text.push_str("}\n");
    text
}

#[test]
fn every_node_of_the_library_is_used() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = Workspace::load(folder).expect("cargo knows the package");
    let catalog = Catalog::load(workspace.crates(&Seen::Crate("catalog", false)), &mut Disk::new(None));
    let library: Vec<&Signature> =
        catalog.signatures.iter().filter(|s| s.path.get(1).is_some_and(|krate| krate == "apex_nodes")).collect();
    assert!(library.len() > 50, "only {} nodes were found", library.len());
    let mut text = "//! Every node of the library. Written by the test `catalog`.\n".to_owned();
    for (number, signature) in library.into_iter().enumerate() {
        let _ = write!(text, "\n{}", graph(number, signature, &catalog));
    }
    let file = folder.join("tests/library.afg");
    if std::env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(&file, &text).expect("the file can be written");
    }
    assert_eq!(
        fs::read_to_string(&file).expect("the file is there"),
        text,
        "the library changed: run with APEX_UPDATE_EXPECTATIONS=1"
    );
}
