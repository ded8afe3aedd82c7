//! Generates `mixed1000`: ten regions of 100 nodes, chosen pseudo-randomly and joined by events. The results are a
//! graph, straight-line Rust, and Rust in which the control flow follows the presence of messages.

use std::{collections::BTreeSet, fmt::Write as _};

const REGIONS: usize = 10;
const SIZE: usize = 100;

/// Kind of a node, with the nodes from which it takes messages.
#[derive(Clone, Copy)]
enum Kind {
    Source,
    Op(usize),
    Join(usize, usize),
    Filter(usize),
    /// Also sends its value as an event to the source of a region.
    Emitter(usize, usize),
}

impl Kind {
    fn inputs(self) -> Vec<usize> {
        match self {
            Self::Source => vec![],
            Self::Op(a) | Self::Filter(a) | Self::Emitter(a, _) => vec![a],
            Self::Join(a, b) => vec![a, b],
        }
    }
}

/// Random numbers (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// All nodes; a node is identified by its index.
fn nodes() -> Vec<Kind> {
    let mut random = Random(0xAF6);
    (0..REGIONS * SIZE).map(|k| choose(&mut random, k / SIZE, k % SIZE)).collect()
}

fn choose(random: &mut Random, region: usize, j: usize) -> Kind {
    if j == 0 {
        return Kind::Source;
    }
    let lowest = j.saturating_sub(16);
    let pick = |random: &mut Random| SIZE * region + lowest + random.below(j - lowest);
    match random.below(100) {
        0..60 => Kind::Op(pick(random)),
        60..83 => {
            let a = pick(random);
            Kind::Join(a, pick(random))
        }
        83..98 => Kind::Filter(pick(random)),
        _ if region + 1 == REGIONS => Kind::Op(pick(random)),
        _ => {
            let from = pick(random);
            Kind::Emitter(from, region + 1 + random.below(REGIONS - 1 - region))
        }
    }
}

/// Nodes whose messages no other node takes.
fn sinks(nodes: &[Kind]) -> Vec<usize> {
    let taken: BTreeSet<usize> = nodes.iter().flat_map(|n| n.inputs()).collect();
    (0..nodes.len()).filter(|k| !taken.contains(k)).collect()
}

/// Regions that ever run: events go to later regions only.
fn reached(nodes: &[Kind]) -> BTreeSet<usize> {
    let mut reached = BTreeSet::from([0]);
    for (k, kind) in nodes.iter().enumerate() {
        if let Kind::Emitter(_, target) = kind
            && reached.contains(&(k / SIZE))
        {
            reached.insert(*target);
        }
    }
    reached
}

/// The graph. Several emitters send to one region, but an input takes one connection. Therefore their events go to one
/// slot of a relay, whose event drives the source of the region.
pub fn graph() -> String {
    let nodes = nodes();
    let mut text = "/// Ten regions of 100 nodes, joined by events.\ngraph Mixed1000 {\n".to_owned();
    let mut connections = String::new();
    let port = |from: usize| match nodes[from] {
        Kind::Emitter(..) => format!("n{from}.out"),
        _ => format!("n{from}"),
    };
    for (k, kind) in nodes.iter().enumerate() {
        let made = match kind {
            Kind::Source if k == 0 => "Count()".to_owned(),
            Kind::Source => "pass()".to_owned(),
            Kind::Op(_) => format!("op(k = {k})"),
            Kind::Join(..) => format!("merge(k = {k})"),
            Kind::Filter(_) => "gate()".to_owned(),
            Kind::Emitter(..) => format!("tell(k = {k})"),
        };
        let _ = writeln!(text, "    node n{k} = {made};");
        if k > 0 && matches!(kind, Kind::Source) {
            let _ = writeln!(text, "    node r{k} = Relay();");
            let _ = writeln!(connections, "    r{k}.e -> n{k};");
        }
        let inputs = kind.inputs();
        let _ = match &inputs[..] {
            [] => Ok(()),
            [a] => writeln!(connections, "    {} -> n{k};", port(*a)),
            more => more
                .iter()
                .zip(["a", "b"])
                .try_for_each(|(from, to)| writeln!(connections, "    {} -> n{k}.{to};", port(*from))),
        };
        if let Kind::Emitter(_, region) = kind {
            let _ = writeln!(connections, "    n{k}.e -> r{}.s;", SIZE * region);
        }
    }
    for k in sinks(&nodes) {
        let _ = writeln!(text, "    node s{k} = Weigh(k = {k});");
        let _ = writeln!(connections, "    {} -> s{k};", port(k));
    }
    text + "\n" + &connections + "}\n"
}

/// Both hand-written programs, and the function that sums up the sinks of the compiled one.
pub fn rust() -> String {
    let nodes = nodes();
    let mut text = "//! Generated: the regions of `mixed1000` by hand. Each function is one tick of a region.\n\n\
                    use crate::{graphs::Mixed1000, nodes::{gate, merge, op, weigh}};\n"
        .to_owned();
    let reached = reached(&nodes);
    for &region in &reached {
        straight(&mut text, &nodes, region);
    }
    for &region in &reached {
        clocked(&mut text, &nodes, region);
    }
    text.push_str(
        "\n/// Sum of all sinks.\npub fn checksum(graph: &Mixed1000) -> u64 {\n    let n = graph.nodes();\n    [\n",
    );
    for k in sinks(&nodes) {
        let _ = writeln!(text, "        n.s{k}.sum(),");
    }
    text + "    ]\n    .into_iter()\n    .fold(0, u64::wrapping_add)\n}\n"
}

/// Writes one `let` per node, with ⊥ as `None`.
fn straight(text: &mut String, nodes: &[Kind], region: usize) {
    let first = SIZE * region;
    let _ = write!(
        text,
        "\n/// Region {region}, node by node.\npub fn region{region}(n{first}: u64, mut acc: u64) -> u64 {{\n    \
         let n{first} = Some(n{first});\n"
    );
    for (k, kind) in nodes.iter().enumerate().skip(first + 1).take(SIZE - 1) {
        let value = match kind {
            Kind::Source => continue,
            Kind::Op(a) | Kind::Emitter(a, _) => format!("n{a}.map(|x| op(&x, {k}))"),
            Kind::Join(a, b) => format!("n{a}.zip(n{b}).map(|(a, b)| merge(&a, &b, {k}))"),
            Kind::Filter(a) => format!("n{a}.and_then(|x| gate(&x))"),
        };
        let _ = writeln!(text, "    let n{k} = {value};");
    }
    for k in sinks(nodes).into_iter().filter(|k| k / SIZE == region) {
        let _ = writeln!(text, "    if let Some(x) = n{k} {{\n        acc = weigh(acc, x, {k});\n    }}");
    }
    for (k, kind) in nodes.iter().enumerate().skip(first).take(SIZE) {
        if let Kind::Emitter(_, target) = kind {
            let _ = writeln!(text, "    if let Some(x) = n{k} {{\n        acc = region{target}(x, acc);\n    }}");
        }
    }
    text.push_str("    acc\n}\n");
}

/// Filters that must pass a message for a node to receive one.
type Clock = BTreeSet<usize>;

/// Writes nodes inside an `if` for each set of filters.
fn clocked(text: &mut String, nodes: &[Kind], region: usize) {
    let first = SIZE * region;
    let mut clocks: Vec<Clock> = vec![Clock::new()];
    for (k, kind) in nodes.iter().enumerate().skip(first + 1).take(SIZE - 1) {
        let mut clock: Clock = kind.inputs().iter().flat_map(|i| clocks[i - first].clone()).collect();
        if matches!(kind, Kind::Filter(_)) {
            clock.insert(k);
        }
        clocks.push(clock);
    }
    let _ = write!(
        text,
        "\n/// Region {region}, as control flow.\npub fn clock{region}(n{first}: u64, mut acc: u64) -> u64 {{\n"
    );
    for (k, clock) in (first..).zip(&clocks) {
        if !clock.is_empty() {
            let filter = matches!(nodes[k], Kind::Filter(_));
            let _ = writeln!(
                text,
                "    let mut n{k} = 0;{}",
                if filter { format!(" let mut c{k} = false;") } else { String::new() }
            );
        }
    }
    let sinks = sinks(nodes).into_iter().filter(|k| k / SIZE == region).collect();
    let mut writer = Clocked { text, nodes, first, clocks: &clocks, sinks, done: BTreeSet::from([first]) };
    if writer.sinks.contains(&first) {
        let _ = writeln!(writer.text, "    acc = weigh(acc, n{first}, {first});");
    }
    writer.block(&Clock::new(), 1);
    text.push_str("    acc\n}\n");
}

struct Clocked<'a> {
    text: &'a mut String,
    nodes: &'a [Kind],
    first: usize,
    clocks: &'a [Clock],
    sinks: BTreeSet<usize>,
    done: BTreeSet<usize>,
}

impl Clocked<'_> {
    fn clock(&self, k: usize) -> &Clock {
        &self.clocks[k - self.first]
    }

    /// Condition for the computation of a node. A filter itself only needs a message at its input.
    fn needed(&self, k: usize) -> Clock {
        let mut clock = self.clock(k).clone();
        clock.remove(&k);
        clock
    }

    fn ready(&self) -> Vec<usize> {
        let is_ready =
            |k: &usize| !self.done.contains(k) && self.nodes[*k].inputs().iter().all(|i| self.done.contains(i));
        (self.first..self.first + SIZE).filter(is_ready).collect()
    }

    /// Writes all nodes that can be computed where `clock` holds.
    fn block(&mut self, clock: &Clock, depth: usize) {
        loop {
            let ready = self.ready();
            if let Some(k) = ready.iter().find(|k| self.needed(**k) == *clock) {
                self.node(*k, clock, depth);
                continue;
            }
            let inner = ready.iter().map(|k| self.needed(*k)).filter(|c| c.is_superset(clock)).min_by_key(Clock::len);
            let Some(inner) = inner else { break };
            let flags: Vec<String> =
                inner.difference(clock).filter(|f| !self.implied(**f, &inner)).map(|f| format!("c{f}")).collect();
            let _ = writeln!(self.text, "{}if {} {{", "    ".repeat(depth), flags.join(" && "));
            self.block(&inner, depth + 1);
            let _ = writeln!(self.text, "{}}}", "    ".repeat(depth));
        }
    }

    /// `true` if another filter of `clock` comes after `filter`.
    fn implied(&self, filter: usize, clock: &Clock) -> bool {
        clock.iter().any(|other| *other != filter && self.clock(*other).contains(&filter))
    }

    fn node(&mut self, k: usize, clock: &Clock, depth: usize) {
        let indent = "    ".repeat(depth);
        let bind = if clock.is_empty() && !matches!(self.nodes[k], Kind::Filter(_)) { "let " } else { "" };
        let weigh = if self.sinks.contains(&k) { format!("acc = weigh(acc, n{k}, {k});") } else { String::new() };
        let line = match self.nodes[k] {
            Kind::Source => String::new(),
            Kind::Op(a) => format!("{bind}n{k} = op(&n{a}, {k}); {weigh}"),
            Kind::Join(a, b) => format!("{bind}n{k} = merge(&n{a}, &n{b}, {k}); {weigh}"),
            Kind::Emitter(a, region) => format!("{bind}n{k} = op(&n{a}, {k}); {weigh} acc = clock{region}(n{k}, acc);"),
            Kind::Filter(a) => format!("if let Some(x) = gate(&n{a}) {{ n{k} = x; c{k} = true; {weigh} }}"),
        };
        let _ = writeln!(self.text, "{indent}{}", line.trim_end());
        self.done.insert(k);
    }
}
