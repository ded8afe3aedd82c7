//! `apex doc`: the set of pages, their links, and the files that are never changed.

use crate::common::{Folder, apex, package, stderr};
use std::{
    collections::BTreeMap,
    fs,
    path::Path,
    process::{Command, Output},
};

const NODES: &str = "\
use apex_rt::prelude::*;
/// Counts up to [`Total`]. <script>alert(1)</script>
#[node]
pub fn ramp(#[param(default = 2.0, range = 1.0..=9.0, unit = \"m\")] step: f64) -> u64 { step as u64 }
/// Adds up.
/// ```text
/// sum
///     += x
/// ```
#[node]
#[derive(Default)]
pub struct Total {
    sum: u64,
}
#[node]
impl Total {
    fn process(&mut self, x: &u64) { self.sum += x; }
    /// Begins again.
    #[slot]
    fn clear(&mut self) { self.sum = 0; }
}
";

const ROBOT: &str = "\
//! A <script>alert(2)</script> robot.
use crate::ramp;
use parts::{Inner, Lamp};

/// The whole.
/// Contains [`Inner`].
///
/// ```text
/// inner
///     total
/// ```
robot Robot(
    /// Distance to drive.
    step: f64[m] = 3m in 1..=5,
) {
    node inner = Inner();
    node lamp  = Lamp();
    ramp(step = step) -> inner.x;
    start    => inner.go;
    lamp.lit -> inner.clear;

    claim conserved;
}

/// Adds <b>nothing</b>.
test adds: Inner {
    wait 10ms;
}
";

const PARTS: &str = "\
/// A part that stands in a robot.
graph Inner {
    /// Number to add.
    in   x: u64;
    slot go;
    slot clear;
    node total = Total();
    x          -> total;
    go         => total.enable;
    clear      -> total.clear;
}

/// On or off.
fsm Lamp {
    slot  press;
    event lit;
    /// Dark.
    state off {
        on press => shining -> lit;
    }
    state shining {
        on press => off;
    }
}
";

/// A package with two source files.
fn project(name: &str) -> Folder {
    let folder = Folder::new(name);
    package(&folder, NODES);
    folder.file("robot.afg", ROBOT);
    folder.file("parts.afg", format!("use crate::Total;\n{PARTS}"));
    folder
}

/// `apex doc` with these arguments, in a folder.
fn doc(folder: &Folder, arguments: &[&str]) -> Output {
    let mut command: Command = apex();
    command.arg("doc").args(arguments).current_dir(&folder.0).env_remove("CARGO_TARGET_DIR");
    command.output().unwrap()
}

/// All files in a folder.
fn files(folder: &Path) -> BTreeMap<String, String> {
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths.map(|path| (name(&path), fs::read_to_string(path).unwrap())).collect()
}

fn pages(folder: &Path) -> BTreeMap<String, String> {
    let mut files = files(folder);
    files.remove(".apex-doc").unwrap();
    files
}

/// All links lead to pages, and all pages can be reached.
fn assert_linked(pages: &BTreeMap<String, String>) {
    let links = |page: &str| -> Vec<String> {
        pages[page].split("href=\"").skip(1).map(|rest| rest.split('"').next().unwrap().to_owned()).collect()
    };
    let (mut reached, mut open) = (vec![], vec!["index.html".to_owned()]);
    while let Some(page) = open.pop() {
        assert!(pages.contains_key(&page), "{page}");
        if !reached.contains(&page) {
            open.extend(links(&page).into_iter().filter(|link| !link.starts_with("https://")));
            reached.push(page);
        }
    }
    reached.sort();
    assert_eq!(reached, pages.keys().cloned().collect::<Vec<_>>());
}

#[test]
fn pages_of_texts_and_of_what_they_use() {
    let folder = project("doc-pages");
    let output = doc(&folder, &["robot.afg", "--output", "pages"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(said, format!("wrote 8 pages; begin with {}\n", Path::new("pages").join("index.html").display()));
    let pages = pages(&folder.0.join("pages"));
    assert_linked(&pages);
    for (page, parts) in [
        ("index.html", &["A part that stands in a robot.", "On or off.", "Adds up.", "<code>doc_pages</code>"][..]),
        ("robot.html", &["href=\"robot.Robot.html\"", "<code>adds</code>", "Adds &lt;b&gt;nothing&lt;/b&gt;."]),
        (
            "robot.Robot.html",
            &[
                "<svg ",
                "<h2>Activity</h2>",
                "Contains <a href=\"parts.Inner.html\"><code>Inner</code></a>.",
                "range <code>1..=5</code> · default <code>3m</code>",
                "Distance to drive.",
                "inner\n    total\n",
                "<code>step = step</code>",
                "href=\"doc_pages.ramp.html\"",
                "href=\"parts.Lamp.html\"",
                "<code>claim conserved</code> <span class=\"soft\">holds</span>",
                "robot Robot(\n",
            ],
        ),
        (
            "parts.Inner.html",
            &["<svg ", "input · <code>u64</code>", "Number to add.", "<code>adds</code>", "href=\"robot.Robot.html\""],
        ),
        ("parts.Lamp.html", &["<svg ", "<code>shining</code>", "Dark.", "press / lit"]),
        (
            "doc_pages.Total.html",
            &[
                "use crate::Total;",
                "src/lib.rs:12",
                "sum\n    += x\n",
                "node Total\n",
                "Begins again.",
                "href=\"parts.Inner.html\"",
            ],
        ),
        ("doc_pages.ramp.html", &["in <code>m</code> · range <code>1..=9</code> · default <code>2</code>"]),
    ] {
        for part in parts {
            assert!(pages[page].contains(part), "{page} has no {part}:\n{}", pages[page]);
        }
    }
}

#[test]
fn no_page_runs_what_stands_in_a_text() {
    let folder = project("doc-script");
    assert_eq!(doc(&folder, &["robot.afg", "-o", "pages"]).status.code(), Some(0));
    let pages = pages(&folder.0.join("pages"));
    let shown =
        |page: &str, script: &str| pages[page].matches(&format!("&lt;script&gt;{script}&lt;/script&gt;")).count();
    assert!(shown("doc_script.ramp.html", "alert(1)") > 0 && shown("robot.html", "alert(2)") > 0);
    for (name, page) in &pages {
        assert!(!page.contains("<script") && !page.contains("<b>"), "{name}");
        assert!(page.contains("default-src 'none'"), "{name}");
    }
}

/// The graphs and robots of the repository, from another folder.
#[test]
fn the_robots_of_the_repository() {
    let folder = Folder::new("doc-robots");
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let output = apex().arg("doc").arg(&robots).arg("-o").arg(folder.0.join("pages")).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let pages = pages(&folder.0.join("pages"));
    assert_linked(&pages);
    for page in
        ["patsy.patsy.Simulated.html", "rover.robot.Mission.html", "apex_nodes.flow.Wait.html", "rover.free_ahead.html"]
    {
        assert!(pages.contains_key(page), "{page}");
    }
    for (name, page) in &pages {
        let outside = robots.parent().unwrap().canonicalize().unwrap();
        assert!(!page.contains(outside.to_str().unwrap()), "{name} names a folder of this machine");
    }
}

#[test]
fn the_same_texts_give_the_same_pages_in_any_order() {
    let folder = project("doc-twice");
    let arguments =
        [&["robot.afg", "-o", "a"][..], &["robot.afg", "-o", "a"], &["parts.afg", "./robot.afg", "-o", "b"]];
    let runs = arguments.map(|arguments| {
        assert_eq!(doc(&folder, arguments).status.code(), Some(0));
        files(&folder.0.join(arguments[arguments.len() - 1]))
    });
    assert!(runs[0] == runs[1] && runs[1] == runs[2]);
}

#[test]
fn without_a_folder_pages_go_where_cargo_builds() {
    let folder = project("doc-default");
    assert_eq!(doc(&folder, &["."]).status.code(), Some(0));
    assert_eq!(pages(&folder.0.join("target/apex/doc")).len(), 8);

    let outside = Folder::new("doc-outside");
    outside.file("a.afg", "graph A { }\n");
    let output = doc(&outside, &["a.afg"]);
    assert_eq!((output.status.code(), files(&outside.0).len()), (Some(2), 1));
    assert_eq!(
        stderr(&output),
        "error: `a.afg` does not belong to a package: choose a folder for the pages with `--output`\n"
    );
    let output = doc(&outside, &["missing.afg"]);
    assert_eq!(stderr(&output), "error: cannot read `missing.afg`: there is no such file\n");
}

#[test]
fn old_pages_go_and_other_files_stay() {
    let folder = Folder::new("doc-old");
    let pages = folder.0.join("pages");
    folder.file("a.afg", "graph A { }\n\ngraph B { }\n");
    assert_eq!(doc(&folder, &["a.afg", "-o", "pages"]).status.code(), Some(0));
    fs::write(pages.join("notes.html"), "mine").unwrap();
    // A list with additional entries.
    folder.file("precious.html", "mine");
    let list = fs::read_to_string(pages.join(".apex-doc")).unwrap();
    fs::write(pages.join(".apex-doc"), list + "../precious.html\n../a.afg\n/tmp\n").unwrap();

    folder.file("a.afg", "graph A { }\n");
    assert_eq!(doc(&folder, &["a.afg", "-o", "pages"]).status.code(), Some(0));
    let names: Vec<String> = files(&pages).into_keys().collect();
    assert_eq!(names, [".apex-doc", "a.A.html", "a.html", "index.html", "notes.html"]);
    assert!(folder.0.join("precious.html").exists() && folder.0.join("a.afg").exists());

    fs::write(pages.join("a.B.html"), "mine").unwrap();
    let before = files(&pages);
    folder.file("a.afg", "graph A { }\n\ngraph B { }\n");
    let output = doc(&folder, &["a.afg", "-o", "pages"]);
    assert_eq!((output.status.code(), files(&pages)), (Some(2), before));
    assert!(
        stderr(&output).ends_with("a.B.html` was not written by `apex doc`: move it elsewhere\n"),
        "{}",
        stderr(&output)
    );
}

/// A list from a third party names files that `apex doc` did not make: they are neither removed nor overwritten.
#[test]
fn a_planted_list_takes_nothing() {
    let folder = Folder::new("doc-planted");
    let pages = folder.0.join("pages");
    fs::create_dir(&pages).unwrap();
    fs::write(pages.join(".apex-doc"), "Made by `apex doc`\nmine.html\nlink.html\n../up.html\nfolder.html\n").unwrap();
    fs::write(pages.join("mine.html"), "<p>mine</p>").unwrap();
    fs::create_dir(pages.join("folder.html")).unwrap();
    folder.file("a.afg", "graph A { }\n");
    assert_eq!(doc(&folder, &["a.afg", "-o", "made"]).status.code(), Some(0));
    // A page of another folder, and a link to it.
    let page = fs::read(folder.0.join("made/a.html")).unwrap();
    folder.file("up.html", &page);
    #[cfg(unix)]
    std::os::unix::fs::symlink("../up.html", pages.join("link.html")).unwrap();
    let output = doc(&folder, &["a.afg", "-o", "pages"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(pages.join("mine.html")).unwrap(), "<p>mine</p>");
    assert!(folder.0.join("up.html").exists() && pages.join("folder.html").is_dir());
    #[cfg(unix)]
    assert!(pages.join("link.html").symlink_metadata().is_ok());

    fs::write(pages.join("a.A.html"), "mine").unwrap();
    let output = doc(&folder, &["a.afg", "-o", "pages"]);
    assert_eq!(
        (output.status.code(), fs::read_to_string(pages.join("a.A.html")).unwrap()),
        (Some(2), "mine".to_owned())
    );
    assert!(
        stderr(&output).ends_with("a.A.html` was not written by `apex doc`: move it elsewhere\n"),
        "{}",
        stderr(&output)
    );
}

#[test]
fn a_folder_with_other_things_is_refused() {
    let folder = Folder::new("doc-other");
    folder.file("a.afg", "graph A { }\n");
    let output = doc(&folder, &["a.afg", "-o", "."]);
    assert_eq!((output.status.code(), files(&folder.0).len()), (Some(2), 1));
    assert!(
        stderr(&output).starts_with("error: `.` contains files that `apex doc` did not write"),
        "{}",
        stderr(&output)
    );
    for taken in ["a.afg", "a.afg/pages"] {
        let output = doc(&folder, &["a.afg", "-o", taken]);
        assert_eq!((output.status.code(), files(&folder.0).len()), (Some(2), 1), "{taken}");
        assert!(stderr(&output).starts_with(&format!("error: cannot write pages to `{taken}`")), "{}", stderr(&output));
    }
}

#[test]
fn of_a_wrong_text_nothing_is_written() {
    let folder = Folder::new("doc-wrong");
    folder.file("right.afg", "use wrong::A;\n\ngraph B {\n    node a = A();\n}\n");
    folder.file("wrong.afg", "graph A {\n    node a = Nothing();\n}\n");
    let output = doc(&folder, &["right.afg", "wrong.afg", "-o", "pages"]);
    assert_eq!((output.status.code(), files(&folder.0).len()), (Some(1), 2));
    assert_eq!(stderr(&output).matches("error[unknown-node]").count(), 1, "{}", stderr(&output));
}

#[test]
fn what_cannot_be_read_is_two() {
    let folder = Folder::new("doc-unreadable");
    folder.file("latin1.afg", b"graph \xfc { }");
    fs::create_dir(folder.0.join("empty")).unwrap();
    for (path, reason) in [
        ("missing.afg", "error: cannot read `missing.afg`: there is no such file"),
        ("latin1.afg", "error: cannot read `latin1.afg`: byte 6 is not UTF-8"),
        ("empty", "error: there is no `.afg` file in `empty`"),
    ] {
        let output = doc(&folder, &[path, "-o", "pages"]);
        assert_eq!((output.status.code(), folder.0.join("pages").exists()), (Some(2), false), "{path}");
        assert!(stderr(&output).starts_with(reason), "{}", stderr(&output));
    }
    assert_eq!(doc(&folder, &[]).status.code(), Some(2));
}

#[test]
fn a_graph_that_is_too_large_for_a_picture_has_a_page() {
    let folder = project("doc-large");
    let nodes: String = (0..600).map(|i| format!("    node n{i} = ramp();\n")).collect();
    folder.file("large.afg", format!("use crate::ramp;\n\ngraph Large {{\n{nodes}}}\n"));
    assert_eq!(doc(&folder, &["large.afg", "-o", "pages"]).status.code(), Some(0));
    let page = &pages(&folder.0.join("pages"))["large.Large.html"];
    assert!(page.contains("A diagram would have 601 boxes") && !page.contains("<svg"), "{page}");
}
