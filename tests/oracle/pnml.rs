//! The exported net is read by a public tool: `pm4py`, from `target/pm4py` or from the system's Python.

use apex_dsl::petri::pnml;
use apex_tests::oracle::{Checker, generate};
use std::{fs, path::Path, process::Command};

const READ: &str = "import sys, pm4py
net, initial, _ = pm4py.read_pnml(sys.argv[1])
print('read', len(net.places), len(net.transitions), len(net.arcs), sum(initial.values()))";

/// A Python that has `pm4py`.
fn python() -> Option<String> {
    let own = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../pm4py/bin/python3").display().to_string();
    let has = |p: &String| Command::new(p).args(["-c", "import pm4py"]).output().is_ok_and(|o| o.status.success());
    [own, "python3".to_owned()].into_iter().find(has)
}

#[test]
fn nets_are_read_by_pm4py() {
    let Some(python) = python() else {
        println!("skipped: no Python with pm4py; `python3 -m venv target/pm4py && target/pm4py/bin/pip install pm4py`");
        return;
    };
    let checker = Checker::new();
    for seed in [1, 2, 3, 37] {
        let Ok(checked) = checker.check(&generate(seed, true).text("Random")) else { continue };
        let net = &checked.net;
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("oracle-{seed}.pnml"));
        fs::write(&file, pnml(net)).expect("the folder can be written");
        let output = Command::new(&python).args(["-c", READ]).arg(&file).output().expect("python runs");
        let arcs: usize = net.transitions.iter().map(|t| t.takes.len() + t.gives.len()).sum();
        let initial: usize = net.places.iter().map(|p| p.initial).sum();
        let expected = format!("read {} {} {arcs} {initial}", net.places.len(), net.transitions.len());
        let found = String::from_utf8_lossy(&output.stdout);
        assert!(found.contains(&expected), "{expected}: {found}{}", String::from_utf8_lossy(&output.stderr));
    }
}
