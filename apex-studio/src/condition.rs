//! Conditions at which a robot halts: `active(a) && !(active(b) || active(c.d))`.

use apex_dsl::report::nearest;
use apex_rt::studio::message::{About, Test};

/// Maximum length of a condition in bytes.
const MAX_LENGTH: usize = 1000;

/// Reads a condition on the nodes of a robot. An empty text is an empty condition.
///
/// # Errors
/// The text is not a condition, or names a node that the robot does not have.
pub fn parse(text: &str, about: &About) -> Result<Vec<Test>, String> {
    if text.len() > MAX_LENGTH {
        return Err(format!("a condition has at most {MAX_LENGTH} characters"));
    }
    let mut parser = Parser { text, at: 0, about, tests: vec![] };
    if parser.rest().is_empty() {
        return Ok(vec![]);
    }
    parser.any()?;
    if !parser.rest().is_empty() {
        return Err(parser.expected("`&&`, `||` or the end"));
    }
    Ok(parser.tests)
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    about: &'a About,
    tests: Vec<Test>,
}

impl Parser<'_> {
    /// The text that has not been read, without spaces before it.
    fn rest(&mut self) -> &str {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        &self.text[self.at..]
    }

    fn takes(&mut self, word: &str) -> bool {
        let is = self.rest().starts_with(word);
        self.at += if is { word.len() } else { 0 };
        is
    }

    fn expected(&self, what: &str) -> String {
        format!("column {}: {what} expected", self.text[..self.at].chars().count() + 1)
    }

    fn any(&mut self) -> Result<(), String> {
        self.all()?;
        while self.takes("||") {
            self.all()?;
            self.tests.push(Test::Or);
        }
        Ok(())
    }

    fn all(&mut self) -> Result<(), String> {
        self.one()?;
        while self.takes("&&") {
            self.one()?;
            self.tests.push(Test::And);
        }
        Ok(())
    }

    fn one(&mut self) -> Result<(), String> {
        // A loop, so that a long row of `!` needs no stack.
        let mut inverted = false;
        while self.takes("!") {
            inverted = !inverted;
        }
        if self.takes("active") {
            self.close("(", Self::node)?;
        } else if self.rest().starts_with('(') {
            self.close("(", Self::any)?;
        } else {
            return Err(self.expected("`active(…)`, `!` or `(`"));
        }
        self.tests.extend(inverted.then_some(Test::Not));
        Ok(())
    }

    fn close(&mut self, open: &str, inside: impl FnOnce(&mut Self) -> Result<(), String>) -> Result<(), String> {
        if !self.takes(open) {
            return Err(self.expected("`(`"));
        }
        inside(self)?;
        if self.takes(")") { Ok(()) } else { Err(self.expected("`)`")) }
    }

    /// The name of a node, or of a nested graph.
    fn node(&mut self) -> Result<(), String> {
        let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
        let rest = self.rest();
        let name = rest[..rest.find(|c| !is_part(c)).unwrap_or(rest.len())].to_owned();
        let nodes = self.about.nodes.iter().enumerate();
        let is_meant = |of: &str| of.strip_prefix(&name).is_some_and(|end| end.is_empty() || end.starts_with('.'));
        let meant: Vec<u32> = nodes.filter(|(_, node)| is_meant(&node.name)).map(|(at, _)| at as u32).collect();
        if name.is_empty() || meant.is_empty() {
            let near = nearest(&name, self.about.nodes.iter().map(|node| node.name.as_str()));
            let near = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            return Err(format!("there is no node `{name}`{near}"));
        }
        self.at += name.len();
        self.tests.push(Test::Active(meant));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::robot;

    fn about() -> About {
        robot(&["a", "b.c", "b.d", "bc"])
    }

    #[test]
    fn conditions_mean_what_they_say() {
        let holds = |text: &str, active: &[u32]| Test::holds(&parse(text, &about()).unwrap(), |n| active.contains(&n));
        assert!(holds("active(a)&&!active( b )", &[0, 3]));
        assert!(!holds("active(a) && !active(b)", &[0, 2]));
        assert!(holds("!!(active(b.c) || active(bc)) && active(a)", &[0, 3]));
        // `&&` binds more strongly than `||`.
        assert!(holds("active(a) || active(b) && active(bc)", &[0]));
        assert!(!holds("(active(a) || active(b)) && active(bc)", &[0]));
        assert!(!holds("", &[0]));
    }

    #[test]
    fn mistakes_are_explained() {
        let error = |text: &str| parse(text, &about()).unwrap_err();
        assert_eq!(error("active(a) and active(b)"), "column 11: `&&`, `||` or the end expected");
        assert_eq!(error("active(aa)"), "there is no node `aa`; did you mean `a`?");
        assert_eq!(error("active(a"), "column 9: `)` expected");
        assert_eq!(error("!é"), "column 2: `active(…)`, `!` or `(` expected");
        assert!(parse(&"(".repeat(900), &about()).is_err());
        assert!(error(&"!".repeat(2000)).contains("at most"));
    }
}
