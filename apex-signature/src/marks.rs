//! Attributes of nodes and their methods.

use syn::{Attribute, Expr, ExprLit, Lit};

/// Names of the attributes that mark methods of a node.
pub const METHOD_MARKS: [&str; 5] = ["slot", "no_message", "on_activate", "on_deactivate", "on_stop"];

/// The attribute that marks an event of failure.
pub const FAILURE: &str = "failure";

/// The attribute with the unit of the tokens of a port.
pub const UNIT: &str = "unit";

/// The attribute that marks a struct whose events take activity away instead of passing it on.
pub const DEACTIVATES: &str = "deactivates";

/// The attribute that marks a node that sends its tokens in the frame of those that it takes.
pub const KEEPS_FRAME: &str = "keeps_frame";

/// The attribute that marks a node whose tokens follow from its slots, its parameters and the time: nothing in them
/// comes from outside of the program, although it may fire without inputs.
pub const COMPUTED: &str = "computed";

/// Returns `true` if `attrs` contain `#[node]`, also by its path.
pub fn is_node(attrs: &[Attribute]) -> bool {
    attrs.iter().any(|a| {
        let segments = &a.path().segments;
        segments.last().is_some_and(|s| s.ident == "node") && (segments.len() == 1 || segments[0].ident == "apex_rt")
    })
}

/// Returns `true` if `attrs` contain `#[name]`.
pub fn marked(attrs: &[Attribute], name: &str) -> bool {
    attrs.iter().any(|a| a.path().is_ident(name))
}

/// The text of the `///` comments.
pub fn docs(attrs: &[Attribute]) -> String {
    let lines: Vec<String> = attrs
        .iter()
        .filter(|a| a.path().is_ident("doc"))
        .filter_map(|a| match &a.meta {
            syn::Meta::NameValue(nv) => match &nv.value {
                Expr::Lit(ExprLit { lit: Lit::Str(s), .. }) => Some(unindented(&s.value())),
                _ => None,
            },
            _ => None,
        })
        .collect();
    lines.join("\n")
}

/// Without the blank that all lines begin with; further ones mean something in Markdown.
fn unindented(line: &str) -> String {
    line.strip_prefix(' ').unwrap_or(line).trim_end().to_owned()
}

/// The unit in `#[unit("m")]`.
pub fn unit(attrs: &[Attribute]) -> syn::Result<Option<String>> {
    let unit = attrs.iter().find(|a| a.path().is_ident(UNIT));
    unit.map(|attr| attr.parse_args::<syn::LitStr>().map(|unit| unit.value())).transpose()
}
