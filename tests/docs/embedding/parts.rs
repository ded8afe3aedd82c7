use apex_macros::graph;
use apex_rt::prelude::*;

/// Sends lines that were read beforehand.
#[node]
pub struct Lines {
    left: std::vec::IntoIter<String>,
}

impl Lines {
    /// Those of `text`.
    pub fn of(text: &str) -> Self {
        Self { left: text.lines().map(str::to_owned).collect::<Vec<_>>().into_iter() }
    }
}

#[node]
impl Lines {
    fn process(&mut self) -> Option<String> {
        self.left.next()
    }
}

/// Keeps the longest line.
#[node]
#[derive(Default)]
pub struct Longest {
    pub line: String,
}

#[node]
impl Longest {
    fn process(&mut self, line: &String) {
        if line.len() > self.line.len() {
            self.line.clone_from(line);
        }
    }
}

graph! {
    robot Reader {
        node lines: Lines;
        node longest = Longest();
        lines -> longest;
    }
}

pub fn main() {
    let mut reader = Reader::new(ReaderParts { lines: Lines::of("one\nthree\nfive") });
    for _ in 0..4 {
        reader.react(Time::ZERO);
    }
    assert_eq!(reader.nodes().longest.line, "three");
}
