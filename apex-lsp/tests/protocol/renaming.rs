//! Renaming.

use crate::client::{Client, position, unsaved, uri};
use serde_json::{Value, json};
use std::path::Path;

const TEXT: &str = "use apex_nodes::scan::{JumpDistance, Scan, Segments};
graph Find(gap: f32[m] = 15cm) {
    in  scan: Scan;
    out segments: Segments;
    node jump = JumpDistance(gap = gap);
    scan -> jump.scan;
    jump -> segments;
    claim exclusive(jump, jump);
}
graph Twice {
    in   input: Scan;
    node one = Find();
    node two = Find(gap = 1m);
    input -> [one, two.scan];
}
graph Same {
    in   alike: Scan;
    out  equal: Segments;
    node find = Inside();
    in.* -> find.*;
    find.* -> out.*;
}
graph Inside { in alike: Scan; out equal: Segments; node one = Find(); alike -> one -> equal; }
fsm Door { slot go; event ring; state shut { on go => open -> ring; } state open { on go => shut; } }
test finds: Find { expect active(jump); }
";

/// Renames the `n`th `word` of a source file.
fn rename(client: &mut Client, path: &Path, text: &str, (word, n): (&str, usize), name: &str) -> Result<Value, String> {
    client.open(path, text);
    let at = text.match_indices(word).nth(n).unwrap().0;
    client.ask_at(path, position(&text[..at]), "rename", json!({ "newName": name }))
}

/// Applies the edits of a source file.
fn applied(text: &str, path: &Path, edit: &Value) -> String {
    let mut edits = edit["changes"][uri(path)].as_array().cloned().unwrap_or_default();
    edits.sort_by_key(|e| {
        std::cmp::Reverse((e["range"]["start"]["line"].as_u64(), e["range"]["start"]["character"].as_u64()))
    });
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    for edit in edits {
        let number = |end: &str, key: &str| edit["range"][end][key].as_u64().unwrap() as usize;
        let line = &mut lines[number("start", "line")];
        line.replace_range(number("start", "character")..number("end", "character"), edit["newText"].as_str().unwrap());
    }
    lines.join("\n")
}

#[test]
fn everything_that_a_text_names() {
    let mut client = Client::start();
    let path = unsaved("renaming.afg");
    let all = TEXT;
    for ((word, n), name, expected) in [
        (("jump", 1), "split", all.replace("jump", "split")),
        (("Find", 1), "Search", all.replace("Find", "Search")),
        (("two", 1), "second", all.replace("two", "second")),
        (("segments", 1), "parts", all.replace("segments", "parts")),
        (
            ("scan: Scan", 0),
            "view",
            all.replace("in  scan", "in  view").replace("    scan ->", "    view ->").replace("two.scan", "two.view"),
        ),
        (
            ("gap: f32", 0),
            "jump_width",
            all.replace("gap: f32", "jump_width: f32")
                .replace("= gap)", "= jump_width)")
                .replace("Find(gap", "Find(jump_width"),
        ),
        (("shut", 1), "closed", all.replace("shut", "closed")),
        (("ring", 1), "bell", all.replace("ring", "bell")),
        (("finds", 0), "works", all.replace("finds", "works")),
    ] {
        let edit = rename(&mut client, &path, TEXT, (word, n), name).unwrap();
        assert_eq!(applied(TEXT, &path, &edit), expected, "{word} → {name}");
    }
    assert!(client.stop());
}

#[test]
fn a_node_and_its_exchange() {
    let mut client = Client::start();
    let path = unsaved("variants.afg");
    let text = "graph Wide(gap: f32[m] = 15cm) {
    in  scan: Scan;
    node jump = JumpDistance(gap = gap);
    scan -> jump;
}
graph Narrow(gap: f32[m] = 5cm) = Wide {
    out segments: Segments;
    node jump = JumpDistance(gap = gap * 2);
    jump -> segments;
}
";
    let text = &format!("use apex_nodes::scan::{{JumpDistance, Scan, Segments}};\n{text}");
    let renamed = |from: &str, to: &str| {
        let words = |line: &str| line.replace(&format!("node {from} "), &format!("node {to} "));
        let ends = words(text).replace(&format!("{from};"), &format!("{to};"));
        ends.replace(&format!("{from} ->"), &format!("{to} ->"))
    };
    for place in [0, 1, 2, 3] {
        let edit = rename(&mut client, &path, text, ("jump", place), "edges").unwrap();
        assert_eq!(applied(text, &path, &edit), renamed("jump", "edges"), "{place}");
    }
    let edit = rename(&mut client, &path, text, ("Wide", 1), "Broad").unwrap();
    assert_eq!(applied(text, &path, &edit), text.replace("Wide", "Broad"));
    assert!(client.stop());
}

#[test]
fn refusals_say_why() {
    let mut client = Client::start();
    let path = unsaved("renaming.afg");
    for ((word, n), name, reason) in [
        (("jump", 0), "segments", "`Find` already has a port or node `segments`"),
        (("jump", 0), "node", "`node` is a reserved word"),
        (("jump", 0), "1st", "`1st` is not a valid name: use letters, digits and `_`, not starting with a digit"),
        (("jump", 0), "größe", "`größe` is not a valid name: use letters, digits and `_`, not starting with a digit"),
        (("jump", 0), "", "`` is not a valid name: use letters, digits and `_`, not starting with a digit"),
        (("jump", 0), "start", "`start` is predefined in every graph and would be hidden"),
        (("Find", 0), "ScanLog", "there is already a node `ScanLog`, which would be hidden"),
        (("shut", 0), "open", "`Door` already has a state `open`"),
        (("JumpDistance", 1), "Jump", "this is declared in Rust; rename it there"),
        (("f32", 0), "f64", "there is no name here"),
        (("alike", 0), "like", "`.*` connects `alike` by its name; write these connections out first"),
        (("equal", 1), "like", "`.*` connects `equal` by its name; write these connections out first"),
    ] {
        let found = rename(&mut client, &path, TEXT, (word, n), name);
        assert_eq!(found, Err(reason.to_owned()), "{word} → {name}");
    }
    let found = rename(&mut client, &path, TEXT, ("Find", 0), "Twice").unwrap_err();
    assert!(found.starts_with("`Twice` already has a meaning in ") && found.ends_with("renaming.afg"), "{found}");
    assert!(client.stop());
}

#[test]
fn a_graph_and_the_texts_that_import_it() {
    let mut client = Client::start();
    let (inner, outer, other) = (unsaved("re_inner.afg"), unsaved("re_outer.afg"), unsaved("re_other.afg"));
    let texts = [
        (&inner, "graph Inner { in x: u8; }\n"),
        (&outer, "use re_inner::Inner;\ngraph Outer { in x: u8; node i = Inner(); x -> i.x; }\n"),
        (&other, "use re_inner::Inner as Mine;\ngraph Other { in y: u8; y -> Mine(); }\n"),
    ];
    texts.iter().for_each(|(path, text)| client.open(path, text));
    let edit = rename(&mut client, &inner, texts[0].1, ("Inner", 0), "Core").unwrap();
    assert_eq!(applied(texts[0].1, &inner, &edit), "graph Core { in x: u8; }\n");
    assert_eq!(applied(texts[1].1, &outer, &edit), texts[1].1.replace("Inner", "Core"));
    // A name that an import introduces is kept.
    assert_eq!(applied(texts[2].1, &other, &edit), texts[2].1.replace("Inner", "Core"));
    // The port, seen from outside.
    let edit = rename(&mut client, &outer, texts[1].1, ("i.x", 0), "j").unwrap();
    assert_eq!(applied(texts[1].1, &outer, &edit), texts[1].1.replace("node i", "node j").replace("i.x", "j.x"));
    let at = position(&texts[1].1[..texts[1].1.find("i.x").unwrap() + 2]);
    let edit = client.ask_at(&outer, at, "rename", json!({ "newName": "value" })).unwrap();
    assert_eq!(applied(texts[0].1, &inner, &edit), "graph Inner { in value: u8; }\n");
    assert_eq!(applied(texts[1].1, &outer, &edit), texts[1].1.replace("i.x", "i.value"));
    // A name that has a meaning in one of the source files is refused.
    let found = rename(&mut client, &inner, texts[0].1, ("Inner", 0), "Outer").unwrap_err();
    assert!(found.ends_with("re_outer.afg"), "{found}");
    let found = rename(&mut client, &other, texts[2].1, ("Mine", 1), "Yours").unwrap_err();
    assert_eq!(found, "this is another name for `Inner` from an import; rename `Inner` itself, or change the import");
    assert!(client.stop());
}

#[test]
fn before_it_is_renamed() {
    let mut client = Client::start();
    let path = unsaved("renaming.afg");
    client.open(&path, TEXT);
    let at = TEXT.find("jump").unwrap();
    let found = client.ask_at(&path, position(&TEXT[..at]), "prepareRename", json!({})).unwrap();
    assert_eq!(
        (found["placeholder"].as_str(), &found["range"]["start"]),
        (Some("jump"), &json!({ "line": 4, "character": 9 }))
    );
    let at = TEXT.find("f32").unwrap();
    assert_eq!(
        client.ask_at(&path, position(&TEXT[..at]), "prepareRename", json!({})),
        Err("there is no name here".to_owned())
    );
    assert!(client.stop());
}
