//! Structs of Rust that a source file writes as values.

use super::{Catalog, ItemKind, Ty, Type};

/// Result of looking up the path of a struct.
#[derive(Debug, Clone, PartialEq)]
pub enum Structure {
    /// A struct with named fields.
    Known(Struct),
    /// A type other than a struct with named fields, or one whose fields are not known.
    Other(Type),
    /// Not found. Contains the paths of types with this name.
    Missing(Vec<String>),
}

/// A struct with named fields.
#[derive(Debug, Clone, PartialEq)]
pub struct Struct {
    /// The path that generated code uses; `None` if it cannot name the struct.
    pub path: Option<Vec<String>>,
    /// Its type; type parameters stand for themselves.
    pub ty: Type,
    /// Its fields.
    pub fields: Vec<Field>,
    /// Place of its declaration.
    pub place: String,
}

/// A field of a struct.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// Type.
    pub ty: Type,
    /// `true` if generated code can use it.
    pub is_visible: bool,
}

impl Catalog {
    /// Looks up a struct.
    pub fn structure(&self, path: &[String]) -> Structure {
        let named = self.type_in_text(&Ty::Path(path.to_owned(), vec![]), &[]);
        let Type::Def(def, name, _) = &named else {
            let last = path.last().map_or("", String::as_str);
            let types = self.find(last).into_iter().filter(|def| self.is_type(*def));
            let paths = types.filter_map(|def| self.path(def)).map(|path| self.written(path).join("::"));
            return match named {
                Type::Unknown(_) => Structure::Missing(paths.collect()),
                other => Structure::Other(other),
            };
        };
        let item = &self.tree.defs[*def];
        let ItemKind::Type(declared) = &item.kind else { return Structure::Other(named) };
        let Some(fields) = &declared.fields else { return Structure::Other(named) };
        let field = |field: &super::items::FieldItem| Field {
            name: field.name.clone(),
            ty: self.type_of(&field.ty, item.module, &declared.generics),
            is_visible: self.tree.sees_field(item.module, &field.seen, self.site),
        };
        let params = declared.generics.iter().map(|name| Type::Param(name.clone())).collect();
        let (file, line) = self.place(*def);
        Structure::Known(Struct {
            path: self.path(*def).map(<[String]>::to_vec),
            ty: Type::Def(*def, name.clone(), params),
            fields: fields.iter().map(field).collect(),
            place: format!("{}:{line}", file.display()),
        })
    }
}
