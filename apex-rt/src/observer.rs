use core::fmt::{Debug, Display};

/// Watches a program while it reacts. Every method does nothing unless it is overridden; with `()` a
/// program is compiled as if nobody watched.
///
/// Nodes are given by their index in [`Info::nodes`](crate::Info::nodes).
pub trait Observer {
    /// Node `node` is about to fire.
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        let _ = node;
    }

    /// `process` of node `node` returned an error; its outputs carry ⊥.
    #[inline(always)]
    fn failed(&mut self, node: usize, error: &impl Display) {
        let _ = (node, error);
    }

    /// A token at the parameter port `parameter` of node `node` was out of range; the node keeps the value it has.
    #[inline(always)]
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let _ = (node, parameter, value);
    }
}

impl Observer for () {}

impl<O: Observer> Observer for &mut O {
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        (**self).fired(node);
    }
    #[inline(always)]
    fn failed(&mut self, node: usize, error: &impl Display) {
        (**self).failed(node, error);
    }
    #[inline(always)]
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        (**self).refused(node, parameter, value);
    }
}

/// Writes failures and refused parameter values to standard error, with the names of the nodes.
#[cfg(feature = "std")]
#[derive(Debug, Clone, Copy)]
pub struct StdErr(pub &'static crate::Info);

#[cfg(feature = "std")]
impl Observer for StdErr {
    fn failed(&mut self, node: usize, error: &impl Display) {
        eprintln!("{}: `{}` failed: {error}", self.0.name, self.0.nodes[node].name);
    }
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let name = self.0.nodes[node].name;
        eprintln!("{}: `{name}` keeps its `{parameter}`: {value:?} is out of range", self.0.name);
    }
}
