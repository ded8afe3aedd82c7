//! Decides at run time which cluster fires: for every cluster the set of things it waits for is a set of
//! bits, and it is ready when all of them are set. All state has a size known at compile time.

/// A set of `64·W` conditions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bits<const W: usize>(pub [u64; W]);

impl<const W: usize> Bits<W> {
    /// The empty set.
    pub const NONE: Self = Self([0; W]);

    /// The set of the given conditions.
    pub const fn of(bits: &[usize]) -> Self {
        let mut words = [0; W];
        let mut i = 0;
        while i < bits.len() {
            words[bits[i] / 64] |= 1 << (bits[i] % 64);
            i += 1;
        }
        Self(words)
    }

    /// Whether all conditions of `other` hold.
    #[inline(always)]
    pub fn contains(&self, other: &Self) -> bool {
        self.0.iter().zip(&other.0).all(|(a, b)| a & b == *b)
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

/// A token from an event that a cluster needs besides others (static data).
#[derive(Debug)]
pub struct Missing<const W: usize> {
    /// The bits of the cluster's other tokens.
    pub others: Bits<W>,
    /// The bit of the token.
    pub token: usize,
    /// The connection that it comes on.
    pub connection: usize,
}

/// A cluster's place among the others (static data).
///
/// Conditions: each timer and each graph-level input has a bit; each connection between clusters, and each
/// asynchronous one that may stay occupied, has one for "free" and, if it leads to an input, one for "holds a
/// token"; each cluster has one for "enabled".
#[derive(Debug)]
pub struct Cluster<const W: usize> {
    /// What must hold for it to fire: its guards, tokens on all incoming connections, its events and itself enabled.
    pub waits_for: Bits<W>,
    /// What is used up by that: all of it but the enabled events.
    pub takes: Bits<W>,
    /// Set when it fires: tokens on its outgoing synchronous connections.
    pub sends: Bits<W>,
    /// Cleared when it fires: its outgoing synchronous connections are free.
    pub occupies: Bits<W>,
    /// When all of these hold after it fired, everything downstream has finished, and it is enabled again.
    pub notified_by: Bits<W>,
    /// Set when it is enabled again: itself enabled, its incoming connections free (R4).
    pub notifies: Bits<W>,
    /// The bit "enabled".
    pub enabled: Bits<W>,
    /// All clusters from which tokens come to it, also by way of others: those that send to others of them last.
    pub above: &'static [usize],
}

/// Which conditions hold, and how firing changes them. With `TRACKS` it knows whether a cluster may have become ready since the
/// clusters were looked at last, which is worth its code where there are several.
#[derive(Debug, Clone)]
pub struct Dispatcher<const W: usize, const TRACKS: bool> {
    /// The highest bit is no condition: it says that one holds that did not when the clusters were looked at last.
    holds: Bits<W>,
}

/// The bit for news, in the last word.
const NEWS: u64 = 1 << 63;

impl<const W: usize, const TRACKS: bool> Dispatcher<W, TRACKS> {
    /// The dispatcher of a program that has not fired: `initial` holds.
    pub const fn new(initial: Bits<W>) -> Self {
        let mut holds = initial;
        if TRACKS {
            holds.0[W - 1] |= NEWS;
        }
        Self { holds }
    }

    /// Makes a condition hold: a guard, or a connection that is free again.
    #[inline(always)]
    pub fn raise(&mut self, bit: usize) {
        if TRACKS && !self.has(bit) {
            self.look_again();
        }
        self.holds.0[bit / 64] |= 1 << (bit % 64);
    }

    /// Whether a cluster may have become ready since this was asked last.
    #[inline(always)]
    pub fn take_news(&mut self) -> bool {
        if !TRACKS {
            return true;
        }
        let news = self.holds.0[W - 1] & NEWS != 0;
        self.holds.0[W - 1] &= !NEWS;
        news
    }

    /// A cluster that is ready was not fired.
    #[inline(always)]
    pub fn look_again(&mut self) {
        if TRACKS {
            self.holds.0[W - 1] |= NEWS;
        }
    }

    /// Ends a condition: a connection is occupied.
    #[inline(always)]
    pub fn clear(&mut self, bit: usize) {
        self.holds.0[bit / 64] &= !(1 << (bit % 64));
    }

    /// Whether one condition holds.
    #[inline(always)]
    pub fn has(&self, bit: usize) -> bool {
        self.holds.0[bit / 64] & 1 << (bit % 64) != 0
    }

    /// Whether all of `bits` hold.
    #[inline(always)]
    pub fn holds(&self, bits: &Bits<W>) -> bool {
        self.holds.contains(bits)
    }

    /// Whether others of a cluster's tokens are there, and this one is not.
    pub fn misses(&self, missing: &Missing<W>) -> bool {
        let others = self.holds.0.iter().zip(&missing.others.0).any(|(a, b)| a & b != 0);
        others && !self.has(missing.token)
    }

    /// If `cluster` is ready, takes its tokens and guards and returns `true`: it is to be fired now.
    #[inline(always)]
    pub fn start(&mut self, cluster: &Cluster<W>) -> bool {
        let ready = self.holds.contains(&cluster.waits_for);
        if ready {
            self.holds.remove(&cluster.takes);
        }
        ready
    }

    /// `clusters[index]` has fired: its tokens are sent, and notifications travel upstream.
    ///
    /// Always inlined: the table and the index are constants, so that mostly a few bit operations are left.
    #[inline(always)]
    pub fn finish(&mut self, clusters: &[Cluster<W>], index: usize) {
        let cluster = &clusters[index];
        self.holds.insert(&cluster.sends);
        self.holds.remove(&cluster.occupies);
        self.look_again();
        self.settle(clusters, index);
    }

    /// If everything downstream of `clusters[index]` has finished, notifies it, and those above for which that was
    /// the last.
    #[inline(always)]
    pub fn settle(&mut self, clusters: &[Cluster<W>], index: usize) {
        let cluster = &clusters[index];
        if self.holds.contains(&cluster.enabled) || !self.holds.contains(&cluster.notified_by) {
            return;
        }
        self.holds.insert(&cluster.notifies);
        self.look_again();
        for above in cluster.above.iter().map(|&above| &clusters[above]) {
            // It has fired, and everything downstream of it has finished.
            if !self.holds.contains(&above.enabled) && self.holds.contains(&above.notified_by) {
                self.holds.insert(&above.notifies);
            }
        }
    }
}
