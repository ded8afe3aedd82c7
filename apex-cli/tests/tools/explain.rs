use crate::common::{Folder, apex};

const TEXT: &str = "\
graph Outer {
    in  x: f64;
    in  other: f64;
    out y: f64;
    node inner = Inner();
    in.* -> inner.* -> out.*;
}

graph Inner {
    in  x: f64;
    out y: f64;
    x -> y;
}
";

#[test]
fn connections_by_name_are_listed_at_the_end() {
    let folder = Folder::new("explain-by-name");
    let output = apex().arg("explain").arg(folder.file("outer.afg", TEXT)).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let listed = "connections by name\n  line 6\n    x -> inner.x\n  line 6\n    inner.y -> y\n";
    assert!(text.trim_end().ends_with(listed.trim_end()), "{text}");
}
