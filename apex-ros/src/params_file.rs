//! Files of parameters (`--params-file`): the parameters of nodes by their names, in YAML.

use crate::{
    Error,
    yaml::{self, Kind, Place, Problem, Value},
};
use std::fs;

/// Parameter in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileParam {
    /// Name: `mission.near`.
    pub name: String,
    /// Value in TOML.
    pub value: String,
    /// Place: `robot.yaml:4:7`.
    pub place: String,
    /// `true` if it stands below the name of the node. Below a pattern as `/**`, it may be one for other nodes.
    pub is_named: bool,
}

/// Key below which the parameters of a node are.
const PARAMETERS: &str = "ros__parameters";

/// Reads the parameters of a node, by its full name, from a file.
///
/// # Errors
/// The file cannot be read, or is not one of parameters: the place and the reason.
pub fn load(path: &str, node: &str) -> Result<Vec<FileParam>, Error> {
    let text = fs::read_to_string(path).map_err(|error| Error::new(format!("cannot read `{path}`: {error}")))?;
    read(&text, path, node).map_err(|Problem { place, message }| Error::new(format!("{}: {message}", at(path, place))))
}

fn at(path: &str, Place { line, column }: Place) -> String {
    format!("{path}:{line}:{column}")
}

fn read(text: &str, path: &str, node: &str) -> Result<Vec<FileParam>, Problem> {
    let mut found = Found { path, node, params: vec![] };
    match yaml::read(text)? {
        None => {}
        Some(value) => found.nodes("", &value)?,
    }
    Ok(found.params)
}

/// Parameters that are found on the way through a file.
struct Found<'a> {
    path: &'a str,
    node: &'a str,
    params: Vec<FileParam>,
}

impl Found<'_> {
    /// Looks at the nodes in a namespace.
    fn nodes(&mut self, namespace: &str, value: &Value) -> Result<(), Problem> {
        let Kind::Map(entries) = &value.kind else {
            let message = format!("here stands the name of a node, and below it `{PARAMETERS}:` with its parameters");
            return Err(Problem { place: value.place, message });
        };
        for (key, place, value) in entries {
            if key != PARAMETERS {
                self.nodes(&format!("{namespace}/{}", key.trim_matches('/')), value)?;
                continue;
            }
            if namespace.is_empty() {
                let message = format!("`{PARAMETERS}` stands below the name of a node, or below `/**` for all nodes");
                return Err(Problem { place: *place, message });
            }
            if is_meant(namespace, self.node) {
                self.values("", value, !namespace.contains('*'))?;
            } else {
                // Mistakes for other nodes are mistakes, too.
                let kept = self.params.len();
                self.values("", value, false)?;
                self.params.truncate(kept);
            }
        }
        Ok(())
    }

    /// Looks at parameters whose names begin with `prefix`.
    fn values(&mut self, prefix: &str, value: &Value, is_named: bool) -> Result<(), Problem> {
        let Kind::Map(entries) = &value.kind else {
            let message = "here stand the names of parameters with their values: `near: 0.5`".to_owned();
            return Err(Problem { place: value.place, message });
        };
        for (key, place, value) in entries {
            let name = format!("{prefix}{key}");
            if let Kind::Map(_) = value.kind {
                self.values(&format!("{name}."), value, is_named)?;
                continue;
            }
            let (value, place) = (yaml::toml(value)?, at(self.path, *place));
            self.params.push(FileParam { name, value, place, is_named });
        }
        Ok(())
    }
}

/// Names between the slashes.
fn words(name: &str) -> Vec<&str> {
    name.split('/').filter(|word| !word.is_empty()).collect()
}

/// Returns `true` if a pattern means a node: `*` is one name, `**` any number of them.
fn is_meant(pattern: &str, node: &str) -> bool {
    fn fits(pattern: &[&str], names: &[&str]) -> bool {
        match (pattern, names) {
            ([], []) => true,
            (["**", rest @ ..], _) => {
                fits(rest, names) || names.split_first().is_some_and(|(_, names)| fits(pattern, names))
            }
            ([word, rest @ ..], [name, names @ ..]) => (*word == "*" || word == name) && fits(rest, names),
            _ => false,
        }
    }
    fits(&words(pattern), &words(node))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "\
# For all nodes.
/**:
  ros__parameters:
    use_sim_time: true
    qos_overrides: {depth: 5}
rover:
  ros__parameters:
    mission:
      near: 0.5
      names: [a, 'b']
    drive.factor: 2
/robot1/rover:
  ros__parameters: {mission: {near: 1.5}}
robot1:
  rover:
    ros__parameters:
      mission.far: .inf
\"/*/rover\":
  ros__parameters:
    x: 1
other:
  ros__parameters:
    mission.near: 9
";

    fn found(node: &str) -> Vec<String> {
        let params = read(FILE, "a.yaml", node).expect("right");
        let one = |FileParam { name, value, place, is_named }| format!("{name}={value} {place} {is_named}");
        params.into_iter().map(one).collect()
    }

    #[test]
    fn nodes_are_found_by_name_and_pattern() {
        let all = ["use_sim_time=true a.yaml:4:5 false", "qos_overrides.depth=5 a.yaml:5:21 false"];
        let rover = ["mission.near=0.5 a.yaml:9:7 true", "mission.names=[\"a\", \"b\"] a.yaml:10:7 true"];
        assert_eq!(found("/rover"), [&all[..], &rover, &["drive.factor=2 a.yaml:11:5 true"]].concat());
        let robot1 =
            ["mission.near=1.5 a.yaml:13:31 true", "mission.far=inf a.yaml:17:7 true", "x=1 a.yaml:20:5 false"];
        assert_eq!(found("/robot1/rover"), [&all[..], &robot1].concat());
        assert_eq!(found("/a/b/rover"), all);
    }

    #[test]
    fn patterns_mean_names() {
        for (pattern, node, is_so) in [
            ("/**", "/a", true),
            ("/**", "/a/b", true),
            ("/**/b", "/b", true),
            ("/**/b", "/a/c/b", true),
            ("/*", "/a", true),
            ("/*", "/a/b", false),
            ("/a/**", "/a/b/c", true),
            ("/a/*/c", "/a/b/c", true),
            ("/a", "/ab", false),
        ] {
            assert_eq!(is_meant(pattern, node), is_so, "{pattern} {node}");
        }
    }

    #[test]
    fn mistakes_have_their_place() {
        for (text, expected) in [
            (
                "rover:\n  near: 1",
                "2:9: here stands the name of a node, and below it `ros__parameters:` with its parameters",
            ),
            ("- rover", "1:1: here stands the name of a node, and below it `ros__parameters:` with its parameters"),
            (
                "ros__parameters:\n  a: 1",
                "1:1: `ros__parameters` stands below the name of a node, or below `/**` for all nodes",
            ),
            ("a:\n  ros__parameters: 3", "2:20: here stand the names of parameters with their values: `near: 0.5`"),
            ("a:\n  ros__parameters:\n    b:", "3:6: a value is missing here"),
            ("a:\n  ros__parameters:\n    b: 1\n    b: 2", "4:5: `b` is there twice"),
            ("a:\n  ros__parameters:\n    b: [1, {c: 2}]", "3:12: a list has values without names"),
        ] {
            let Problem { place: Place { line, column }, message } = read(text, "a.yaml", "/x").expect_err(text);
            assert_eq!(format!("{line}:{column}: {message}"), expected, "{text}");
        }
        let error = load("/nowhere/a.yaml", "/x").expect_err("no file").to_string();
        assert!(error.starts_with("cannot read `/nowhere/a.yaml`: "), "{error}");
    }
}
