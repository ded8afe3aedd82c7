//! Decides at run time which cluster fires: for every cluster the set of things it waits for is a set of
//! bits, and it is ready when all of them are set. All state has a size known at compile time.

/// A set of `64·W` conditions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bits<const W: usize>(pub [u64; W]);

impl<const W: usize> Bits<W> {
    /// The empty set.
    pub const NONE: Self = Self([0; W]);

    /// The set of the given conditions.
    pub const fn of(bits: &[u32]) -> Self {
        let mut words = [0; W];
        let mut i = 0;
        while i < bits.len() {
            words[bits[i] as usize / 64] |= 1 << (bits[i] % 64);
            i += 1;
        }
        Self(words)
    }

    /// Whether a condition holds.
    #[inline(always)]
    pub const fn has(&self, bit: usize) -> bool {
        self.0[bit / 64] & 1 << (bit % 64) != 0
    }

    /// Makes a condition hold, or ends it.
    #[inline(always)]
    pub const fn set(&mut self, bit: usize, holds: bool) {
        let (word, mask) = (&mut self.0[bit / 64], 1 << (bit % 64));
        if holds { *word |= mask } else { *word &= !mask }
    }

    /// Ends a condition. Returns `true` if it held.
    #[inline(always)]
    pub const fn take(&mut self, bit: usize) -> bool {
        let held = self.has(bit);
        self.set(bit, false);
        held
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

/// Conditions that are known at compile time: a set of bits where a program has few conditions, a list of their numbers where it
/// has many, so that neither data nor time grow with those that are not meant.
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
        self.iter().any(|bit| holds.has(*bit as usize))
    }

    #[inline]
    fn put_into(&self, holds: &mut Bits<W>, value: bool) {
        self.iter().for_each(|bit| holds.set(*bit as usize, value));
    }
}

/// A token from an event that a cluster needs besides others (static data).
#[derive(Debug)]
pub struct Missing<S> {
    /// The bits of the cluster's other tokens.
    pub others: S,
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
pub struct Cluster<S> {
    /// Its events are free: what must hold for it to fire besides `takes`.
    waits_for: S,
    /// Its guards, the tokens on all incoming connections, and itself enabled: they must hold, and firing uses them up.
    takes: S,
    /// Set when it fires: tokens on its outgoing synchronous connections.
    sends: S,
    /// Cleared when it fires: its outgoing synchronous connections are free.
    occupies: S,
    /// When all of these hold after it fired, everything downstream has finished, and it is enabled again.
    notified_by: S,
    /// Set when it is enabled again: itself enabled, its incoming connections free (R4).
    notifies: S,
    /// The bit "enabled".
    enabled: usize,
    /// All clusters from which tokens come to it, also by way of others: those that send to others of them last.
    above: &'static [u32],
}

/// Numbers of conditions in a row of a table.
type List = &'static [u32];

impl<const W: usize> Cluster<Bits<W>> {
    /// A row of the table, its sets in the order of the fields.
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
    /// A row of the table of a program with many conditions.
    pub const fn sparse(enabled: usize, sets: [List; 6], above: List) -> Self {
        let [waits_for, takes, sends, occupies, notified_by, notifies] = sets;
        Self { waits_for, takes, sends, occupies, notified_by, notifies, enabled, above }
    }
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
        self.holds.set(bit, true);
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
        self.holds.set(bit, false);
    }

    /// Whether one condition holds.
    #[inline(always)]
    pub fn has(&self, bit: usize) -> bool {
        self.holds.has(bit)
    }

    /// Whether all of `conditions` hold.
    #[inline(always)]
    pub fn holds(&self, conditions: &impl Conditions<W>) -> bool {
        conditions.hold_in(&self.holds)
    }

    /// Whether others of a cluster's tokens are there, and this one is not.
    pub fn misses(&self, missing: &Missing<impl Conditions<W>>) -> bool {
        missing.others.meet(&self.holds) && !self.has(missing.token)
    }

    /// If `cluster` is ready, takes its tokens and guards and returns `true`: it is to be fired now.
    #[inline(always)]
    pub fn start(&mut self, cluster: &Cluster<impl Conditions<W>>) -> bool {
        let ready = cluster.takes.hold_in(&self.holds) && cluster.waits_for.hold_in(&self.holds);
        if ready {
            cluster.takes.put_into(&mut self.holds, false);
        }
        ready
    }

    /// `clusters[index]` has fired: its tokens are sent, and notifications travel upstream.
    ///
    /// Always inlined: the table and the index are constants, so that mostly a few bit operations are left.
    #[inline(always)]
    pub fn finish(&mut self, clusters: &[Cluster<impl Conditions<W>>], index: usize) {
        let cluster = &clusters[index];
        cluster.sends.put_into(&mut self.holds, true);
        cluster.occupies.put_into(&mut self.holds, false);
        self.look_again();
        self.settle(clusters, index);
    }

    /// If everything downstream of `clusters[index]` has finished, notifies it, and those above for which that was
    /// the last.
    #[inline(always)]
    pub fn settle(&mut self, clusters: &[Cluster<impl Conditions<W>>], index: usize) {
        let cluster = &clusters[index];
        if self.has(cluster.enabled) || !cluster.notified_by.hold_in(&self.holds) {
            return;
        }
        cluster.notifies.put_into(&mut self.holds, true);
        self.look_again();
        for above in cluster.above.iter().map(|&above| &clusters[above as usize]) {
            // It has fired, and everything downstream of it has finished.
            if !self.has(above.enabled) && above.notified_by.hold_in(&self.holds) {
                above.notifies.put_into(&mut self.holds, true);
            }
        }
    }
}
