//! The exported net can be read by a public tool: `pm4py`.

use apex_petri::pnml;
use apex_tests::{
    oracle::{Checker, generate},
    python,
};
use std::{fs, path::Path, process::Command};

const READ: &str = "import sys, pm4py
net, initial, _ = pm4py.read_pnml(sys.argv[1])
print('read', len(net.places), len(net.transitions), len(net.arcs), sum(initial.values()))";

#[test]
fn nets_are_read_by_pm4py() {
    let Some(python) = python(Path::new(env!("CARGO_TARGET_TMPDIR")), "pm4py", "pm4py") else { return };
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
