//! Random graphs whose claims are decided twice: by the compiler, and by a search of all states that is written from
//! the sentences of the specification (`net.rs` lists them).
//!
//! `APEX_CLAIM_GRAPHS` is the number of graphs, `APEX_CLAIM_SEED` the first seed. A graph with different verdicts is
//! reduced, and shown with a run of the search.
#![allow(clippy::disallowed_methods, reason = "it reads the environment")]

mod case;
mod dice;
mod explore;
mod generate;
mod judge;
mod net;
mod world;

use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    claims::Verdict,
    graph::{ClaimKind, Graph},
    passes,
    report::{Diagnostic, Diagnostics, Severity},
    source::Sources,
};
use case::Case;
use dice::Dice;
use explore::Explored;
use net::Net;
use std::{
    collections::BTreeMap,
    env,
    fmt::{self, Write as _},
};
use world::Memory;

/// Number of graphs without `APEX_CLAIM_GRAPHS`.
const GRAPHS: u64 = 2000;
/// Largest number of differences that are shown.
const SHOWN: usize = 5;
/// Bound of the compiler's search.
const BOUND: usize = 10_000;
/// Bound for a quarter of the graphs: many of their claims are decided before the search is complete, or remain
/// undecided.
const SMALL_BOUND: usize = 12;

/// Difference between two verdicts.
struct Difference {
    case: Case,
    kind: &'static str,
    verdict: Verdict,
    text: String,
}

impl Difference {
    /// Differences of one class mostly have the same cause.
    fn class(&self) -> String {
        format!("{} {}", self.kind, self.verdict.words())
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n\n{}", self.case, self.text)
    }
}

/// Number of graphs, and of claims of each kind and verdict.
#[derive(Default)]
struct Counts {
    compared: usize,
    /// Graphs with errors, by the code of the first one.
    refused: BTreeMap<&'static str, usize>,
    too_large: usize,
    claims: BTreeMap<(&'static str, &'static str), usize>,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { compared, refused, too_large, claims } = self;
        writeln!(f, "{compared} graphs compared, {too_large} programs too large, refused: {refused:?}")?;
        claims.iter().try_for_each(|((kind, verdict), number)| writeln!(f, "{kind} {verdict}: {number}"))
    }
}

struct Comparison {
    catalog: Catalog,
    counts: Counts,
}

impl Comparison {
    /// Compares the verdicts on a graph, with at most `bound` states for the compiler.
    fn compare(&mut self, case: &Case, bound: usize) -> Vec<Difference> {
        let found = self.compare_text(&case.to_string(), bound);
        found.into_iter().map(|(kind, verdict, text)| Difference { case: case.clone(), kind, verdict, text }).collect()
    }

    /// The different verdicts on the claims of a source file, each with its claim and the verdict of the compiler.
    fn compare_text(&mut self, text: &str, bound: usize) -> Vec<(&'static str, Verdict, String)> {
        let (mut sources, mut diagnostics) = (Sources::default(), Diagnostics::default());
        let root = sources.add("/graphs/p.afg", text);
        let checked = passes::check_all(root, &mut self.catalog, &mut sources, &mut Memory, bound, &mut diagnostics);
        let is_wrong = |d: &&&Diagnostic| d.severity == Severity::Error && d.code != "claim-fails";
        if let Some(error) = diagnostics.sorted().iter().find(is_wrong) {
            *self.counts.refused.entry(error.code).or_default() += 1;
            return vec![];
        }
        self.counts.compared += 1;
        checked.programs.iter().flat_map(|program| self.program(program)).collect()
    }

    fn program(&mut self, program: &CheckedProgram) -> Vec<(&'static str, Verdict, String)> {
        let net = Net::new(&program.graph, &self.catalog);
        let Some((net, explored)) = net.and_then(|net| Explored::new(&net).map(|explored| (net, explored))) else {
            self.counts.too_large += 1;
            return vec![];
        };
        let mut found = vec![];
        for (claim, verdict) in program.graph.claims.iter().zip(&program.claims.verdicts) {
            let violated = judge::violation(&net, &explored, claim);
            *self.counts.claims.entry((claim.kind.word(), verdict.words())).or_default() += 1;
            let agrees = match verdict {
                Verdict::Holds => violated.is_none(),
                Verdict::Fails => violated.is_some(),
                Verdict::Undecided | Verdict::Unchecked => true,
            };
            if !agrees {
                let claimed = program.graph.claim_text(claim);
                let run = violated.map(|number| run(&net, &program.graph, &explored, number));
                let run = run.unwrap_or_else(|| "the explorer finds no run against it\n".to_owned());
                let text = format!("the compiler: `{claimed}` {}\n{run}", verdict.words());
                found.push((claim.kind.word(), *verdict, text));
            }
        }
        found
    }

    /// Removes all that a difference does not need.
    fn reduce(&mut self, mut difference: Difference, bound: usize) -> Difference {
        loop {
            let class = difference.class();
            let mut smaller = difference.case.smaller().into_iter().flat_map(|case| self.compare(&case, bound));
            match smaller.find(|other| other.class() == class) {
                Some(found) => difference = found,
                None => return difference,
            }
        }
    }
}

/// The run to a state in words, with all places of activity after each step.
fn run(net: &Net<'_>, graph: &Graph, explored: &Explored, number: usize) -> String {
    let mut text = format!("the explorer has a run against it:\n  start: {}\n", net.words(net.start()));
    for (step, state) in explored.run(number) {
        let _ = writeln!(text, "  {}: {}", step.words(graph), net.words(state));
    }
    text
}

fn number(name: &str, default: u64) -> u64 {
    env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// Graphs with verdicts that were wrong once: a path on which activity waits for a `cancel` that takes it away, also
/// one of a `reset`, and a `cancel` that waited for the end of the program.
const KNOWN: [&str; 3] = [
    "graph P {
        node a = Turn();
        node b = Turn();
        start => b.enable;
        start => a.s;
        a.l => b.t;
        b.r => a.t;
        a.r => a.cancel;
        claim reaches(a, b);
    }",
    "graph P {
        node a = Turn();
        node b = Turn();
        node c = Rest();
        start => a.s;
        start => a.t;
        a.r => reset;
        a.l => b.s;
        claim reaches(a, b);
        claim reaches(a, c);
    }",
    "graph P {
        node a = Turn();
        node b = Mixed();
        start -> a.cancel;
        start => b.s;
        b.out => a.t;
        a.cancelled => exit;
        a.cancelled => b.x;
        claim reaches(a, b);
    }",
];

#[test]
fn verdicts_that_were_wrong_are_right() {
    let mut comparison = Comparison { catalog: world::catalog(), counts: Counts::default() };
    for text in KNOWN {
        for bound in [1, SMALL_BOUND, BOUND] {
            let different = comparison.compare_text(text, bound);
            assert!(different.is_empty(), "{text}\n{}", different[0].2);
        }
    }
    assert_eq!(comparison.counts.compared, 3 * KNOWN.len(), "{}", comparison.counts);
}

/// Claims of a kind, of which so many must hold, and as many fail, for each hundred graphs.
const EXPECTED: [(ClaimKind, u64); 3] =
    [(ClaimKind::Exclusive, 6), (ClaimKind::Reaches, 15), (ClaimKind::Conserved, 12)];

#[test]
fn verdicts_follow_from_the_specification() {
    let (count, first) = (number("APEX_CLAIM_GRAPHS", GRAPHS), number("APEX_CLAIM_SEED", 1));
    let mut comparison = Comparison { catalog: world::catalog(), counts: Counts::default() };
    let mut different: BTreeMap<String, Vec<(u64, Difference, usize)>> = BTreeMap::new();
    for seed in first..first + count {
        let case = generate::generate(&mut Dice(seed.wrapping_mul(0x1234_5678_9abc_def1)));
        let bound = if seed % 4 == 0 { SMALL_BOUND } else { BOUND };
        for found in comparison.compare(&case, bound) {
            different.entry(found.class()).or_default().push((seed, found, bound));
        }
    }
    let counts = std::mem::take(&mut comparison.counts);
    println!("{count} graphs, APEX_CLAIM_SEED={first}: {counts}");
    let is_same = different.is_empty();
    for (class, mut found) in different {
        println!("\n=== {class}: {} differences", found.len());
        found.sort_by_key(|(_, difference, _)| difference.case.size());
        for (seed, difference, bound) in found.into_iter().take(SHOWN) {
            println!("--- seed {seed}\n{}", comparison.reduce(difference, bound));
        }
    }
    assert!(is_same, "verdicts differ");
    // A few graphs, for example one with a known seed, need not have them all.
    for (kind, least) in EXPECTED.into_iter().filter(|_| count >= GRAPHS / 2) {
        for verdict in [Verdict::Holds, Verdict::Fails] {
            let number = counts.claims.get(&(kind.word(), verdict.words())).copied().unwrap_or(0) as u64;
            let (word, verdict) = (kind.word(), verdict.words());
            assert!(number >= least * count / 100, "`{word}` {verdict} only {number} times: the graphs are too simple");
        }
    }
}
