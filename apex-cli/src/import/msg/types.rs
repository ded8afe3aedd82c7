//! Types of messages, by their names.

use super::parse::{self, Kind, Type};
use std::collections::BTreeMap;

/// Types by their names: `sensor_msgs/msg/LaserScan`.
#[derive(Default)]
pub struct Types {
    /// Types that are written.
    pub own: BTreeMap<String, Type>,
    /// Types of `apex-messages`.
    common: BTreeMap<String, Type>,
}

impl Types {
    /// The types of `apex-messages`.
    pub fn common() -> Self {
        let mut types = Self::default();
        for known in apex_messages::ALL {
            let Some((package, ty)) = known.name.split_once("/msg/") else { continue };
            // The definitions of the messages in it follow.
            let own = known.definition.split("\n===").next().unwrap_or_default();
            let read = parse::read(own, package, ty, Kind::Message).unwrap_or_default();
            types.common.extend(read.into_iter().map(|ty| (ty.name.clone(), ty)));
        }
        types
    }

    /// Adds a type that is written.
    pub fn add(&mut self, ty: Type) -> Result<(), String> {
        let same = |other: &&Type| other.package() == ty.package() && other.rust_name() == ty.rust_name();
        if let Some(other) = self.own.values().find(same) {
            return Err(format!("`{}` and `{}` would be the same struct: rename one", ty.name, other.name));
        }
        self.own.insert(ty.name.clone(), ty);
        Ok(())
    }

    /// Type of this name.
    pub fn get(&self, name: &str) -> Result<&Type, String> {
        self.own.get(name).or_else(|| self.common.get(name)).ok_or_else(|| {
            let package = name.split('/').next().unwrap_or_default();
            format!(
                "unknown type `{name}`, which neither these files nor `apex-messages` have: correct its name, or name \
                 the folder of `{package}`, too"
            )
        })
    }

    /// Types in a type, in the order in which they are used, each once.
    pub fn parts<'a>(&'a self, ty: &'a Type) -> Result<Vec<&'a Type>, String> {
        let (mut parts, mut path) = (vec![], vec![&*ty.name]);
        self.add_parts(ty, &mut parts, &mut path)?;
        Ok(parts)
    }

    fn add_parts<'a>(&'a self, ty: &'a Type, parts: &mut Vec<&'a Type>, path: &mut Vec<&'a str>) -> Result<(), String> {
        for name in ty.fields.iter().filter_map(|field| field.message()) {
            if path.contains(&name) {
                return Err(format!("`{}` contains itself", ty.name));
            }
            let part = self.get(name).map_err(|message| format!("`{}` has a field of an {message}", ty.name))?;
            if !parts.iter().any(|known| known.name == part.name) {
                parts.push(part);
                path.push(&part.name);
                self.add_parts(part, parts, path)?;
                path.pop();
            }
        }
        Ok(())
    }

    /// Definition of a type with those of its parts.
    pub fn definition(&self, ty: &Type) -> Result<String, String> {
        let mut text = ty.text();
        for part in self.parts(ty)? {
            let name = part.name.replacen("/msg/", "/", 1);
            text.push_str(&format!("\n{}\nMSG: {name}\n{}", "=".repeat(80), part.text()));
        }
        Ok(text)
    }
}
