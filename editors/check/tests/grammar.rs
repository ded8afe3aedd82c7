//! The tree-sitter grammar: reads what the compiler reads, and gives the trees that the corpus shows.

use apex_editors::{generate, grammar, language, parse};
use std::{
    fs,
    path::{Path, PathBuf},
};
use tree_sitter::{Node, Query, QueryCursor, StreamingIterator as _};

/// All texts of the repository, but those that are wrong on purpose.
fn texts() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut open, mut found) = (vec![root], vec![]);
    while let Some(folder) = open.pop() {
        for path in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            let skipped = ["target", "node_modules", "errors", "hostile", "fail", "out"].contains(&name.as_str());
            if path.is_dir() && !skipped && !name.starts_with('.') {
                open.push(path);
            } else if name.ends_with(".afg") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The first place that the parser could not read.
fn error<'a>(node: Node<'a>) -> Option<Node<'a>> {
    if node.is_error() || node.is_missing() {
        return Some(node);
    }
    let mut cursor = node.walk();
    node.children(&mut cursor).filter(Node::has_error).find_map(error)
}

#[test]
fn all_texts_of_the_repository() {
    let texts = texts();
    assert!(texts.len() > 50, "only {} texts", texts.len());
    for path in texts {
        let text = fs::read_to_string(&path).unwrap();
        let tree = parse(&text);
        if let Some(node) = error(tree.root_node()) {
            panic!("{}:{}: {}", path.display(), node.start_position().row + 1, node.to_sexp());
        }
    }
}

/// The examples of the documentation.
#[test]
fn all_examples() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut count = 0;
    for page in ["README.md", "docs/language.md"] {
        let page = fs::read_to_string(root.join(page)).unwrap();
        for example in page.split("```afg\n").skip(1) {
            let text = example.split("```").next().unwrap();
            assert!(error(parse(text).root_node()).is_none(), "{text}");
            count += 1;
        }
    }
    assert!(count > 10, "only {count} examples");
}

/// A tree as the corpus shows it, without the names of fields.
fn shape(node: Node<'_>) -> String {
    let mut cursor = node.walk();
    let children: Vec<String> = node.named_children(&mut cursor).map(shape).collect();
    let children: String = children.iter().map(|c| format!(" {c}")).collect();
    format!("({}{children})", node.kind())
}

#[test]
fn the_corpus() {
    let text = fs::read_to_string(grammar().join("test/corpus/items.txt")).unwrap();
    let bar = "==================\n";
    let parts: Vec<&str> = text.split(bar).skip(1).collect();
    assert!(parts.len() >= 12 && parts.len().is_multiple_of(2));
    for case in parts.chunks(2) {
        let (source, expected) = case[1].split_once("\n---\n").unwrap();
        let expected: Vec<&str> = expected.split_whitespace().collect();
        let tree = parse(source);
        assert!(error(tree.root_node()).is_none(), "{}: {}", case[0], tree.root_node().to_sexp());
        assert_eq!(shape(tree.root_node()), expected.join(" "), "{}", case[0]);
    }
}

/// Texts that the compiler refuses are errors here, too: the grammar does not accept everything.
#[test]
fn wrong_texts() {
    for text in ["graph A { x -> ; }", "graph A { node = B(); }", "graph { }", "use a::;", "test t { }"] {
        assert!(error(parse(text).root_node()).is_some(), "{text}");
    }
}

#[test]
fn colours() {
    let query = fs::read_to_string(grammar().join("queries/highlights.scm")).unwrap();
    let query = Query::new(&language(), &query).unwrap();
    let text = "/// A.\ngraph Find(gap: f32[m] = 15cm) { in scan: Scan; scan -> Jump(gap = gap) => exit; }";
    let tree = parse(text);
    let mut cursor = QueryCursor::new();
    let mut found = vec![];
    let mut matches = cursor.captures(&query, tree.root_node(), text.as_bytes());
    while let Some((one, index)) = matches.next() {
        let capture = one.captures[*index];
        let name = query.capture_names()[capture.index as usize];
        found.push((&text[capture.node.byte_range()], name));
    }
    for wanted in [
        ("/// A.", "comment.documentation"),
        ("graph", "keyword.type"),
        ("Find", "type"),
        ("gap", "variable.parameter"),
        ("cm", "type.builtin"),
        ("Scan", "type"),
        ("=>", "operator"),
        ("Jump", "function"),
        ("exit", "variable.builtin"),
    ] {
        assert!(found.contains(&wanted), "{wanted:?} is not in {found:?}");
    }
    assert!(!found.contains(&("scan", "variable.builtin")));
}

/// The generated parser is complete for packagers: tables, headers, and their descriptions.
#[test]
fn the_parser_can_be_written_elsewhere() {
    let folder = std::env::temp_dir().join(format!("apex-tree-sitter-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let made = generate(&folder);
    let files = ["parser.c", "grammar.json", "node-types.json", "tree_sitter/parser.h"];
    let missing: Vec<&str> = files.into_iter().filter(|name| !folder.join(name).is_file()).collect();
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(made, Ok(()));
    assert_eq!(missing, Vec::<&str>::new());
}
