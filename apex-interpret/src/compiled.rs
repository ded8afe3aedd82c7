//! Nodes and values that were compiled as pieces of Rust.

use crate::{
    Library, Node, Value,
    glue::{Piece, Recorded},
};
use apex_dsl::{
    catalog::{Catalog, Signature, Type},
    codegen::{Boxed, Constant, Key, constant_of},
    graph::{self, NodeId},
};
use apex_rt::Time;
use std::{collections::BTreeMap, rc::Rc, time::Duration};

/// The nodes and values of a program.
pub struct Compiled<'a> {
    /// The pieces that it needs.
    pub boxed: &'a Boxed,
    /// All pieces that were compiled.
    pub pieces: &'a BTreeMap<Key, &'static Piece>,
    pub catalog: &'a Catalog,
}

impl Compiled<'_> {
    fn constant(&self, constant: &Constant) -> Option<Value> {
        match constant {
            Constant::Plain(value, ty) => plain(value, ty),
            Constant::Piece(key) => match self.pieces.get(key)? {
                Piece::Value(make) => Some(make()),
                _ => None,
            },
        }
    }

    /// Checks a token as step `step` of a test says; `None` if that needs no Rust.
    pub fn check(&self, test: &str, step: usize, token: &Value) -> Option<bool> {
        let key = self.boxed.checks.get(&(test.to_owned(), step))?;
        match self.pieces.get(key) {
            Some(Piece::Check(check)) => Some(check(token)),
            _ => Some(false),
        }
    }

    /// The tokens that a port is fed from a recording, with their times.
    pub fn recorded(&self, port: NodeId, of: Recorded<'_>) -> Option<Vec<(Duration, Value)>> {
        let piece = self.boxed.recorded.get(&port).and_then(|key| self.pieces.get(key));
        match piece {
            Some(Piece::Recorded(read)) => Some(read(of)),
            _ => None,
        }
    }

    /// The token of a probe as text.
    pub fn shown(&self, probe: NodeId, token: &Value) -> String {
        let piece = self.boxed.shown.get(&probe).and_then(|key| self.pieces.get(key));
        let shown = match piece {
            Some(Piece::Show(show)) => show(token),
            _ => None,
        };
        shown.unwrap_or_else(|| "a token".to_owned())
    }

    fn list_piece(&self, end: (usize, usize)) -> Option<&'static Piece> {
        self.boxed.lists.get(&end).and_then(|key| self.pieces.get(key)).copied()
    }
}

impl Library for Compiled<'_> {
    fn make(&self, node: usize, _signature: &Signature, _library: &graph::Library) -> Option<Box<dyn Node>> {
        let boxed = self.boxed.nodes.get(&node)?;
        let params: Option<Vec<Value>> = boxed.params.iter().map(|param| self.constant(param)).collect();
        match self.pieces.get(&boxed.made)? {
            Piece::Node(make) => make(params?),
            _ => None,
        }
    }

    fn token(&self, value: Option<&graph::Value>, ty: &Type) -> Option<Value> {
        let (constant, _) = constant_of(value, ty, self.catalog).ok()?;
        self.constant(&constant)
    }

    fn items(&self, end: (usize, usize), list: &Value) -> Vec<Value> {
        match self.list_piece(end) {
            Some(Piece::Items(items)) => items(list),
            _ => vec![],
        }
    }

    fn list(&self, end: (usize, usize), items: Vec<Value>) -> Option<Value> {
        match self.list_piece(end) {
            Some(Piece::List(list)) => list(items),
            _ => None,
        }
    }
}

/// A value that needs no Rust (`Constant::Plain`); `None` if the type does not have it.
fn plain(value: &graph::Value, ty: &Type) -> Option<Value> {
    Some(match value {
        graph::Value::Number(number) => {
            let number = ty.measured_in().map_or_else(|| *number, |unit| number.in_unit(unit));
            macro_rules! integer {
                ($name:expr, $($ty:ident)*) => {
                    match $name {
                        $(stringify!($ty) => Rc::new($ty::try_from(number.integer()?).ok()?) as Value,)*
                        // From the text, as rustc reads it.
                        "f32" => Rc::new(number.value.to_string().parse::<f32>().ok()?),
                        "f64" => Rc::new(number.value),
                        _ => return None,
                    }
                };
            }
            integer!(ty.without_unit().name(), i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize)
        }
        graph::Value::Bool(value) => Rc::new(*value),
        graph::Value::Text(text) => Rc::new(text.clone()),
        graph::Value::Unit => Rc::new(()),
        graph::Value::Duration(time) if ty.is_time() => {
            Rc::new(Time::from_nanos(i64::try_from(time.as_nanos()).unwrap_or(i64::MAX)))
        }
        graph::Value::Duration(time) => Rc::new(*time),
        _ => return None,
    })
}
