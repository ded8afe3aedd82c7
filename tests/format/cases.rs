//! Input and output: in `cases.md` every section has a source file and its formatted version, or one that stays
//! unchanged.

use crate::properties::check;

#[test]
fn cases() {
    let sections: Vec<&str> = include_str!("cases.md").split("\n## ").skip(1).collect();
    assert!(sections.len() > 10);
    for section in sections {
        let blocks: Vec<&str> =
            section.split("```afg\n").skip(1).filter_map(|rest| Some(rest.split_once("```")?.0)).collect();
        let (before, after) = match blocks[..] {
            [same] => (same, same),
            [before, after] => (before, after),
            _ => panic!("a section has one text or two:\n{section}"),
        };
        assert_eq!(check(section, before).as_deref(), Some(after), "{section}");
    }
}

#[test]
fn line_ends_are_those_of_the_first_line() {
    let formatted = |text: &str| check("line ends", text).unwrap();
    assert_eq!(formatted("graph A {\r\n\tin x: u64;\n}"), "graph A {\r\n    in x: u64;\r\n}\r\n");
    assert_eq!(formatted("graph A {\n\tin x: u64;\r\n}\r\n"), "graph A {\n    in x: u64;\n}\n");
    assert_eq!(formatted("graph A {}"), "graph A {}\n");
    assert_eq!(formatted(" \n\n"), "");
}

/// Strings are values: they are not changed, whatever the line ends around them.
#[test]
fn strings_stay_as_they_are() {
    let string = "\"one \n  two\t\r\n\"";
    let text = format!("graph A {{\r\n    node a = B(\r\n        text = {string},\r\n    );\r\n}}\r\n");
    assert_eq!(check("strings", &text), Some(text));
}
