//! `#[cfg(…)]`: the conditions under which items of a crate exist.

use std::collections::BTreeSet;

/// Knowledge about a condition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    /// The condition holds.
    Yes,
    /// The condition does not hold.
    No,
    /// Only rustc can decide.
    Unknown,
}

/// Conditions of a compilation that hold, as printed by `rustc --print cfg`, one per line. Empty if rustc was not run.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Conditions(pub BTreeSet<String>);

/// Largest depth of nested conditions; deeper ones are unknown.
const MAX_DEPTH: usize = 16;

impl Conditions {
    /// Evaluates the tokens of a `cfg` in a crate with these features. In the package's own crates all conditions are
    /// known. For other crates, build scripts may set more.
    pub fn evaluate(&self, cfg: &str, features: &BTreeSet<String>, is_own: bool) -> Truth {
        let compact: String = cfg.chars().filter(|c| !c.is_whitespace()).collect();
        Evaluation { conditions: self, features, is_own }.part(&compact, 0)
    }
}

struct Evaluation<'a> {
    conditions: &'a Conditions,
    features: &'a BTreeSet<String>,
    is_own: bool,
}

impl Evaluation<'_> {
    fn part(&self, cfg: &str, depth: usize) -> Truth {
        if depth > MAX_DEPTH {
            return Truth::Unknown;
        }
        let inner = |prefix: &str| cfg.strip_prefix(prefix)?.strip_suffix(')');
        let parts = |of: &str| -> Vec<Truth> { split(of).iter().map(|p| self.part(p, depth + 1)).collect() };
        if let Some(of) = inner("not(") {
            return self.part(of, depth + 1).not();
        }
        if let Some(of) = inner("all(") {
            return all(&parts(of));
        }
        if let Some(of) = inner("any(") {
            // De Morgan: one of them holds if not all do not.
            return all(&parts(of).into_iter().map(Truth::not).collect::<Vec<_>>()).not();
        }
        self.plain(cfg)
    }

    fn plain(&self, cfg: &str) -> Truth {
        let of = |holds| if holds { Truth::Yes } else { Truth::No };
        match cfg.strip_prefix("feature=\"").and_then(|f| f.strip_suffix('"')) {
            Some(feature) => of(self.features.contains(feature)),
            None if cfg == "false" => Truth::No,
            None if cfg == "true" => Truth::Yes,
            // A dependency is never compiled as a test.
            None if cfg == "test" && !self.is_own => Truth::No,
            None if cfg == "test" => of(self.conditions.0.contains(cfg)),
            None if self.conditions.0.is_empty() || !(self.is_own || is_of_target(cfg)) => Truth::Unknown,
            None => of(self.conditions.0.contains(cfg)),
        }
    }
}

/// Returns `true` for a condition that rustc sets for the target, and thus for all crates.
fn is_of_target(cfg: &str) -> bool {
    cfg == "unix" || cfg == "windows" || cfg.starts_with("target_")
}

impl Truth {
    fn not(self) -> Self {
        match self {
            Self::Yes => Self::No,
            Self::No => Self::Yes,
            Self::Unknown => Self::Unknown,
        }
    }
}

fn all(parts: &[Truth]) -> Truth {
    match () {
        () if parts.contains(&Truth::No) => Truth::No,
        () if parts.contains(&Truth::Unknown) => Truth::Unknown,
        () => Truth::Yes,
    }
}

/// Parts between the commas outside of brackets.
fn split(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut parts) = (0, 0, vec![]);
    for (i, c) in list.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&list[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&list[start..]);
    parts.retain(|p| !p.is_empty());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conditions() {
        let features = BTreeSet::from(["std".to_owned()]);
        let linux = Conditions(["unix", "target_os=\"linux\""].map(str::to_owned).into());
        for (cfg, expected, unasked) in [
            ("feature = \"std\"", Truth::Yes, Truth::Yes),
            ("feature = \"gui\"", Truth::No, Truth::No),
            ("not (feature = \"std\")", Truth::No, Truth::No),
            ("all (feature = \"std\" , not (feature = \"gui\"))", Truth::Yes, Truth::Yes),
            ("any (feature = \"gui\" , feature = \"std\")", Truth::Yes, Truth::Yes),
            ("test", Truth::No, Truth::No),
            ("target_os = \"none\"", Truth::No, Truth::Unknown),
            ("tuned", Truth::No, Truth::Unknown),
            ("any ()", Truth::No, Truth::No),
            ("not (windows)", Truth::Yes, Truth::Unknown),
            ("all (unix, feature = \"gui\")", Truth::No, Truth::No),
            ("any (windows, unix)", Truth::Yes, Truth::Unknown),
        ] {
            assert_eq!(linux.evaluate(cfg, &features, true), expected, "{cfg}");
            assert_eq!(Conditions::default().evaluate(cfg, &features, true), unasked, "{cfg}");
        }
        assert_eq!(linux.evaluate("tuned", &features, false), Truth::Unknown);
        assert_eq!(linux.evaluate("windows", &features, false), Truth::No);
    }
}
