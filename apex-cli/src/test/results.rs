//! Results of tests, read from the output of Rust's tests.

use serde_json::{Value, json};
use std::time::Duration;

/// Result of a test.
#[derive(Debug, PartialEq, Eq)]
pub struct Tested {
    /// Name in the source file.
    pub name: String,
    /// `true` if it passed.
    pub passed: bool,
    /// Output of a failed test.
    pub output: String,
}

/// Results in the output of a program with tests, in the order of `names`: tests end in any order.
pub fn read(output: &str, names: &[String]) -> Vec<Tested> {
    let mut tests: Vec<(String, Tested)> = vec![];
    // Number of the test whose output is being read.
    let mut of = None;
    for line in output.lines() {
        if let Some((path, is)) = line.strip_prefix("test ").and_then(|line| line.split_once(" ... "))
            && of.is_none()
        {
            let name = name_of(path).to_owned();
            tests.push((path.to_owned(), Tested { name, passed: is == "ok", output: String::new() }));
        } else if let Some(path) = line.strip_prefix("---- ").and_then(|line| line.strip_suffix(" stdout ----")) {
            of = tests.iter().position(|(known, _)| known == path);
        } else if line == "failures:" {
            of = None;
        } else if let Some(number) = of {
            tests[number].1.output += line;
            tests[number].1.output.push('\n');
        }
    }
    tests.sort_by_key(|(path, _)| names.iter().position(|name| name == path));
    let mut tests: Vec<Tested> = tests.into_iter().map(|(_, test)| test).collect();
    tests.iter_mut().for_each(|test| test.output = test.output.trim().to_owned());
    tests
}

/// Names of the failed tests in the output of a program with tests: the list at its end.
pub fn failed(output: &str) -> Vec<&str> {
    let list = output.rsplit_once("\nfailures:\n").map_or("", |(_, list)| list);
    list.lines().take_while(|line| line.starts_with("    ")).map(|line| name_of(line.trim())).collect()
}

/// Name of a test in the source file, from its path in Rust.
fn name_of(path: &str) -> &str {
    path.rsplit("::").next().unwrap_or(path).trim_start_matches("r#")
}

/// The end of the output of `apex test`, in the form of Rust's tests.
pub fn text(tests: &[Tested], time: Duration) -> String {
    let mut text = "\n".to_owned();
    let failed: Vec<&Tested> = tests.iter().filter(|test| !test.passed).collect();
    if !failed.is_empty() {
        text += "\nfailures:\n";
        failed.iter().for_each(|test| text += &format!("\n---- {} ----\n{}\n", test.name, test.output));
        text += "\nfailures:\n";
        failed.iter().for_each(|test| text += &format!("    {}\n", test.name));
    }
    let (passed, failed) = (tests.len() - failed.len(), failed.len());
    let is = if failed == 0 { "ok" } else { "FAILED" };
    text + &format!("\ntest result: {is}. {passed} passed; {failed} failed; finished in {:.2}s\n", time.as_secs_f64())
}

/// Result of `apex test --format json`.
pub fn json(tests: &[Tested]) -> Value {
    let failed = tests.iter().filter(|test| !test.passed).count();
    let test = |test: &Tested| json!({ "name": test.name, "passed": test.passed, "output": test.output });
    json!({
        "passed": tests.len() - failed, "failed": failed, "tests": tests.iter().map(test).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_have_the_output_of_their_tests() {
        let output = "\nrunning 2 tests\ntest robot::r#b ... FAILED\ntest robot::a ... ok\n\nfailures:\n\n\
                      ---- robot::r#b stdout ----\ntest b at 1 s\ntest x ... ok\n\n\n\
                      failures:\n    robot::r#b\n\ntest result: FAILED. 1 passed\n";
        let test = |name: &str, passed, output: &str| Tested { name: name.into(), passed, output: output.into() };
        assert_eq!(failed(output), ["b"]);
        let names = ["robot::a", "robot::r#b"].map(str::to_owned);
        assert_eq!(read(output, &names), [test("a", true, ""), test("b", false, "test b at 1 s\ntest x ... ok")]);
    }
}
