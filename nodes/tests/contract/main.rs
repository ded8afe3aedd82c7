//! The contract of nodes that drive or guard (`docs/safety.md`): each of them, found by its ports, is driven for a
//! second, then one input fails in one way. The outcomes are the table of the page, which is compared;
//! `APEX_UPDATE_EXPECTATIONS=1` writes it again.

mod drive;
mod programs;
mod rows;
mod token;
mod world;

use apex_dsl::{
    catalog::{Catalog, Signature},
    syntax::tree::PortKind,
};
use apex_host::{Disk, Seen, Workspace};
use drive::{Condition, Outcome, STEP, at_input, in_silence};
use rows::{ROWS, Row};
use std::{fmt::Write as _, fs, path::Path};

/// Signatures of the library whose nodes send twists.
fn drivers() -> Vec<Signature> {
    let workspace = Workspace::load(Path::new(env!("CARGO_MANIFEST_DIR"))).expect("cargo knows the package");
    let catalog = Catalog::load(workspace.crates(&Seen::Crate("contract", false)), &mut Disk::new(None));
    let is_driver = |signature: &&Signature| {
        let is_library = signature.path.get(1).is_some_and(|krate| krate == "apex_nodes");
        let sends = |kind| matches!(kind, PortKind::Output | PortKind::Event);
        is_library && signature.ports.iter().any(|port| sends(port.kind) && port.ty.name() == "Twist")
    };
    let mut drivers: Vec<Signature> = catalog.signatures.iter().filter(is_driver).cloned().collect();
    drivers.sort_by_key(|signature| ROWS.iter().position(|row| row.name == signature.name));
    drivers
}

/// Row of a node, and its inputs with their types. Its parameters are left out.
fn row_of(signature: &Signature) -> (&'static Row, Vec<(String, String)>) {
    let name = &signature.name;
    let row = ROWS.iter().find(|row| row.name == *name);
    let row = row.unwrap_or_else(|| panic!("`{name}` sends twists, and has no row in `nodes/tests/contract/rows.rs`"));
    let inputs = signature
        .ports
        .iter()
        .filter(|port| port.kind == PortKind::Input && !signature.params.iter().any(|param| param.name == port.name));
    (row, inputs.map(|port| (port.name.clone(), port.ty.name().to_owned())).collect())
}

/// Cell of the table.
fn cell(outcome: &Result<Outcome, &'static str>) -> String {
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(reason) => return format!("- ({reason})"),
    };
    let [before, after] = outcome.twists.map(|twist| twist.velocity().norm());
    let mut cell = match outcome.stops {
        Some(time) => format!("stops {}", when(time)),
        None if after < 0.9 * before => format!("slows to {after:.2} m/s"),
        None => "drives on".to_owned(),
    };
    if let Some((event, time)) = outcome.event {
        let _ = write!(cell, ", `{event}` {}", when(time));
    }
    if outcome.fails {
        cell.push_str(", fails");
    }
    cell
}

fn seconds(time: f32) -> f32 {
    (time * 100.0).round() / 100.0
}

/// Time from the last good input: at once is in the first firing without it.
fn when(time: f32) -> String {
    if time <= STEP.as_secs_f32() { "at once".to_owned() } else { format!("after {} s", seconds(time)) }
}

/// The tables of the page.
fn tables() -> String {
    let headings = Condition::ALL.map(Condition::heading).join(" | ");
    let mut inputs_table =
        format!("\n| node | input | {headings} |\n|---|---|{}\n", "---|".repeat(Condition::ALL.len()));
    let mut silence_table = "| node | `max_age` | cannot do without | in silence |\n|---|---|---|---|\n".to_owned();
    for signature in drivers() {
        let (row, inputs) = row_of(&signature);
        let needs = row.needs.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let silence = cell(&Ok(in_silence(row, &inputs)));
        let _ = writeln!(silence_table, "| `{}` | {} s | {needs} | {silence} |", row.name, row.max_age);
        for input in &inputs {
            let cells = Condition::ALL.map(|condition| cell(&at_input(row, &inputs, input, condition)));
            let _ = writeln!(inputs_table, "| `{}` | `{}` | {} |", row.name, input.0, cells.join(" | "));
        }
    }
    silence_table + &inputs_table
}

/// Markers on the page before and after the tables.
const MARKERS: [&str; 2] = ["<!-- contract -->\n", "<!-- end of contract -->"];

#[test]
fn the_page_has_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/safety.md");
    let page = fs::read_to_string(&path).expect("the page is there");
    let (before, rest) = page.split_once(MARKERS[0]).expect("the first marker");
    let (table, after) = rest.split_once(MARKERS[1]).expect("the second marker");
    let measured = format!("\n{}\n", tables());
    if std::env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(&path, [before, MARKERS[0], &measured, MARKERS[1], after].concat()).expect("the file can be written");
        return;
    }
    assert_eq!(table, measured, "the table of `docs/safety.md` changed: run with APEX_UPDATE_EXPECTATIONS=1");
}

#[test]
fn nothing_drives_on_without_what_it_needs() {
    for signature in drivers() {
        let (row, inputs) = row_of(&signature);
        let check = |what: &str, outcome: Outcome| {
            let Outcome { stops, event, fails, goes_on, .. } = outcome;
            assert!(stops.is_some_and(|time| time <= row.max_age), "`{}` with {what}: stops after {stops:?}", row.name);
            assert!(goes_on || event.is_some(), "`{}` does not go on after {what}", row.name);
            assert!(!fails || what.ends_with("Far"), "`{}` fails with {what}", row.name);
        };
        let silence = signature.silence().map(|param| &signature.params[param].name);
        assert_eq!(silence.map(String::as_str), Some("max_age"), "the silence of `{}`", row.name);
        check("silence", in_silence(row, &inputs));
        for input in inputs.iter().filter(|(name, _)| row.needs.contains(&name.as_str())) {
            let token = world::World::new().token(&input.0, &input.1).expect("it is needed");
            for condition in Condition::ALL {
                let is_measurement = condition == Condition::Infinite && token.may_be_infinite();
                match at_input(row, &inputs, input, condition) {
                    Ok(outcome) if !is_measurement => check(&format!("`{}` {condition:?}", input.0), outcome),
                    _ => {}
                }
            }
        }
    }
}

#[test]
fn rows_are_those_of_nodes() {
    let drivers = drivers();
    for row in ROWS {
        let signature = drivers.iter().find(|signature| signature.name == row.name);
        let signature = signature.unwrap_or_else(|| panic!("`{}` sends no twists: remove its row", row.name));
        let (_, inputs) = row_of(signature);
        assert!(row.needs.iter().all(|need| inputs.iter().any(|(name, _)| name == need)), "{}", row.name);
    }
}
