//! Dispatcher: decides at run time which cluster fires. The conditions that a cluster waits for are a set of bits; the
//! cluster is ready when all of them are set. The size of all state is known at compile time.

/// A set of `64·W` conditions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bits<const W: usize>(pub [u64; W]);

impl<const W: usize> Bits<W> {
    /// The empty set.
    pub const NONE: Self = Self([0; W]);

    /// Returns the set of the given conditions.
    pub const fn of(bits: &[u32]) -> Self {
        let mut words = [0; W];
        let mut i = 0;
        while i < bits.len() {
            words[bits[i] as usize / 64] |= 1 << (bits[i] % 64);
            i += 1;
        }
        Self(words)
    }

    /// Returns `true` if a condition holds.
    #[inline(always)]
    pub const fn has(&self, bit: usize) -> bool {
        self.0[bit / 64] & 1 << (bit % 64) != 0
    }

    /// Sets or clears a condition.
    #[inline(always)]
    pub const fn set(&mut self, bit: usize, holds: bool) {
        let (word, mask) = (&mut self.0[bit / 64], 1 << (bit % 64));
        if holds { *word |= mask } else { *word &= !mask }
    }

    /// Clears a condition. Returns `true` if it held.
    #[inline(always)]
    pub const fn take(&mut self, bit: usize) -> bool {
        let held = self.has(bit);
        self.set(bit, false);
        held
    }

    /// Returns `true` if all conditions of `other` hold.
    #[inline(always)]
    pub fn contains(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a & b == *b)
    }

    /// Returns `true` if one of these conditions holds.
    #[inline]
    pub fn has_any(&self, bits: &[u32]) -> bool {
        bits.iter().any(|bit| self.has(*bit as usize))
    }

    /// Adds the conditions of `other`.
    #[inline(always)]
    pub fn insert(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a |= b);
    }

    /// Removes the conditions of `other`.
    #[inline(always)]
    pub fn remove(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a &= !b);
    }
}

/// Conditions that are known at compile time: a set of bits in a program with few conditions, a list of their numbers
/// in one with many. The list keeps size and time independent of the conditions that it does not contain.
pub trait Conditions<const W: usize> {
    /// Returns `true` if all of them are in `holds`.
    fn hold_in(&self, holds: &Bits<W>) -> bool;
    /// Returns `true` if one of them is in `holds`.
    fn meet(&self, holds: &Bits<W>) -> bool;
    /// Sets or clears all of them in `holds`.
    fn put_into(&self, holds: &mut Bits<W>, value: bool);
}

impl<const W: usize> Conditions<W> for Bits<W> {
    #[inline(always)]
    fn hold_in(&self, holds: &Bits<W>) -> bool {
        holds.contains(self)
    }

    #[inline(always)]
    fn meet(&self, holds: &Bits<W>) -> bool {
        holds.0.iter().zip(&self.0).any(|(a, b)| a & b != 0)
    }

    #[inline(always)]
    fn put_into(&self, holds: &mut Bits<W>, value: bool) {
        if value { holds.insert(self) } else { holds.remove(self) }
    }
}

impl<const W: usize> Conditions<W> for &[u32] {
    #[inline]
    fn hold_in(&self, holds: &Bits<W>) -> bool {
        self.iter().all(|bit| holds.has(*bit as usize))
    }

    #[inline]
    fn meet(&self, holds: &Bits<W>) -> bool {
        holds.has_any(self)
    }

    #[inline]
    fn put_into(&self, holds: &mut Bits<W>, value: bool) {
        self.iter().for_each(|bit| holds.set(*bit as usize, value));
    }
}

/// A token of an event that a cluster needs besides other tokens (static data).
#[derive(Debug)]
pub struct Missing<S> {
    /// Bits of the cluster's other tokens.
    pub others: S,
    /// Bit of the token.
    pub token: usize,
    /// Connection of the token.
    pub connection: usize,
}

/// Dependencies of a cluster (static data).
///
/// Conditions: each timer and each graph-level input has a bit. Each connection between clusters, and each asynchronous
/// one that may stay occupied, has a bit "free" and, if it leads to an input, a bit "holds a token". Each cluster has a
/// bit "enabled".
#[derive(Debug)]
pub struct Cluster<S> {
    /// Conditions for firing besides `takes`: the cluster's events are free.
    waits_for: S,
    /// Conditions that firing requires and clears: the guards, the tokens on all incoming connections, and "enabled".
    takes: S,
    /// Conditions that firing sets: tokens on the outgoing synchronous connections.
    sends: S,
    /// Conditions that firing clears: the outgoing synchronous connections are free.
    occupies: S,
    /// Conditions that all hold when everything downstream has finished after a firing. Then the cluster is enabled
    /// again.
    notified_by: S,
    /// Conditions that this sets: "enabled", and the incoming connections are free (R4).
    notifies: S,
    /// Bit "enabled".
    enabled: usize,
    /// All transitive predecessors, in reverse topological order.
    above: &'static [u32],
}

/// Numbers of conditions or clusters in a row of a table.
type List = &'static [u32];

impl<const W: usize> Cluster<Bits<W>> {
    /// Returns a row of the table, with the sets in the order of the fields.
    pub const fn dense(enabled: usize, sets: [List; 6], above: List) -> Self {
        let [waits_for, takes, sends, occupies, notified_by, notifies] = sets;
        Self {
            waits_for: Bits::of(waits_for),
            takes: Bits::of(takes),
            sends: Bits::of(sends),
            occupies: Bits::of(occupies),
            notified_by: Bits::of(notified_by),
            notifies: Bits::of(notifies),
            enabled,
            above,
        }
    }
}

impl Cluster<List> {
    /// Returns a row of the table of a program with many conditions.
    pub const fn sparse(enabled: usize, sets: [List; 6], above: List) -> Self {
        let [waits_for, takes, sends, occupies, notified_by, notifies] = sets;
        Self { waits_for, takes, sends, occupies, notified_by, notifies, enabled, above }
    }
}

/// The conditions that hold, and their changes by firings. With `TRACKS`, the dispatcher knows if a cluster may have
/// become ready since the last search, which is worth its code if there are several clusters.
#[derive(Debug, Clone)]
pub struct Dispatcher<const W: usize, const TRACKS: bool> {
    /// The highest bit is not a condition. It is set if a condition has become true since the last search.
    holds: Bits<W>,
}

/// Bit of the last word that is set if a cluster may have become ready.
const NEWS: u64 = 1 << 63;

impl<const W: usize, const TRACKS: bool> Dispatcher<W, TRACKS> {
    /// Returns the dispatcher of a program before its first reaction, in which `initial` holds.
    pub const fn new(initial: Bits<W>) -> Self {
        let mut holds = initial;
        if TRACKS {
            holds.0[W - 1] |= NEWS;
        }
        Self { holds }
    }

    /// Sets a condition: a guard, or a connection that is free again.
    #[inline(always)]
    pub fn raise(&mut self, bit: usize) {
        if TRACKS && !self.has(bit) {
            self.look_again();
        }
        self.holds.set(bit, true);
    }

    /// Returns `true` if a cluster may have become ready since the last call.
    #[inline(always)]
    pub fn take_news(&mut self) -> bool {
        if !TRACKS {
            return true;
        }
        let news = self.holds.0[W - 1] & NEWS != 0;
        self.holds.0[W - 1] &= !NEWS;
        news
    }

    /// Requests another search, for example because a cluster that is ready was not fired.
    #[inline(always)]
    pub fn look_again(&mut self) {
        if TRACKS {
            self.holds.0[W - 1] |= NEWS;
        }
    }

    /// Clears a condition: a connection is occupied.
    #[inline(always)]
    pub fn clear(&mut self, bit: usize) {
        self.holds.set(bit, false);
    }

    /// Returns `true` if a condition holds.
    #[inline(always)]
    pub fn has(&self, bit: usize) -> bool {
        self.holds.has(bit)
    }

    /// Returns `true` if all of `conditions` hold.
    #[inline(always)]
    pub fn holds(&self, conditions: &impl Conditions<W>) -> bool {
        conditions.hold_in(&self.holds)
    }

    /// Returns `true` if at least one of a cluster's other tokens is there, but this one is not.
    pub fn misses(&self, missing: &Missing<impl Conditions<W>>) -> bool {
        missing.others.meet(&self.holds) && !self.has(missing.token)
    }

    /// Takes the tokens and guards of `cluster` and returns `true` if it is ready. The caller then fires it.
    #[inline(always)]
    pub fn start(&mut self, cluster: &Cluster<impl Conditions<W>>) -> bool {
        let ready = cluster.takes.hold_in(&self.holds) && cluster.waits_for.hold_in(&self.holds);
        if ready {
            cluster.takes.put_into(&mut self.holds, false);
        }
        ready
    }

    /// Ends a firing of `clusters[index]`: its tokens are sent, and notifications travel upstream.
    ///
    /// Always inlined: table and index are constants, so that mostly only a few bit operations remain.
    #[inline(always)]
    pub fn finish(&mut self, clusters: &[Cluster<impl Conditions<W>>], index: usize) {
        let cluster = &clusters[index];
        cluster.sends.put_into(&mut self.holds, true);
        cluster.occupies.put_into(&mut self.holds, false);
        self.look_again();
        self.settle(clusters, index);
    }

    /// Enables `clusters[index]` again if everything downstream of it has finished, and also each cluster upstream for
    /// which it was the last one.
    #[inline(always)]
    pub fn settle(&mut self, clusters: &[Cluster<impl Conditions<W>>], index: usize) {
        let cluster = &clusters[index];
        if self.has(cluster.enabled) || !cluster.notified_by.hold_in(&self.holds) {
            return;
        }
        cluster.notifies.put_into(&mut self.holds, true);
        self.look_again();
        for above in cluster.above.iter().map(|&above| &clusters[above as usize]) {
            // The cluster has fired, and everything downstream of it has finished.
            if !self.has(above.enabled) && above.notified_by.hold_in(&self.holds) {
                above.notifies.put_into(&mut self.holds, true);
            }
        }
    }
}
