//! Writes the graphs of copper-rs: for each a configuration in RON, and the application for it.

use std::{env, fmt::Write as _, fs, io, path::Path};

fn main() -> io::Result<()> {
    cu29_build::setup();
    println!("cargo::rerun-if-changed=build.rs");
    let folder = env::var("OUT_DIR").map_err(io::Error::other)?;
    let mut code = String::new();
    let graphs = [
        ("chain3", chain(3)),
        ("chain10", chain(10)),
        ("chain100", chain(100)),
        ("diamond8", diamond8()),
        ("bot100", bot100()),
        ("throttle", throttle()),
    ];
    for (name, config) in graphs {
        let path = Path::new(&folder).join(format!("{name}.ron"));
        fs::write(&path, config.text())?;
        let _ = writeln!(code, "copper!({name}, {:?});", path.display().to_string());
    }
    fs::write(Path::new(&folder).join("copper.rs"), code)
}

/// Tasks by name and type, and the connections between them.
#[derive(Default)]
struct Config {
    tasks: Vec<(String, String)>,
    connections: Vec<(String, String)>,
}

impl Config {
    fn task(&mut self, name: &str, kind: &str) {
        self.tasks.push((name.to_owned(), kind.to_owned()));
    }

    fn connect(&mut self, from: &str, to: &str) {
        self.connections.push((from.to_owned(), to.to_owned()));
    }

    /// Adds the task `name` after `from`.
    fn behind(&mut self, from: &str, name: &str, kind: &str) {
        self.task(name, kind);
        self.connect(from, name);
    }

    /// Adds a chain of operations after `from`. Returns the name of the last one.
    fn ops(&mut self, from: &str, numbers: impl Iterator<Item = u64>) -> String {
        numbers.fold(from.to_owned(), |from, k| {
            let name = format!("op{k}");
            self.behind(&from, &name, &format!("tasks::Op<{k}>"));
            name
        })
    }

    fn text(&self) -> String {
        let mut text =
            "(\n    logging: (enable_task_logging: false, enable_keyframe_logging: false),\n    tasks: [\n".to_owned();
        for (name, kind) in &self.tasks {
            let _ = writeln!(text, "        (id: \"{name}\", type: \"{kind}\", logging: (enabled: false)),");
        }
        text.push_str("    ],\n    cnx: [\n");
        for (from, to) in &self.connections {
            let _ = writeln!(text, "        (src: \"{from}\", dst: \"{to}\", msg: \"u64\"),");
        }
        text + "    ],\n)\n"
    }
}

fn source() -> Config {
    let mut config = Config::default();
    config.task("source", "tasks::Source");
    config
}

fn chain(n: u64) -> Config {
    let mut config = source();
    let last = config.ops("source", 1..=n);
    config.behind(&last, "sink", "tasks::Last");
    config
}

fn diamond8() -> Config {
    let mut config = source();
    config.task("all", "tasks::Sum8");
    for k in 1..=8 {
        let branch = config.ops("source", k..=k);
        config.connect(&branch, "all");
    }
    config.behind("all", "sink", "tasks::Last");
    config
}

fn bot100() -> Config {
    let mut config = source();
    let first = config.ops("source", 1..=1);
    config.behind(&first, "filter", "tasks::Filter<100>");
    let last = config.ops("filter", 3..=100);
    config.behind(&last, "sink", "tasks::Last");
    config
}

fn throttle() -> Config {
    let mut config = source();
    let first = config.ops("source", 1..=1);
    config.behind(&first, "filter", "tasks::Filter<10>");
    let thinned = config.ops("filter", 2..=2);
    let full = config.ops(&first, 10..=17);
    config.behind(&thinned, "join", "tasks::Join");
    config.connect(&full, "join");
    config.behind("join", "sink", "tasks::Last");
    config
}
