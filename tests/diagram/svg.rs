//! The pictures are valid XML for any text in a source file.

use crate::{Drawer, random};
use apex_diagram::{states, svg};
use roxmltree::Document;

#[test]
fn random_pictures_are_well_formed() {
    for (text, item) in random(24) {
        for picture in [Some(item.clone()), states(&item)].into_iter().flatten() {
            let svg = svg(&picture);
            let document = Document::parse(&svg).unwrap_or_else(|e| panic!("{e}\n{text}\n{svg}"));
            let boxes = document.descendants().filter(|n| n.attribute("class").is_some_and(|c| c.starts_with("item")));
            assert_eq!(boxes.count(), picture.count());
        }
    }
}

#[test]
fn names_and_texts_are_escaped() {
    let text = "use apex_nodes::io::ScanPicture;
use apex_tests::nodes::{Count, Snk};
/// <script>alert(\"1\")</script> & more\u{7} ]]>
graph A {
    /// </title><b>
    node s = Count();
    s -> Snk();
}
";
    let svg = svg(&Drawer::new().one(&text.replace("use apex_nodes::io::ScanPicture;\n", "")));
    let document = Document::parse(&svg).expect("it is XML");
    assert!(document.descendants().all(|n| !n.has_tag_name("script") && !n.has_tag_name("b")));
    assert!(svg.contains("&lt;script&gt;"), "{svg}");
}

#[test]
fn strings_may_hold_anything() {
    let text = "use apex_tests::nodes::Words; graph A { node w = Words(words = [\"<a & \\\"b\\\">\", \"日本\"]); }";
    let svg = svg(&Drawer::new().one(text));
    assert!(Document::parse(&svg).is_ok(), "{svg}");
    assert!(svg.contains("日本"), "{svg}");
}
