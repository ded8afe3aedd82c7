//! The arguments of ROS 2 on the command line: `--ros-args -r scan:=front -p near:=0.5`.

use crate::{Error, name::Scope};

/// The arguments of ROS 2, and the others.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Args {
    /// Name of the node (`-r __node:=rover`).
    pub node: Option<String>,
    /// Namespace (`-r __ns:=/robot1`).
    pub namespace: Option<String>,
    /// Other names of topics and services (`-r scan:=front`).
    pub remappings: Vec<Remapping>,
    /// Values of parameters (`-p mission.near:=0.5`), as written.
    pub params: Vec<(String, String)>,
    /// Enclave (`-e /robot1`).
    pub enclave: Option<String>,
    /// The arguments outside of `--ros-args … --`.
    pub others: Vec<String>,
}

/// Another name of a topic or service.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remapping {
    /// Name in the program.
    pub from: String,
    /// Name outside.
    pub to: String,
}

impl Args {
    /// Reads the arguments of a process, without its name, for the node that is called `node` in the program. Rules for
    /// other nodes (`-r other:scan:=front`) are left out.
    ///
    /// # Errors
    /// An argument that is not known, or without its value.
    pub fn read(arguments: impl IntoIterator<Item = String>, node: &str) -> Result<Self, Error> {
        let (mut args, mut is_ros, mut arguments) = (Self::default(), false, arguments.into_iter());
        while let Some(argument) = arguments.next() {
            match (is_ros, argument.as_str()) {
                (_, "--ros-args") => is_ros = true,
                (false, _) => args.others.push(argument),
                (true, "--") => is_ros = false,
                (true, flag) => args.one(flag, node, &mut arguments)?,
            }
        }
        Ok(args)
    }

    /// Reads an argument of ROS.
    fn one(&mut self, flag: &str, node: &str, rest: &mut impl Iterator<Item = String>) -> Result<(), Error> {
        let mut value =
            || rest.next().ok_or_else(|| Error::new(format!("`{flag}` is the last argument: its value is missing")));
        match flag {
            "-r" | "--remap" => self.remap(&value()?, node),
            "-p" | "--param" => self.param(&value()?, node),
            "-e" | "--enclave" => {
                self.enclave = Some(value()?);
                Ok(())
            }
            // Programs of Apex have no levels of messages.
            "--log-level" | "--log-file-name" => value().map(drop),
            flag if flag.starts_with("--enable-") || flag.starts_with("--disable-") => Ok(()),
            "--params-file" => Err(Error::new(
                "`--params-file` is for YAML, which is not read: give values with `-p NAME:=VALUE`, or all of them as \
                 TOML, as `apex run --params FILE` does",
            )),
            _ => Err(Error::new(format!(
                "`{flag}` is not an argument of ROS that is known: `-r`, `-p`, `-e`, `--log-level`"
            ))),
        }
    }

    fn remap(&mut self, rule: &str, node: &str) -> Result<(), Error> {
        let (from, to) = split(rule, "FROM:=TO")?;
        let Some(from) = of_node(from, node) else { return Ok(()) };
        match from {
            "__node" | "__name" => self.node = Some(to.to_owned()),
            "__ns" => self.namespace = Some(to.to_owned()),
            _ => {
                let from = from.trim_start_matches("rostopic://").trim_start_matches("rosservice://");
                self.remappings.push(Remapping { from: from.to_owned(), to: to.to_owned() });
            }
        }
        Ok(())
    }

    fn param(&mut self, rule: &str, node: &str) -> Result<(), Error> {
        let (name, value) = split(rule, "NAME:=VALUE")?;
        if let Some(name) = of_node(name, node) {
            self.params.push((name.to_owned(), value.to_owned()));
        }
        Ok(())
    }

    /// Returns the full name of a topic or service outside, after the first remapping that concerns it.
    ///
    /// # Errors
    /// One of the names is not a name.
    pub fn resolve(&self, name: &str, scope: &Scope) -> Result<String, Error> {
        let full = scope.expand(name)?;
        for Remapping { from, to } in &self.remappings {
            if scope.expand(from)? == full {
                return scope.expand(to);
            }
        }
        Ok(full)
    }

    /// Value of the parameter `name` of ROS itself, such as `use_sim_time`.
    pub(crate) fn flag(&self, name: &str) -> bool {
        let value = self.params.iter().rev().find(|(other, _)| other == name);
        value.is_some_and(|(_, value)| matches!(value.as_str(), "true" | "True" | "1"))
    }
}

/// Returns the value of a parameter, which is YAML on the command line, in TOML: a word is a text.
pub(crate) fn toml(value: &str) -> String {
    let value = value.trim();
    let is_number = value.parse::<f64>().is_ok();
    match value {
        "True" | "TRUE" => "true".to_owned(),
        "False" | "FALSE" => "false".to_owned(),
        ".inf" | ".Inf" => "inf".to_owned(),
        "-.inf" | "-.Inf" => "-inf".to_owned(),
        ".nan" | ".NaN" => "nan".to_owned(),
        "true" | "false" => value.to_owned(),
        _ if is_number || value.starts_with(['[', '"', '\'']) => value.to_owned(),
        _ => format!("{value:?}"),
    }
}

/// Both sides of `:=`.
fn split<'a>(rule: &'a str, form: &str) -> Result<(&'a str, &'a str), Error> {
    rule.split_once(":=")
        .filter(|(from, to)| !from.is_empty() && !to.is_empty())
        .ok_or_else(|| Error::new(format!("`{rule}` is not of the form `{form}`")))
}

/// Name in a rule without the name of the node before it; `None` if that is another one.
fn of_node<'a>(name: &'a str, node: &str) -> Option<&'a str> {
    match name.split_once(':') {
        Some((_, rest)) if rest.starts_with("//") => Some(name),
        Some((of, name)) => (of.trim_start_matches('/') == node).then_some(name),
        None => Some(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Args, Error> {
        Args::read(text.split_whitespace().map(str::to_owned), "rover")
    }

    #[test]
    fn arguments_of_ros_are_between_two_marks() {
        let args = read("--fast --ros-args -r scan:=front -p near:=0.5 --log-level debug -- --slow").expect("right");
        assert_eq!(args.others, ["--fast", "--slow"]);
        assert_eq!(args.remappings, [Remapping { from: "scan".to_owned(), to: "front".to_owned() }]);
        assert_eq!(args.params, [("near".to_owned(), "0.5".to_owned())]);
        assert_eq!(read(""), Ok(Args::default()));
    }

    #[test]
    fn node_and_namespace_are_remapped_too() {
        let args = read("--ros-args -r __node:=second -r __ns:=/robot1 --remap other:__node:=third").expect("right");
        assert_eq!((args.node.as_deref(), args.namespace.as_deref()), (Some("second"), Some("/robot1")));
        assert!(args.remappings.is_empty());
    }

    #[test]
    fn the_first_remapping_of_a_name_counts() {
        let args =
            read("--ros-args -r rover:/robot1/scan:=front -r scan:=/back -r other:odom:=x -r ~/a:=b").expect("right");
        let scope = Scope::new("/robot1", "rover").expect("names");
        let resolve = |name| args.resolve(name, &scope).expect("a name");
        assert_eq!(
            ["scan", "/robot1/scan", "/scan", "odom", "~/a"].map(resolve),
            ["/robot1/front", "/robot1/front", "/scan", "/robot1/odom", "/robot1/b"]
        );
    }

    #[test]
    fn mistakes_are_said_in_words() {
        for (text, message) in [
            ("--ros-args -r", "`-r` is the last argument: its value is missing"),
            ("--ros-args -r scan", "`scan` is not of the form `FROM:=TO`"),
            ("--ros-args -p :=1", "`:=1` is not of the form `NAME:=VALUE`"),
            ("--ros-args --frob", "`--frob` is not an argument of ROS that is known: `-r`, `-p`, `-e`, `--log-level`"),
        ] {
            assert_eq!(read(text).map_err(|error| error.to_string()), Err(message.to_owned()));
        }
        assert!(read("--ros-args --params-file a.yaml").is_err_and(|error| error.to_string().contains("YAML")));
    }

    #[test]
    fn values_are_yaml() {
        for (yaml, as_toml) in [
            ("0.5", "0.5"),
            ("-3", "-3"),
            ("True", "true"),
            (".inf", "inf"),
            ("[1, 2]", "[1, 2]"),
            ("laser", "\"laser\""),
            ("'a b'", "'a b'"),
        ] {
            assert_eq!(toml(yaml), as_toml);
        }
    }

    #[test]
    fn flags_of_ros_are_parameters() {
        assert!(read("--ros-args -p use_sim_time:=false -p use_sim_time:=true").expect("right").flag("use_sim_time"));
        assert!(!read("--ros-args -p use_sim_time:=false").expect("right").flag("use_sim_time"));
    }
}
