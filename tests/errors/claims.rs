//! Claims about random small graphs, compared with an independent enumeration of all states.

use super::compile::{catalog, compile, folder};
use std::collections::{HashMap, HashSet, VecDeque};

/// Number of nodes of each graph.
const NODES: usize = 4;
/// Number of graphs.
const CASES: u64 = 200;

/// A graph. Node `i` has the events `l` and `r`, which lead to these nodes. The node `calmed` loses activity from
/// outside.
struct Case {
    leads: Vec<[Vec<usize>; 2]>,
    begins: Vec<usize>,
    calmed: Option<usize>,
}

/// A state: active nodes, and tokens with activity as (node, event, target).
type State = (Vec<bool>, Vec<(usize, usize, usize)>);

fn random(seed: &mut u64, below: u64) -> usize {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed % below) as usize
}

impl Case {
    fn new(number: u64) -> Self {
        let mut seed = (number + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mut leads = vec![];
        for node in 0..NODES {
            let mut event = || {
                let count = [0, 1, 1, 1, 2][random(&mut seed, 5)];
                let mut to: Vec<usize> = (0..count).map(|_| random(&mut seed, NODES as u64)).collect();
                to.retain(|to| *to != node);
                to.dedup();
                to
            };
            leads.push([event(), event()]);
        }
        let mut begins = vec![0];
        if random(&mut seed, 3) == 0 {
            begins.push(1 + random(&mut seed, 3));
        }
        let calmed = (random(&mut seed, 4) == 0).then(|| random(&mut seed, NODES as u64));
        Self { leads, begins, calmed }
    }

    fn text(&self) -> String {
        let mut text = "graph Case {\n    node outside = Ramp();\n".to_owned();
        for node in 0..NODES {
            text += &format!("    node n{node} = Turn();\n");
        }
        for node in &self.begins {
            text += &format!("    start => n{node};\n");
        }
        for (node, events) in self.leads.iter().enumerate() {
            for (event, to) in ["l", "r"].iter().zip(events) {
                text.extend(to.iter().map(|to| format!("    n{node}.{event} => n{to}.s;\n")));
            }
        }
        if let Some(node) = self.calmed {
            text += &format!("    node calm = Calm();\n    outside -> calm.s;\n    calm.e => n{node}.s;\n");
        }
        text + "    claim exclusive(n1, n2);\n    claim reaches(n1, n3);\n    claim conserved;\n}\n"
    }

    fn initial(&self) -> State {
        ((0..NODES).map(|n| self.begins.contains(&n)).collect(), vec![])
    }

    fn next(&self, (active, tokens): &State) -> Vec<State> {
        let mut next = vec![];
        for node in (0..NODES).filter(|n| active[*n]) {
            let mut without = active.clone();
            without[node] = false;
            for event in 0..2 {
                let to = &self.leads[node][event];
                // A node triggers an event only while all its events are free.
                if to.is_empty() || tokens.iter().any(|t| t.0 == node) {
                    continue;
                }
                let mut tokens = tokens.clone();
                tokens.extend(to.iter().map(|to| (node, event, *to)));
                tokens.sort_unstable();
                next.push((without.clone(), tokens));
            }
            if self.calmed == Some(node) {
                next.push((without.clone(), tokens.clone()));
            }
        }
        for taken in tokens {
            let mut active = active.clone();
            active[taken.2] = true;
            next.push((active, tokens.iter().copied().filter(|t| t != taken).collect()));
        }
        next
    }

    /// All states, each with the length of a shortest run to it.
    fn states(&self, from: State) -> HashMap<State, usize> {
        let mut found = HashMap::from([(from.clone(), 1)]);
        let mut waiting = VecDeque::from([from]);
        while let Some(state) = waiting.pop_front() {
            let length = found[&state];
            for next in self.next(&state) {
                if !found.contains_key(&next) {
                    found.insert(next.clone(), length + 1);
                    waiting.push_back(next);
                }
            }
        }
        found
    }

    /// For each claim, the length of a shortest run that violates it.
    fn broken(&self) -> [Option<usize>; 3] {
        let states = self.states(self.initial());
        let given = self.begins.len();
        // States from which `n3` can be reached: predecessors are added until there are no more.
        let mut before: HashMap<State, Vec<&State>> = HashMap::new();
        for state in states.keys() {
            self.next(state).into_iter().for_each(|next| before.entry(next).or_default().push(state));
        }
        let mut arriving: HashSet<&State> = HashSet::new();
        let mut waiting: Vec<&State> = states.keys().filter(|s| s.0[3]).collect();
        while let Some(state) = waiting.pop() {
            if arriving.insert(state) {
                waiting.extend(before.get(state).into_iter().flatten());
            }
        }
        let amount = |s: &State| s.0.iter().filter(|a| **a).count() + s.1.len();
        let shortest =
            |bad: &dyn Fn(&State) -> bool| states.iter().filter(|(s, _)| bad(s)).map(|(_, length)| *length).min();
        [
            shortest(&|s| s.0[1] && s.0[2]),
            shortest(&|s| s.0[1] && !arriving.contains(s)),
            shortest(&|s| amount(s) != given),
        ]
    }
}

#[test]
fn claims_are_decided_as_by_enumeration() {
    let mut catalog = catalog();
    let (mut held, mut kinds) = (0, HashSet::new());
    for number in 0..CASES {
        let case = Case::new(number);
        let text = case.text();
        let compiled = compile(&folder().join("texts/case.afg"), &text, &mut catalog);
        let found = compiled.diagnostics.sorted();
        let words = ["claim exclusive", "claim reaches", "claim conserved"];
        for (word, expected) in words.into_iter().zip(case.broken()) {
            let failure = found
                .iter()
                .find(|d| d.code == "claim-fails" && compiled.sources.text(d.primary.span).starts_with(word));
            let steps = failure.map(|d| {
                let runs = d.notes.iter().filter_map(|note| note.strip_prefix("run: "));
                runs.map(|run| run.split("; ").count()).sum::<usize>()
            });
            assert_eq!(steps, expected, "{word} of case {number}:\n{text}");
            held += usize::from(expected.is_none());
            kinds.extend(expected.map(|_| word));
        }
        let others: Vec<_> =
            found.iter().filter(|d| !["claim-fails", "never-activated", "stuck"].contains(&d.code)).collect();
        assert!(others.iter().all(|d| d.code == "never-leaves"), "{others:?}\n{text}");
    }
    assert!(held > 100 && kinds.len() == 3, "{held} claims hold, of {kinds:?} some fail");
}
