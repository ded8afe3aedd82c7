//! Structs of Rust that a source file writes as values.

use super::{catalog::Catalog, items::ItemKind, ty::Ty, types::Type};

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
        let ItemKind::Type(declared) = &self.tree.defs[*def].kind else { return Structure::Other(named) };
        let params = declared.generics.iter().map(|name| Type::Param(name.clone())).collect();
        match self.struct_of(&Type::Def(*def, name.clone(), params)) {
            Some(known) => Structure::Known(known),
            None => Structure::Other(named),
        }
    }

    /// The struct that a type is, if its fields are known.
    pub fn struct_of(&self, ty: &Type) -> Option<Struct> {
        let Type::Def(def, _, args) = ty else { return None };
        let item = &self.tree.defs[*def];
        let ItemKind::Type(declared) = &item.kind else { return None };
        let argument = |name: &str| args.get(declared.generics.iter().position(|param| param == name)?).cloned();
        let field = |field: &super::items::FieldItem| Field {
            name: field.name.clone(),
            ty: self.type_of(&field.ty, item.module, &declared.generics).substitute(&argument),
            is_visible: self.tree.sees_field(item.module, &field.seen, self.site),
        };
        let (file, line) = self.place(*def);
        Some(Struct {
            path: self.path(*def).map(<[String]>::to_vec),
            ty: ty.clone(),
            fields: declared.fields.as_ref()?.iter().map(field).collect(),
            place: format!("{}:{line}", file.display()),
        })
    }
}
