//! The arguments of ROS 2 on the command line: `--ros-args -r scan:=front -p near:=0.5`.

use crate::{
    Error,
    name::Scope,
    params_file::{self, FileParam},
    yaml,
};

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
    /// Values of parameters in files (`--params-file robot.yaml`), which those of `params` replace.
    pub file_params: Vec<FileParam>,
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
        let mut files = vec![];
        while let Some(argument) = arguments.next() {
            match (is_ros, argument.as_str()) {
                (_, "--ros-args") => is_ros = true,
                (false, _) => args.others.push(argument),
                (true, "--") => is_ros = false,
                (true, "--params-file") => files.push(value_of("--params-file", &mut arguments)?),
                (true, flag) => args.one(flag, node, &mut arguments)?,
            }
        }
        // The names of the node may stand behind the file.
        let names = Scope::new(args.namespace.as_deref().unwrap_or(""), args.node.as_deref().unwrap_or(node))?;
        for file in &files {
            args.file_params.extend(params_file::load(file, &names.full())?);
        }
        Ok(args)
    }

    /// Reads an argument of ROS.
    fn one(&mut self, flag: &str, node: &str, rest: &mut impl Iterator<Item = String>) -> Result<(), Error> {
        let mut value = || value_of(flag, rest);
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
            _ => Err(Error::new(format!(
                "`{flag}` is not an argument of ROS that is known: `-r`, `-p`, `--params-file`, `-e`, `--log-level`"
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

    /// Value of the parameter `name` of ROS itself, such as `use_sim_time`; `false` if there is none.
    ///
    /// # Errors
    /// The value is not a truth value.
    pub(crate) fn flag(&self, name: &str) -> Result<bool, Error> {
        let given = self.params.iter().rev().find(|(other, _)| other == name);
        let in_file = || self.file_params.iter().rev().find(|param| param.name == name);
        let (place, value) = match (given, in_file()) {
            (Some((_, value)), _) => (format!("`-p {name}:={value}`"), toml(value)?),
            (None, Some(FileParam { value, place, .. })) => (place.clone(), value.clone()),
            (None, None) => return Ok(false),
        };
        match value.as_str() {
            "1" | "true" => Ok(true),
            "0" | "false" => Ok(false),
            _ => Err(Error::new(format!("{place}: `{name}` takes `true` or `false`"))),
        }
    }
}

/// Returns the value of a parameter, which is YAML on the command line, in TOML.
pub(crate) fn toml(value: &str) -> Result<String, Error> {
    let value = yaml::read(value).and_then(|value| value.map(|value| yaml::toml(&value)).transpose());
    match value {
        Ok(value) => Ok(value.unwrap_or_else(|| "\"\"".to_owned())),
        Err(yaml::Problem { message, .. }) => Err(Error::new(message)),
    }
}

/// The value of an argument, which follows it.
fn value_of(flag: &str, rest: &mut impl Iterator<Item = String>) -> Result<String, Error> {
    rest.next().ok_or_else(|| Error::new(format!("`{flag}` is the last argument: its value is missing")))
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
            (
                "--ros-args --frob",
                "`--frob` is not an argument of ROS that is known: `-r`, `-p`, `--params-file`, `-e`, `--log-level`",
            ),
        ] {
            assert_eq!(read(text).map_err(|error| error.to_string()), Err(message.to_owned()));
        }
        let error = read("--ros-args --params-file /nowhere.yaml").expect_err("no file").to_string();
        assert!(error.starts_with("cannot read `/nowhere.yaml`"), "{error}");
    }

    #[test]
    fn flags_of_ros_are_parameters() {
        let flag = |text: &str| read(&format!("--ros-args {text}")).expect("right").flag("use_sim_time");
        assert_eq!(flag("-p use_sim_time:=false -p use_sim_time:=true"), Ok(true));
        for (text, expected) in [("True", true), ("1", true), ("false", false), ("0", false)] {
            assert_eq!(flag(&format!("-p use_sim_time:={text}")), Ok(expected), "{text}");
        }
        let error = flag("-p use_sim_time:=maybe").expect_err("neither").to_string();
        assert_eq!(error, "`-p use_sim_time:=maybe`: `use_sim_time` takes `true` or `false`");
    }
}
