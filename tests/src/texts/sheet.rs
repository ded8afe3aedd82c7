//! A graph under construction: its ports and nodes, and the available tokens.

use super::{
    interface::{Node, Port, port},
    maker::Maker,
    types::Type,
    values::Param,
};

/// An available token.
#[derive(Debug, Clone)]
pub struct Wire {
    /// Sending end of a connection.
    pub from: String,
    /// Type.
    pub ty: &'static Type,
    /// `true` for the token of an event.
    pub event: bool,
}

/// A graph under construction.
#[derive(Debug, Default)]
pub struct Sheet {
    /// Names of nodes and ports.
    pub used: Vec<String>,
    /// Ports.
    pub ports: Vec<(&'static str, Port)>,
    /// Declarations of ports.
    pub port_lines: Vec<String>,
    /// Declarations of nodes.
    pub nodes: Vec<String>,
    /// Connections.
    pub links: Vec<String>,
    /// Available tokens.
    pub wires: Vec<Wire>,
    /// Parameters.
    pub params: Vec<(String, &'static Param)>,
    /// Names of nodes with their types.
    pub named: Vec<(String, Node)>,
    /// Nodes that can be active.
    pub active: Vec<String>,
}

impl Maker {
    /// Adds a port through which tokens of this type enter.
    pub fn input(&mut self, sheet: &mut Sheet, ty: &'static Type) -> Wire {
        let name = self.port_name(&mut sheet.used);
        let kind = if self.dice.one_in(3) { "slot" } else { "in" };
        self.rust(ty.item);
        let written = self.written(ty);
        // All frames are the same: two would have to be turned into each other.
        let frame = if self.dice.one_in(8) { *self.dice.of(&[" in base", " in \"base\""]) } else { "" };
        sheet.port_lines.push(format!("{kind} {name}: {written}{frame};"));
        sheet.ports.push((kind, port(&name, ty)));
        let wire = Wire { from: name, ty, event: kind == "slot" };
        sheet.wires.push(wire.clone());
        wire
    }

    /// An available token of this type, or that of a new port.
    pub fn wire(&mut self, sheet: &mut Sheet, ty: &'static Type) -> Wire {
        let fitting: Vec<Wire> = sheet.wires.iter().filter(|w| w.ty == ty).cloned().collect();
        match fitting.is_empty() || self.dice.one_in(8) {
            true => self.input(sheet, ty),
            false => self.dice.of(&fitting).clone(),
        }
    }
}
