use apex_rt::Info;

/// Name of the graph whose parts are those of the mission.
const MISSION: &str = "mission";

/// Assignment of nodes to parts of a robot: the nested graph of a node, and the one within that.
#[derive(Debug)]
pub struct Parts {
    names: Vec<String>,
    /// Number of the part of each node.
    of_nodes: Vec<usize>,
    /// `true` for each part that belongs to the mission.
    in_mission: Vec<bool>,
}

impl Parts {
    /// Determines the parts of a robot.
    pub fn new(info: &Info) -> Self {
        let mut parts = Self { names: vec![], of_nodes: vec![], in_mission: vec![] };
        for node in info.nodes {
            let (name, in_mission) = part(node.name, info.graphs);
            let number = parts.names.iter().position(|known| *known == name).unwrap_or_else(|| {
                parts.in_mission.push(in_mission);
                parts.names.push(name);
                parts.names.len() - 1
            });
            parts.of_nodes.push(number);
        }
        parts
    }

    /// Names of all parts, such as `fetch / navigate`.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of the part of a node.
    pub fn of(&self, node: usize) -> usize {
        self.of_nodes[node]
    }

    /// Returns `true` if a part belongs to the mission.
    pub fn is_of_mission(&self, part: usize) -> bool {
        self.in_mission[part]
    }
}

/// Name of the part of a node, and `true` if it belongs to the mission, whose name is omitted.
fn part(node: &str, graphs: &[&str]) -> (String, bool) {
    let inner = node.strip_prefix(MISSION).and_then(|rest| rest.strip_prefix('.'));
    let mut names = inner.unwrap_or(node).split('.');
    let first = names.next().unwrap_or_default();
    let whole = if inner.is_some() { format!("{MISSION}.{first}.") } else { format!("{first}.") };
    // A graph without nested graphs is one part.
    let second = names.next().filter(|_| graphs.iter().any(|graph| graph.starts_with(&whole)));
    (second.map_or_else(|| first.to_owned(), |second| format!("{first} / {second}")), inner.is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_graphs_and_what_is_in_them() {
        let graphs = ["mission", "mission.wait", "mission.fetch", "mission.fetch.navigate", "see", "see.find_sign"];
        for (node, name, in_mission) in [
            ("mission.wait.compare", "wait", true),
            ("mission.explore", "explore", true),
            ("mission.fetch.read", "fetch / read", true),
            ("mission.fetch.navigate.follow", "fetch / navigate", true),
            ("see.find_sign.read.digit", "see / find_sign", false),
            ("see.map", "see / map", false),
            ("front", "front", false),
        ] {
            assert_eq!(part(node, &graphs), (name.to_owned(), in_mission));
        }
    }
}
