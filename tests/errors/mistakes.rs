//! A hundred typical mistakes of beginners, each one change of a correct source file whose graphs are used several
//! times. A mistake must cause one message, or at most three; the first must point at its line.

use super::compile::{catalog, compile, folder};
use apex_dsl::catalog::Catalog;
use std::fs;

/// One change of a correct source file.
struct Mistake {
    /// Text in the correct source file; all occurrences are changed.
    right: &'static str,
    /// Replacement.
    wrong: &'static str,
    /// Code of the first message.
    code: &'static str,
    /// Text in the line of the first message if that is not the changed line: if something is missing, the message
    /// refers to its use.
    at: Option<&'static str>,
}

const fn mistake(right: &'static str, wrong: &'static str, code: &'static str) -> Mistake {
    Mistake { right, wrong, code, at: None }
}

const fn elsewhere(right: &'static str, wrong: &'static str, code: &'static str, at: &'static str) -> Mistake {
    Mistake { right, wrong, code, at: Some(at) }
}

/// Mistakes in `mistakes/delivery.afg`.
const DELIVERY: &[Mistake] = &[
    // Names.
    mistake("node retry = Pass();", "node retry = Pass(); node base = Pass();", "duplicate-name"),
    mistake("node brake = Base();", "node brake = Base(); node order = Pass();", "duplicate-name"),
    mistake("event late;", "event late; event there: u64;", "duplicate-name"),
    mistake("fsm Mode {", "fsm GoTo {", "duplicate-name"),
    mistake("retry.sent   => base.put", "retry.sent => bsae.put", "unknown-node"),
    mistake("node check = Turn", "node chekc = Turn", "unknown-node"),
    mistake("check.l      => there", "check.left => there", "unknown-port"),
    mistake("begin.sent   => base.put", "begin.snet => base.put", "unknown-port"),
    mistake("dock.there   =>", "dock.their =>", "unknown-port"),
    mistake("event there: u64", "event their: u64", "unknown-port"),
    mistake("slot  go: u64", "slot og: u64", "unknown-port"),
    mistake("node dock  = GoTo()", "node dock  = Goto()", "unknown-node"),
    mistake("graph GoTo(", "graph GoTp(", "unknown-node"),
    mistake("= Turn()", "= Trun()", "unknown-node"),
    mistake("use library::edges", "use library::edge", "unknown-import"),
    mistake("use library::edges", "use libary::edges", "unknown-import"),
    elsewhere("use library::edges;", "", "unknown-node", "edges()"),
    mistake("start        => order", "start => odrer", "unknown-node"),
    mistake("retry", "größe", "unknown-character"),
    mistake("test fetches: GoTo(", "test fetches: GotTo(", "unknown-node"),
    // Activity.
    mistake("begin.sent   => base.put", "begin.sent -> base.put", "never-activated"),
    mistake("go           => begin.put", "go -> begin.put", "never-activated"),
    mistake("order.sent   => fetch.go", "order.sent -> fetch.go", "never-activated"),
    mistake("start        => order", "start -> order.put", "type-mismatch"),
    mistake("base.sent    => check.s", "base.sent -> check.s", "never-activated"),
    // Values and units.
    mistake("timeout patience", "timeout 1m", "wrong-unit"),
    mistake("every 100ms;\n    go", "every 20m;\n    go", "wrong-unit"),
    mistake("every 1s", "every 1", "missing-unit"),
    mistake("every 1s", "every 1sec", "unknown-unit"),
    mistake("every 1s", "rate 10Hz", "syntax"),
    mistake("timeout patience", "timeout patence", "unknown-name"),
    mistake("patience = 1min", "patience = 1m", "wrong-unit"),
    mistake("patience: Duration = 5s", "patience: Duration = 5", "missing-unit"),
    mistake("speed: f32[m/s]", "speed: f32", "wrong-unit"),
    mistake("= 1m/s in 0..=2", "= 3m/s in 0..=2", "out-of-range"),
    mistake("speed = 1m/s, p", "speed = 5m/s, p", "out-of-range"),
    mistake("speed = 1m/s, p", "speed = 1, p", "missing-unit"),
    mistake("speed = 1m/s, p", "speed = 1m, p", "wrong-unit"),
    mistake("speed = 1m/s, p", "speed = \"fast\", p", "wrong-value"),
    mistake("speed = 1m/s, p", "sped = 1m/s, p", "unknown-argument"),
    mistake("speed = 1m/s, p", "1m/s, p", "unnamed-argument"),
    mistake("speed = 1m/s, p", "speed: 1m/s, p", "syntax"),
    // Keywords and punctuation.
    mistake("node begin = Pass();", "node begin = Pass()", "syntax"),
    mistake("node retry = Pass()", "retry = Pass()", "syntax"),
    mistake("node retry = Pass()", "Pass retry", "syntax"),
    mistake("node retry = Pass()", "let retry = Pass()", "syntax"),
    mistake("slot  go: u64", "slot go: &u64", "syntax"),
    mistake("slot  go: u64", "slot go: std_msgs/UInt64", "syntax"),
    mistake("slot  go: u64", "slot u64 go", "syntax"),
    mistake("slot  go: u64", "slot go: u46", "unknown-type"),
    mistake("use library::edges;", "#include <library>", "unknown-character"),
    mistake("use library::edges;", "import library.edges;", "syntax"),
    mistake("robot Courier {", "Robot Courier {", "syntax"),
    mistake("GoTo(speed = 0.5m/s)", "GoTo(speed = 0.5m/s", "unclosed"),
    mistake("fetch.there  => carry.go", "fetch.there >> carry.go", "syntax"),
    mistake("fetch.there  => carry.go", "fetch.there --> carry.go", "syntax"),
    mistake("fetch.there  => carry.go", "fetch.there carry.go", "syntax"),
    mistake("fetch.there  => carry.go", "carry.go => fetch.there", "wrong-direction"),
    // State machines.
    mistake("if order > 0", "if ordr > 0", "unknown-name"),
    mistake("if order > 0", "when order > 0", "syntax"),
    mistake("state waiting {", "state waitng {", "unknown-state"),
    mistake("=> away", "=> awya", "unknown-state"),
    mistake("on arrived", "on arived", "unknown-port"),
    mistake("-> drive(1)", "-> drvie(1)", "unknown-port"),
    mistake("entry -> lamp(false)", "entry -> lamp", "missing-argument"),
    mistake("slot  failed: u64", "in failed: u64", "fsm-port"),
    mistake("on arrived => waiting", "arrived => waiting", "syntax"),
    // Claims, threads, recordings.
    mistake("exclusive(fetch, carry", "exclusive(fetch, cary", "unknown-node"),
    mistake("claim exclusive(", "claim exclusiv(", "unknown-claim"),
    mistake("exclusive(fetch, carry, dock)", "exclusive(fetch)", "wrong-claim"),
    mistake("exclusive(fetch, carry", "exclusive(fetch.base, carry", "wrong-claim"),
    mistake("every 100ms on vision", "every 100ms on visoin", "threads"),
    mistake("thread vision", "thread visoin", "threads"),
    mistake("cores = [1]", "core = [1]", "threads"),
    mistake("priority = 80", "priority = 800", "wrong-value"),
    mistake("{ clock; }", "{ clokc; }", "unknown-port"),
    // Tests.
    mistake("feed go = 1", "feed og = 1", "unknown-port"),
    mistake("feed go = 1", "feed go", "missing-argument"),
    mistake("feed go = 1", "feed go = \"one\"", "wrong-value"),
    mistake("expect there ==", "expect their ==", "unknown-node"),
    mistake("expect there == 1", "expect there = 1", "syntax"),
    mistake("within 10ms", "within 10", "missing-unit"),
    mistake("expect there == 1", "assert there == 1", "syntax"),
    mistake("wait 1s", "sleep 1s", "syntax"),
];

/// Mistakes in `mistakes/pipeline.afg`.
const PIPELINE: &[Mistake] = &[
    mistake("y    -> tuned -> both.b", "y -> tuned -> both.a", "connected-twice"),
    mistake("y    -> tuned -> both.b", "y -> tuned -> both", "ambiguous-port"),
    mistake("near  -> all.a", "naer -> all.a", "unknown-node"),
    mistake("near  -> all.a", "near.c -> all.a", "unknown-port"),
    mistake("near  -> all.a", "all.a -> near", "wrong-direction"),
    mistake("r     -> [near.x", "pic -> [near.x", "type-mismatch"),
    mistake("eye.scan  -> seen.scan", "eye.scan -> seen.image", "type-mismatch"),
    mistake("eye.scan  -> seen.scan", "eye.scna -> seen.scan", "unknown-port"),
    mistake("Line(factor = 2)", "Line()", "missing-argument"),
    mistake("mul(k = factor)", "mul(k = facter)", "unknown-name"),
    mistake("mul(k = factor)", "mul()", "missing-argument"),
    mistake("mul(k = factor)", "mul(k = factor, k = 2)", "duplicate-argument"),
    mistake("factor = 3, gap = 1m", "factor = 3, gap = 5m", "out-of-range"),
    mistake("factor = 3, gap = 1m", "factor = -3, gap = 1m", "out-of-range"),
    mistake("gap = gap", "gap = 3m", "out-of-range"),
    mistake("count = 3", "count = 300", "out-of-range"),
    mistake("count = 3", "count = 3.5", "wrong-value"),
    mistake("wait = 20ms", "wait = 20", "missing-unit"),
    mistake("wait = 20ms", "wait = 20 ms", "syntax"),
    mistake("frame = \"map\"", "frame = map", "unknown-name"),
    mistake("frame = \"map\"", "frame = 'map'", "unknown-character"),
    mistake("Twice() each", "Twice() foreach", "syntax"),
    mistake("items -> twice", "r -> twice", "type-mismatch"),
    mistake("delay 0", "delay zero", "unknown-name"),
    elsewhere("double() delay 0", "double()", "cycle", "added -> last -> added.b"),
    mistake("total -> show()", "total -> show", "unknown-node"),
    mistake("node total = sum()", "node total = sum", "syntax"),
    mistake("both   = sum()", "both = sum() every 20ms", "every-on-driven"),
    elsewhere("both -> z;", "", "open-output", "out z"),
    elsewhere("all   -> total.a;", "", "open-input", "node total"),
    mistake("in  one: u64;", "in one u64;", "syntax"),
    mistake("in  one: u64;", "in one: Pose2;", "unknown-type"),
    mistake("in  one: u64;", "input one: u64;", "syntax"),
    mistake("graph Twice {", "class Twice {", "syntax"),
    mistake("graph Twice {", "graph Line {", "duplicate-name"),
];

/// Result of a mistake.
struct Told {
    /// The change.
    change: String,
    /// Number of messages.
    count: usize,
    /// Deficiencies of the messages.
    complaints: Vec<String>,
}

fn told(path: &str, text: &str, mistake: &Mistake, catalog: &mut Catalog) -> Told {
    let change = format!("{path}: `{}` → `{}`", mistake.right, mistake.wrong);
    let at = text.find(mistake.right).unwrap_or_else(|| panic!("{change}: the right text has no such words"));
    let wrong = text.replace(mistake.right, mistake.wrong);
    let common = mistake.right.bytes().zip(mistake.wrong.bytes()).take_while(|(a, b)| a == b).count();
    let line_of = |at: usize| wrong[..at].matches('\n').count() + 1;
    let line = mistake.at.map_or_else(|| line_of(at + common), |words| line_of(wrong.find(words).unwrap()));
    let compiled = compile(&folder().join("mistakes").join(path), &wrong, catalog);
    let messages = compiled.diagnostics.sorted();
    let mut complaints = vec![];
    match messages.first() {
        None => complaints.push("is accepted".to_owned()),
        Some(first) => {
            let (found, _) = compiled.sources.line_column(first.primary.span.file, first.primary.span.start);
            if first.code != mistake.code || found != line {
                complaints.push(format!("first `{}` in line {found}, not `{}` in {line}", first.code, mistake.code));
            }
        }
    }
    let count = messages.len() + compiled.diagnostics.left_out();
    if count > 3 {
        complaints.push(format!("{count} messages"));
    }
    if !complaints.is_empty() || std::env::var_os("APEX_SHOW_MESSAGES").is_some() {
        complaints.extend(messages.iter().map(|d| {
            let (line, _) = compiled.sources.line_column(d.primary.span.file, d.primary.span.start);
            format!("  {line}: {}: {} {:?}", d.code, d.message, d.notes)
        }));
    }
    Told { change, count, complaints }
}

fn all() -> Vec<Told> {
    let mut catalog = catalog();
    let mut all = vec![];
    for (path, mistakes) in [("delivery.afg", DELIVERY), ("pipeline.afg", PIPELINE)] {
        let text = fs::read_to_string(folder().join("mistakes").join(path)).unwrap();
        let right = compile(&folder().join("mistakes").join(path), &text, &mut catalog);
        let messages: Vec<&str> = right.diagnostics.sorted().iter().map(|d| d.message.as_str()).collect();
        assert!(messages.is_empty(), "{path} is not right: {messages:#?}");
        all.extend(mistakes.iter().map(|mistake| told(path, &text, mistake, &mut catalog)));
    }
    all
}

#[test]
fn one_mistake_is_one_message() {
    let all = all();
    assert!(all.len() >= 100, "{} mistakes", all.len());
    let wrong: Vec<String> = all
        .iter()
        .filter(|told| !told.complaints.is_empty())
        .map(|told| format!("{}\n  {}", told.change, told.complaints.join("\n  ")))
        .collect();
    let mut counts: Vec<usize> = all.iter().map(|told| told.count).collect();
    counts.sort_unstable();
    let (median, most) = (counts[counts.len() / 2], counts[counts.len() - 1]);
    assert!(wrong.is_empty(), "{} of {}, median {median}, most {most}:\n{}", wrong.len(), all.len(), wrong.join("\n"));
    assert_eq!(median, 1);
}
