//! Examples in the documentation of the runtime. Cargo compiles and runs them (`cargo test -p apex-rt --doc`); here it
//! is checked that whatever users call has one.

use crate::root;
use std::{
    fs,
    path::{Path, PathBuf},
};
use syn::{Attribute, Ident, ImplItem, Item, ItemImpl, ItemUse, Meta, TraitItem, Type, UseTree, Visibility};

/// Crate with the macros that the runtime re-exports, each with an example at the re-export: there it can be used.
const MACROS: &str = "apex_attributes";

/// Visible function, trait or type of the runtime.
struct Called {
    name: String,
    has_example: bool,
}

/// Module of the runtime.
struct Module {
    items: Vec<Item>,
    /// Folder of the modules in it.
    folder: PathBuf,
}

impl Module {
    /// Reads the module `name` in `folder`; `None` if it is not a module there.
    fn read(folder: &Path, name: &str) -> Option<Self> {
        let (file, within) = (folder.join(format!("{name}.rs")), folder.join(name));
        let path = if file.is_file() { file } else { within.join("mod.rs") };
        let text = fs::read_to_string(&path).ok()?;
        let items = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display())).items;
        Some(Self { items, folder: if name == "lib" { folder.to_owned() } else { within } })
    }

    /// Adds what the documentation of the module shows.
    fn add_visible(&self, called: &mut Vec<Called>) {
        for item in &self.items {
            match item {
                Item::Use(item) if is_public(&item.vis) && is_shown(&item.attrs) => self.add_used(item, called),
                Item::Mod(item) if is_public(&item.vis) && is_shown(&item.attrs) && item.content.is_none() => {
                    let module = Self::read(&self.folder, &item.ident.to_string()).expect("it has a file");
                    module.add_visible(called);
                }
                item => {
                    let public = definition(item).filter(|(visibility, ..)| is_public(visibility));
                    called.extend(public.and_then(|(_, name, _)| self.called(&name.to_string())));
                }
            }
        }
    }

    /// Adds what is re-exported.
    fn add_used(&self, item: &ItemUse, called: &mut Vec<Called>) {
        let UseTree::Path(path) = &item.tree else { panic!("a path is re-exported") };
        let (mut path, mut folder) = (path, self.folder.clone());
        if let ("crate", UseTree::Path(inner)) = (path.ident.to_string().as_str(), &*path.tree) {
            (path, folder) = (inner, root().join("apex-rt/src"));
        }
        let (module, mut names) = (path.ident.to_string(), vec![]);
        add_names(&path.tree, &mut names);
        if module == MACROS {
            called.extend(names.into_iter().map(|name| Called { name, has_example: has_example(&item.attrs) }));
        } else if let Some(module) = Self::read(&folder, &module) {
            called.extend(names.iter().filter_map(|name| module.called(name)));
        }
    }

    /// Returns the item `name` if users can call it: a function, or a trait or type with visible functions.
    fn called(&self, name: &str) -> Option<Called> {
        let defined = self.items.iter().filter_map(definition).filter(|(_, ident, _)| *ident == name);
        let mut comments: Vec<_> = defined.map(|(.., attributes)| attributes).collect();
        comments.retain(|attributes| is_shown(attributes));
        let mut functions: Vec<_> = self.items.iter().flat_map(|item| functions(item, name)).collect();
        functions.retain(|attributes| is_shown(attributes));
        if comments.is_empty() || functions.is_empty() {
            return None;
        }
        let has_example = comments.iter().chain(&functions).any(|attributes| has_example(attributes));
        Some(Called { name: name.to_owned(), has_example })
    }
}

/// Visibility, name and attributes of a function, a trait or a type.
fn definition(item: &Item) -> Option<(&Visibility, &Ident, &Vec<Attribute>)> {
    match item {
        Item::Fn(item) => Some((&item.vis, &item.sig.ident, &item.attrs)),
        Item::Trait(item) => Some((&item.vis, &item.ident, &item.attrs)),
        Item::Struct(item) => Some((&item.vis, &item.ident, &item.attrs)),
        Item::Enum(item) => Some((&item.vis, &item.ident, &item.attrs)),
        _ => None,
    }
}

/// Attributes of the functions that an item has for users of `name`.
fn functions<'a>(item: &'a Item, name: &str) -> Vec<&'a Vec<Attribute>> {
    match item {
        Item::Fn(item) if item.sig.ident == name => vec![&item.attrs],
        Item::Trait(item) if item.ident == name => item.items.iter().filter_map(function_of_trait).collect(),
        Item::Impl(item) if is_of(item, name) && is_shown(&item.attrs) => {
            item.items.iter().filter_map(public_function).collect()
        }
        _ => vec![],
    }
}

/// Adds the names at the end of a path.
fn add_names(tree: &UseTree, names: &mut Vec<String>) {
    match tree {
        UseTree::Name(name) => names.push(name.ident.to_string()),
        UseTree::Group(group) => group.items.iter().for_each(|tree| add_names(tree, names)),
        _ => panic!("names are re-exported as they are"),
    }
}

fn function_of_trait(item: &TraitItem) -> Option<&Vec<Attribute>> {
    if let TraitItem::Fn(function) = item { Some(&function.attrs) } else { None }
}

fn public_function(item: &ImplItem) -> Option<&Vec<Attribute>> {
    match item {
        ImplItem::Fn(function) if is_public(&function.vis) => Some(&function.attrs),
        _ => None,
    }
}

/// Returns `true` for the functions of the type `name` itself, which are not those of a trait.
fn is_of(item: &ItemImpl, name: &str) -> bool {
    let Type::Path(ty) = &*item.self_ty else { return false };
    item.trait_.is_none() && ty.path.segments.last().is_some_and(|segment| segment.ident == name)
}

fn is_public(visibility: &Visibility) -> bool {
    matches!(visibility, Visibility::Public(_))
}

/// Returns `true` unless the item is hidden, because only generated code calls it.
fn is_shown(attributes: &[Attribute]) -> bool {
    !attributes.iter().any(|attribute| {
        matches!(&attribute.meta, Meta::List(list) if list.path.is_ident("doc") && list.tokens.to_string() == "hidden")
    })
}

/// Returns `true` if a doc comment has a block of code that is compiled and run.
fn has_example(attributes: &[Attribute]) -> bool {
    let mut fences = attributes.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(doc) if doc.path.is_ident("doc") => {
            let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(line), .. }) = &doc.value else { return None };
            line.value().trim().strip_prefix("```").map(str::to_owned)
        }
        _ => None,
    });
    fences.next().is_some_and(|kind| kind.is_empty())
}

#[test]
fn whatever_users_of_the_runtime_call_has_an_example() {
    let library = Module::read(&root().join("apex-rt/src"), "lib").expect("the runtime is there");
    let mut called = vec![];
    library.add_visible(&mut called);
    let without: Vec<&str> = called.iter().filter(|item| !item.has_example).map(|item| item.name.as_str()).collect();
    assert_eq!(without, Vec::<&str>::new(), "show a typical call, or `#[doc(hidden)]` if only generated code calls it");
    assert!(called.len() > 40, "only {} items were found", called.len());
}
