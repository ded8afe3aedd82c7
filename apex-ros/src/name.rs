//! Names of topics, services and nodes, and of their types on the wire.

use crate::Error;

/// Namespace and name of the node of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Scope {
    /// Namespace: `/`, or `/robot1`.
    pub namespace: String,
    /// Name of the node: `rover`.
    pub node: String,
}

impl Scope {
    /// Returns the scope of a node. An empty namespace is `/`; the first slash may be missing.
    ///
    /// # Errors
    /// One of them is not a name.
    pub fn new(namespace: &str, node: &str) -> Result<Self, Error> {
        let namespace = format!("/{}", namespace.trim_start_matches('/'));
        if namespace != "/" {
            check(&namespace, &namespace)?;
        }
        check(&format!("/{node}"), node)?;
        if node.contains('/') {
            return Err(Error::new(format!("`{node}` is not the name of a node: it contains `/`")));
        }
        Ok(Self { namespace, node: node.to_owned() })
    }

    /// Full name of the node: `/robot1/rover`.
    pub fn full(&self) -> String {
        join(&self.namespace, &self.node)
    }

    /// Returns the full name of a topic or service: `scan` is in the namespace, `~/scan` below the node, `/scan` stays.
    ///
    /// # Errors
    /// It is not a name.
    pub fn expand(&self, name: &str) -> Result<String, Error> {
        let full = match name.strip_prefix("~/") {
            Some(rest) => join(&self.full(), rest),
            None if name == "~" => self.full(),
            None if name.starts_with('/') => name.to_owned(),
            None => join(&self.namespace, name),
        };
        check(&full, name)?;
        Ok(full)
    }
}

fn join(namespace: &str, name: &str) -> String {
    format!("{}/{name}", namespace.trim_end_matches('/'))
}

/// Checks a full name, which was written as `written`.
fn check(full: &str, written: &str) -> Result<(), Error> {
    let is_word = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    match full.strip_prefix('/').map(|words| words.split('/').find(|word| !is_word(word))) {
        Some(None) => Ok(()),
        _ => Err(Error::new(format!(
            "`{written}` is not a name in ROS: between `/` are words of letters, digits and `_`, which do not begin \
             with a digit"
        ))),
    }
}

/// Returns the name of a type on the wire: `sensor_msgs::msg::dds_::LaserScan_` for `sensor_msgs/msg/LaserScan`.
pub fn wire_type(name: &str) -> String {
    match name.rsplit_once('/') {
        Some((package, ty)) => format!("{}::dds_::{ty}_", package.replace('/', "::")),
        None => name.to_owned(),
    }
}

/// Returns the name of a type by its name on the wire, which is returned itself if it has another form.
pub fn type_of_wire(wire: &str) -> String {
    let parts = wire.split_once("::dds_::").and_then(|(package, ty)| Some((package, ty.strip_suffix('_')?)));
    parts.map_or_else(|| wire.to_owned(), |(package, ty)| format!("{}/{ty}", package.replace("::", "/")))
}

/// Returns the key of the data of a topic, or of the queries of a service:
/// `0/scan/sensor_msgs::msg::dds_::LaserScan_/…`.
pub fn key(domain: u32, full_name: &str, wire_type: &str, hash: &str) -> String {
    format!("{domain}/{}/{wire_type}/{hash}", full_name.trim_matches('/'))
}

/// Returns a name as one part of a key: `%robot1%scan` for `/robot1/scan`, `%` for an empty name.
pub fn mangle(name: &str) -> String {
    if name.is_empty() { "%".to_owned() } else { name.replace('/', "%") }
}

/// Returns the name that [`mangle`] made a part of a key of; empty for `%`.
pub fn unmangle(part: &str) -> String {
    if part == "%" { String::new() } else { part.replace('%', "/") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_the_namespace_below_the_node_or_absolute() {
        let here = Scope::new("/robot1", "rover").expect("names");
        let expand = |name| here.expand(name).expect("a name");
        assert_eq!(
            ["scan", "~/scan", "/scan", "~"].map(expand),
            ["/robot1/scan", "/robot1/rover/scan", "/scan", "/robot1/rover"]
        );
        let root = Scope::new("", "rover").expect("names");
        assert_eq!((root.expand("a/b"), root.full()), (Ok("/a/b".to_owned()), "/rover".to_owned()));
    }

    #[test]
    fn what_is_not_a_name_is_refused_as_it_was_written() {
        let root = Scope::new("/", "rover").expect("names");
        for name in ["", "/", "a//b", "a/", "1a", "a b", "ä", "*", "a/$*", "~x", "{node}/a", "a?b", "a#b", "%"] {
            let error = root.expand(name).expect_err(name).to_string();
            assert!(error.starts_with(&format!("`{name}` is not a name")), "{error}");
        }
        assert!(Scope::new("/", "a/b").is_err() && Scope::new("a b", "c").is_err() && Scope::new("/a/", "c").is_err());
    }

    #[test]
    fn types_have_another_form_on_the_wire() {
        for (name, wire) in [
            ("sensor_msgs/msg/LaserScan", "sensor_msgs::msg::dds_::LaserScan_"),
            ("std_srvs/srv/SetBool", "std_srvs::srv::dds_::SetBool_"),
            ("nav2_msgs/action/Spin_SendGoal", "nav2_msgs::action::dds_::Spin_SendGoal_"),
        ] {
            assert_eq!((wire_type(name), type_of_wire(wire)), (wire.to_owned(), name.to_owned()));
        }
        assert_eq!(type_of_wire("odd"), "odd");
    }

    #[test]
    fn keys_begin_with_the_domain() {
        let key = |name| key(7, name, "std_msgs::msg::dds_::String_", "RIHS01_00");
        assert_eq!(key("/a/b"), "7/a/b/std_msgs::msg::dds_::String_/RIHS01_00");
        assert_eq!((mangle("/a/b"), mangle(""), mangle("/")), ("%a%b".to_owned(), "%".to_owned(), "%".to_owned()));
        assert_eq!((unmangle("%a%b"), unmangle("%")), ("/a/b".to_owned(), String::new()));
    }
}
