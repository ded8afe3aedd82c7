use core::fmt::{Debug, Display};

/// Watches a program while it reacts. Every method does nothing unless it is overridden; with `()` a
/// program is compiled as if nobody watched.
///
/// Nodes are given by their index in [`Info::nodes`](crate::Info::nodes), connections by theirs in
/// [`Info::connections`](crate::Info::connections).
pub trait Observer {
    /// Node `node` is about to fire.
    #[inline(always)]
    fn fired(&mut self, node: usize) {
        let _ = node;
    }

    /// The slot at the end of connection `connection` is about to take its token.
    #[inline(always)]
    fn handled(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Node `node` became active, or is no longer.
    #[inline(always)]
    fn activity(&mut self, node: usize, active: bool) {
        let _ = (node, active);
    }

    /// A reaction used up its steps, because tokens go round while the time stands still. `nodes` took part in the
    /// last steps, each as often as `counts` says.
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let _ = (nodes, counts);
    }

    /// The program can do nothing more, and the end of connection `connection` waits for its event.
    fn waits(&mut self, connection: usize) {
        let _ = connection;
    }

    /// Node `node` returned an error, or panicked where that is contained; its outputs carry ⊥.
    #[inline(always)]
    fn failed(&mut self, node: usize, error: &impl Display) {
        let _ = (node, error);
    }

    /// A token at the parameter port `parameter` of node `node` was out of range; the node keeps the value it has.
    #[inline(always)]
    fn refused(&mut self, node: usize, parameter: &'static str, value: &impl Debug) {
        let _ = (node, parameter, value);
    }

    /// Claim `claim` (by its index in [`Info::claims`](crate::Info::claims)) was broken. It is reported again only
    /// after it held in between. Claims that the compiler decided are not looked at.
    fn claim_failed(&mut self, claim: usize) {
        let _ = claim;
    }
}

impl Observer for () {}

impl<O: Observer> Observer for &mut O {
    #[inline(always)]
    fn handled(&mut self, connection: usize) {
        (**self).handled(connection);
    }
    #[inline(always)]
    fn activity(&mut self, node: usize, active: bool) {
        (**self).activity(node, active);
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        (**self).endless(nodes, counts);
    }
    fn claim_failed(&mut self, claim: usize) {
        (**self).claim_failed(claim);
    }
    fn waits(&mut self, connection: usize) {
        (**self).waits(connection);
    }
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

/// Writes failures, refused parameter values, endless loops and broken claims to standard error, with the names of the nodes.
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
    fn waits(&mut self, connection: usize) {
        let (info, c) = (self.0, &self.0.connections[connection]);
        let (from, to) = (info.nodes[c.from].name, info.nodes[c.to].name);
        eprintln!("{}: `{to}` waits for the event `{from}.{}`, which never came", info.name, c.output);
    }
    fn endless(&mut self, nodes: &[usize], counts: &[u32]) {
        let total: u32 = counts.iter().sum();
        eprintln!("{}: tokens go round while the time stands still; of the last {total} steps:", self.0.name);
        for (node, count) in nodes.iter().zip(counts).filter(|(_, count)| **count > 0) {
            eprintln!("{count:>8}  `{}`", self.0.nodes[*node].name);
        }
    }
    fn claim_failed(&mut self, claim: usize) {
        eprintln!("{}: the claim `{}` does not hold", self.0.name, self.0.claims[claim]);
    }
}
