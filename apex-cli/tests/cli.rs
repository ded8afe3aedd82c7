//! The built command: its output and its exit codes.

mod common;

use common::{Folder, answer, apex, package, stderr};
use serde_json::json;
use std::{
    collections::BTreeSet,
    fs,
    io::Write as _,
    path::Path,
    process::{Output, Stdio},
};

fn check(arguments: &[&str], file: &Path) -> Output {
    apex().arg("check").args(arguments).arg(file).output().unwrap()
}

#[test]
fn a_right_text_says_nothing() {
    let folder = Folder::new("right");
    let output = check(&[], &folder.file("right.afg", "graph A { }\n"));
    assert_eq!((output.status.code(), output.stdout.len(), stderr(&output)), (Some(0), 0, String::new()));
    let output = check(&["--format", "json"], &folder.file("right.afg", "graph A { }\n"));
    assert_eq!((output.status.code(), &answer(&output, "check")["messages"]), (Some(0), &json!([])));
}

#[test]
fn errors_as_text_and_as_json() {
    let folder = Folder::new("wrong");
    let file = folder.file("wrong.afg", "graph A {\n    /* ü */ node a = Nothing();\n    node a = Nothing();\n}\n");
    let output = check(&[], &file);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    let text = stderr(&output);
    assert!(
        text.starts_with("error[unknown-node]: there is no node or graph `Nothing`, here and in another place\n"),
        "{text}"
    );
    assert!(text.lines().nth(1).unwrap().ends_with("wrong.afg:2:22"), "{text}");

    let output = check(&["--format", "json"], &file);
    assert_eq!((output.status.code(), output.stderr.len()), (Some(1), 0));
    let messages = answer(&output, "check")["messages"].take();
    let first = &messages[0];
    assert_eq!(first["file"], file.display().to_string());
    assert_eq!((first["line"].as_u64(), first["column"].as_u64()), (Some(2), Some(22)));
    assert_eq!((first["end_line"].as_u64(), first["end_column"].as_u64()), (Some(2), Some(29)));
    assert_eq!((first["severity"].as_str(), first["code"].as_str()), (Some("error"), Some("unknown-node")));
    assert_eq!(first["message"], "there is no node or graph `Nothing`, here and in another place");
    assert_eq!(messages[1]["labels"][0]["message"], "first defined here");
    assert_eq!(messages.as_array().unwrap().len(), 2);
}

#[test]
fn several_files_are_all_checked() {
    let folder = Folder::new("several");
    let (wrong, right) = (folder.file("wrong.afg", "graph A {\n"), folder.file("right.afg", "graph A { }\n"));
    let output = apex().args(["check", "--format", "json"]).args([&wrong, &right, &wrong]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let messages = answer(&output, "check")["messages"].take();
    assert_eq!(messages.as_array().unwrap().len(), 2);
    let output = check(&["--format", "json"], &folder.0);
    let messages = answer(&output, "check")["messages"].take();
    assert_eq!((output.status.code(), messages.as_array().unwrap().len()), (Some(1), 1));
}

#[test]
fn what_cannot_be_read_is_two() {
    let folder = Folder::new("unreadable");
    fs::create_dir(folder.0.join("empty")).unwrap();
    for (path, reason) in [
        (folder.0.join("missing.afg"), "there is no such file"),
        (folder.0.join("empty"), "there is no `.afg` file in"),
        (folder.file("latin1.afg", b"graph \xfc { }"), "byte 6 is not UTF-8"),
        (folder.file("large.afg", " ".repeat(5 << 20)), "bytes; at most"),
    ] {
        for format in ["text", "json"] {
            let output = check(&["--format", format], &path);
            assert_eq!((output.status.code(), output.stdout.is_empty()), (Some(2), format == "text"));
            let text = stderr(&output);
            assert!(text.starts_with("error: ") && text.contains(reason), "{text}");
        }
    }
}

#[test]
fn wrong_use_is_two() {
    for arguments in [&["check"][..], &["chekc"], &["check", "--format", "xml", "a.afg"], &[]] {
        let output = apex().args(arguments).output().unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}");
    }
    assert_eq!(apex().arg("--help").output().unwrap().status.code(), Some(0));
}

/// Runs a command in a folder with a text as its standard input.
fn with_input(folder: &Path, arguments: &[&str], input: &[u8]) -> Output {
    let mut command = apex();
    command.args(arguments).current_dir(folder);
    let command = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // A command that does not read its input is found by its output.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

/// Text that needs nodes of the library and of the simulator.
const LONE: &str = "\
use apex_nodes::flow::Throttle;
use apex_nodes::slam::GraphSlam;
use apex_sim::LaserScanner;

graph Alone {
    in  raw: u8;
    out value: u8;

    raw -> Throttle(n = 5) -> value;
}
";

/// Neither cargo nor a package is needed to check a text, whether it comes from a file or from standard input.
#[test]
fn a_text_without_a_package_knows_the_library() {
    let folder = Folder::new("lone");
    let file = folder.file("alone.afg", LONE);
    let lone = |arguments: &[&str], input: &str| {
        let output = with_input(&folder.0, arguments, input.as_bytes());
        (output.status.code(), String::from_utf8(output.stdout.clone()).unwrap(), stderr(&output))
    };
    let unused = LONE.replace("use apex_nodes::slam::GraphSlam;\nuse apex_sim::LaserScanner;\n", "");
    folder.file("used.afg", &unused);
    assert_eq!(lone(&["check", "used.afg"], ""), (Some(0), String::new(), String::new()));
    assert_eq!(lone(&["check", "-"], &unused), (Some(0), String::new(), String::new()));
    let (code, _, warnings) = lone(&["check", "-"], LONE);
    assert!(code == Some(0) && warnings.contains("<stdin>:2:") && warnings.contains("not-used"), "{warnings}");
    let (code, _, errors) = lone(&["check", "-"], &unused.replace("Throttle", "Throtle"));
    assert!(code == Some(1) && errors.contains("did you mean `Throttle`?"), "{errors}");
    for (arguments, part) in [
        (&["graph", "-"][..], "<svg"),
        (&["explain", "-"], "Alone"),
        (&["explain", "--program", "-"], "Alone"),
        (&["expand", "-"], "pub struct Alone"),
    ] {
        let (code, text, errors) = lone(arguments, &unused);
        assert!(code == Some(0) && text.contains(part), "{arguments:?} {errors}{text}");
    }
    for (arguments, reason) in
        [(&["check", "--fix", "-"][..], "cannot be changed"), (&["test", "-"], "cannot read `-`")]
    {
        let (code, text, errors) = lone(arguments, &unused);
        assert!(code == Some(2) && text.is_empty() && errors.contains(reason), "{arguments:?} {errors}");
    }
    // A text that names what its folder has.
    let (code, _, errors) = lone(
        &["check", "-"],
        &unused
            .replace("apex_nodes::flow::Throttle", "used::Alone")
            .replace("Throttle(n = 5)", "Alone()")
            .replace("graph Alone", "graph Other"),
    );
    assert_eq!(code, Some(0), "{errors}");
    drop(file);
}

/// A source file sees the nodes of its package; the cache contains the same signatures as the first reading.
#[test]
fn nodes_of_the_package() {
    let folder = Folder::new("package");
    package(
        &folder,
        "use apex_rt::prelude::*;\n#[node]\npub fn ramp(#[param(default = [0.0, 1.0])] range: [f32; 2]) -> u64 { 1 }\n#[node]\npub fn show(x: &u64) {}\n",
    );
    let file = folder.file("robot.afg", "graph Robot {\n    ramp() -> show();\n}\n");
    for _ in 0..2 {
        let output = check(&[], &file);
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    }
    let expanded = |arguments: &[&str]| {
        let output = apex().arg("expand").args(arguments).arg(&file).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let (plain, recordable) = (expanded(&[]), expanded(&["--record"]));
    assert!(plain.contains("pub struct Robot") && !plain.contains("Tapped"), "{plain}");
    assert!(recordable.contains("pub struct Robot") && recordable != plain, "{recordable}");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let folder = Folder::new("pipe");
    let mut text = "graph A {\n".to_owned();
    (0..90).for_each(|i| text.push_str(&format!("    node a{i} = Nothing{i}();\n")));
    let file = folder.file("wrong.afg", text + "}\n");
    for format in ["json", "text"] {
        let mut command = apex();
        command.args(["check", "--format", format]).arg(&file).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(1), "{format}");
    }
}

#[test]
fn the_language_server_ends_with_its_editor() {
    let help = apex().args(["lsp", "--help"]).output().unwrap();
    assert_eq!((help.status.code(), help.stderr.len()), (Some(0), 0));
    let serve = |input: &str| {
        let mut server =
            apex().arg("lsp").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        // A server that has already ended does not read all of it.
        let _ = server.stdin.take().unwrap().write_all(input.as_bytes());
        server.wait_with_output().unwrap()
    };
    let message = |text: &str| format!("Content-Length: {}\r\n\r\n{text}", text.len());
    let hello = message(r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#);
    let bye = message(r#"{"jsonrpc":"2.0","id":2,"method":"shutdown"}"#);
    let exit = message(r#"{"jsonrpc":"2.0","method":"exit"}"#);

    // No editor at all, and an editor that disconnects without a shutdown.
    for input in ["", hello.as_str()] {
        let output = serve(input);
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    }
    let output = serve(&format!("{hello}{bye}{exit}"));
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains(r#""positionEncoding":"utf-16""#) && text.contains(r#""id":2"#), "{text}");
    assert_eq!(serve(&format!("{hello}{exit}")).status.code(), Some(1));

    // An invalid message is answered and does not end the server.
    let output = serve("Content-Length: 5\r\n\r\n{nope");
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    assert!(String::from_utf8(output.stdout).unwrap().contains("a message that is not JSON"));
}

#[test]
fn a_code_is_explained() {
    let explain = |argument: &str| apex().args(["explain", argument]).output().unwrap();
    let output = explain("missing-unit");
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/errors/missing-unit.md");
    assert_eq!(String::from_utf8(output.stdout).unwrap(), fs::read_to_string(page).unwrap());

    let output = explain("--list");
    let list = String::from_utf8(output.stdout).unwrap();
    assert_eq!((output.status.code(), list.lines().count() > 50), (Some(0), true), "{list}");
    assert!(list.lines().all(|line| line.split_whitespace().count() > 2), "{list}");

    let output = explain("mising-unit");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(stderr(&output).ends_with("did you mean `missing-unit`?\n"), "{}", stderr(&output));

    // An existing file has precedence, and a name with an extension is always a file.
    let folder = Folder::new("explain");
    folder.file("missing-unit", "graph A { }\n");
    let output = apex().args(["explain", "missing-unit"]).current_dir(&folder.0).output().unwrap();
    assert!(output.stdout.starts_with(b"graph A\n"), "{output:?}");
    let output = explain("missing-unit.afg");
    assert!(stderr(&output).contains("there is no such file"), "{}", stderr(&output));
}

#[test]
fn errors_say_once_where_to_read_on() {
    let folder = Folder::new("read-on");
    let file = folder.file("wrong.afg", "graph A {\n    node a = Nothing();\n    node a = Nothing();\n}\n");
    let output = apex().arg("check").args([&file, &file]).output().unwrap();
    let text = stderr(&output);
    assert_eq!(text.matches("for more about an error").count(), 1, "{text}");
    assert!(text.ends_with("\nfor more about an error, try `apex explain unknown-node`\n"), "{text}");
    let warning = folder.file("warning.afg", "fsm A {\n    slot go;\n    state a { }\n    state b { }\n}\n");
    let text = stderr(&check(&[], &warning));
    assert!(text.starts_with("warning[never-entered]") && !text.contains("for more"), "{text}");
}

#[test]
fn what_is_certain_is_mended() {
    let folder = Folder::new("mend");
    let file = folder.file("a.afg", "graph A {\n    in x u64;\n    out y = u64\n    x --> y;\n}\n");
    let output = check(&["--fix"], &file);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(0), 0), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(&file).unwrap(), "graph A {\n    in x: u64;\n    out y: u64;\n    x -> y;\n}\n");
    let name = file.display();
    let told = stderr(&output);
    assert!(told.lines().all(|line| line.starts_with(&format!("fixed {name}:"))), "{told}");
    assert_eq!(told.lines().count(), 4, "{told}");
    assert_eq!(stderr(&check(&["--fix"], &file)), "");

    // A suggestion is shown, but not applied; the file is not changed.
    let text = "graph A {\n    in x: u64;\n    out y: u64;\n    x -> z;\n}\n";
    let file = folder.file("b.afg", text);
    let output = check(&["--fix"], &file);
    assert_eq!((output.status.code(), fs::read_to_string(&file).unwrap().as_str()), (Some(1), text));
    assert!(stderr(&output).starts_with("error["), "{}", stderr(&output));

    // A fix that makes things worse is undone: the bracket is closed, after which there is one more error than before.
    let text = "graph A {\n    in x: u64;\n    x -> B(;\n}\ngraph C { in x: u64; x -> D(); }\n";
    let file = folder.file("c.afg", text);
    let before = stderr(&check(&[], &file)).matches("error[").count();
    let after = stderr(&check(&["--fix"], &file)).matches("error[").count();
    assert!(after <= before, "{after} > {before}");
}

/// `apex fmt` with these arguments.
fn fmt(arguments: &[&Path]) -> Output {
    apex().arg("fmt").args(arguments).output().unwrap()
}

/// `apex fmt` with standard input.
fn fmt_input(arguments: &[&str], input: &[u8]) -> Output {
    let mut command = apex();
    command.arg("fmt").args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    child.stdin.take().unwrap().write_all(input).unwrap();
    child.wait_with_output().unwrap()
}

const UGLY: &str = "graph A {\n  in x: u64; // why\n}\n";
const NICE: &str = "graph A {\n    in x: u64; // why\n}\n";

#[test]
fn files_and_folders_are_formatted() {
    let folder = Folder::new("fmt");
    fs::create_dir_all(folder.0.join("deep/.hidden")).unwrap();
    fs::create_dir_all(folder.0.join("target")).unwrap();
    let files = [folder.file("a.afg", UGLY), folder.file("deep/b.afg", UGLY), folder.file("c.afg", NICE)];
    let others =
        [folder.file("deep/.hidden/d.afg", UGLY), folder.file("e.txt", UGLY), folder.file("target/f.afg", UGLY)];
    folder.file("target/CACHEDIR.TAG", "");
    let untouched = fs::metadata(&files[2]).unwrap().modified().unwrap();
    let output = fmt(&[&folder.0, &files[0]]);
    assert_eq!((output.status.code(), output.stdout.len(), stderr(&output)), (Some(0), 0, String::new()));
    assert!(files.iter().all(|file| fs::read_to_string(file).unwrap() == NICE));
    assert!(others.iter().all(|file| fs::read_to_string(file).unwrap() == UGLY));
    assert_eq!(fs::metadata(&files[2]).unwrap().modified().unwrap(), untouched);
    let names = fs::read_dir(&folder.0).unwrap().count();
    assert_eq!(names, 5, "nothing is left over");
}

#[test]
fn what_would_be_changed_is_shown() {
    let folder = Folder::new("fmt-check");
    let (ugly, nice) = (folder.file("ugly.afg", UGLY), folder.file("nice.afg", NICE));
    let open = folder.file("open.afg", NICE.trim_end());
    let output = fmt(&[Path::new("--check"), &ugly, &nice, &open]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(1), String::new()));
    let (ugly_name, open_name) = (ugly.display(), open.display());
    assert_eq!(
        String::from_utf8(output.stdout).unwrap(),
        format!(
            "{ugly_name}:2: would be changed\n-   in x: u64; // why\n+     in x: u64; // why\n\
             {open_name}:3: would be changed\n- }} (without a line end)\n+ }}\n"
        )
    );
    assert_eq!(fs::read_to_string(&ugly).unwrap(), UGLY);
    assert_eq!(fmt(&[Path::new("--check"), &nice]).status.code(), Some(0));
}

#[test]
fn standard_input_is_formatted_to_standard_output() {
    let output = fmt_input(&["-"], UGLY.as_bytes());
    assert_eq!((output.status.code(), output.stdout.as_slice()), (Some(0), NICE.as_bytes()));
    let output = fmt_input(&["--check", "-"], UGLY.as_bytes());
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stdout).unwrap().starts_with("<stdin>:2: would be changed\n"));
    let output = fmt_input(&["-"], b"graph \xfc { }");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert_eq!(stderr(&output), "error: cannot read standard input: byte 6 is not UTF-8\n");
}

#[test]
fn texts_with_errors_are_left_alone() {
    let folder = Folder::new("fmt-wrong");
    let text = "graph A {\n  in x u64;\n}\n";
    let (wrong, ugly) = (folder.file("wrong.afg", text), folder.file("ugly.afg", UGLY));
    let (output, checked) = (fmt(&[&wrong, &ugly]), check(&[], &wrong));
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    assert_eq!(stderr(&output), stderr(&checked));
    assert_eq!(fs::read_to_string(&wrong).unwrap(), text);
    assert_eq!(fs::read_to_string(&ugly).unwrap(), NICE);
    let output = fmt_input(&["-"], text.as_bytes());
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
}

#[test]
fn what_cannot_be_formatted_is_two_and_the_rest_is_done() {
    let folder = Folder::new("fmt-unreadable");
    fs::create_dir_all(folder.0.join("empty")).unwrap();
    let read_only = folder.file("read_only.afg", UGLY);
    let mut permissions = fs::metadata(&read_only).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&read_only, permissions).unwrap();
    for (path, reason) in [
        (folder.0.join("missing.afg"), "there is no such file"),
        (folder.0.join("empty"), "there is no `.afg` file in"),
        (folder.file("latin1.afg", b"graph \xfc { }"), "byte 6 is not UTF-8"),
        (folder.file("large.afg", " ".repeat(5 << 20)), "bytes; at most"),
        (read_only, "it is read-only"),
    ] {
        let ugly = folder.file("ugly.afg", UGLY);
        let output = fmt(&[&path, &ugly]);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{}", path.display());
        let text = stderr(&output);
        assert!(text.starts_with("error: ") && text.contains(reason), "{text}");
        assert_eq!(fs::read_to_string(&ugly).unwrap(), NICE);
    }
}

/// The file keeps its permissions, and the target of a link is formatted in place.
#[cfg(unix)]
#[test]
fn formatting_keeps_permissions_and_links() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = Folder::new("fmt-links");
    let (file, link) = (folder.file("file.afg", UGLY), folder.0.join("link.afg"));
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("file.afg", &link).unwrap();
    assert_eq!(fmt(&[&link]).status.code(), Some(0));
    assert_eq!(fs::read_to_string(&file).unwrap(), NICE);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
}

/// The README lists every command, and no other one.
#[test]
fn the_readme_lists_all_commands() {
    let help = apex().arg("--help").output().unwrap();
    let help = String::from_utf8(help.stdout).unwrap();
    let (_, commands) = help.split_once("Commands:\n").expect("there are commands");
    let (commands, _) = commands.split_once("\n\n").expect("they end");
    let commands = commands.lines().filter_map(|line| line.strip_prefix("  ")).filter(|line| !line.starts_with(' '));
    let commands: BTreeSet<&str> =
        commands.filter_map(|line| line.split(' ').next()).filter(|c| *c != "help").collect();
    let readme = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md")).unwrap();
    let rows = readme.lines().filter_map(|line| line.strip_prefix("| `apex "));
    let listed: BTreeSet<&str> = rows.filter_map(|row| row.split([' ', '`']).next()).collect();
    assert_eq!(listed, commands);
}

const BELL: &str = "fsm Bell {\n    slot  push;\n    event ring;\n    state quiet { on push => loud -> ring; }\n    state loud { on push => quiet; }\n}\ngraph House {\n    slot push;\n    node bell = Bell();\n    push -> bell.push;\n}\n";

fn graph(arguments: &[&str], file: &Path) -> Output {
    apex().arg("graph").args(arguments).arg(file).output().unwrap()
}

#[test]
fn graphs_are_drawn() {
    let folder = Folder::new("graph");
    let file = folder.file("bell.afg", BELL);
    let printed = graph(&[], &file);
    assert_eq!((printed.status.code(), stderr(&printed)), (Some(0), String::new()));
    let svg = String::from_utf8(printed.stdout).unwrap();
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("loud"), "{svg}");
    let picture = folder.0.join("bell.svg");
    let written = graph(&["-o", picture.to_str().unwrap(), "--graph", "House"], &file);
    assert_eq!((written.status.code(), written.stdout.len()), (Some(0), 0));
    assert_eq!(fs::read_to_string(&picture).unwrap(), svg);
    let states = graph(&["--activity", "--format", "dot"], &file);
    let dot = String::from_utf8(states.stdout).unwrap();
    assert!(dot.starts_with("digraph {") && dot.contains("loud"), "{dot}");
    let named = folder.0.join("bell.dot");
    assert_eq!(graph(&["-o", named.to_str().unwrap()], &file).status.code(), Some(0));
    assert!(fs::read_to_string(&named).unwrap().starts_with("digraph {"));
    // Also graphs that are not programs: used in others, or with a parameter without a value.
    let file = folder.file(
        "parts.afg",
        "graph Open(n: u8) { // allow(not-used): it has no value\n    in  x: u8;\n    out y: u8;\n    x -> y;\n}\ngraph All {\n    slot push;\n    node house = House();\n    push -> house.push;\n}\n".to_owned() + BELL,
    );
    for name in ["Open", "House", "All"] {
        let drawn = graph(&["--graph", name], &file);
        assert_eq!((drawn.status.code(), stderr(&drawn)), (Some(0), String::new()));
        assert!(String::from_utf8(drawn.stdout).unwrap().contains(&format!("<title>{name}")), "{name}");
    }
}

#[test]
fn state_machines_are_drawn() {
    let folder = Folder::new("charts");
    let alone = folder.file("fsm.afg", &BELL[..BELL.find("graph").unwrap()]);
    let beside = folder.file("bell.afg", BELL);
    let pictures = [graph(&["--format", "dot"], &alone), graph(&["--format", "dot", "--graph", "Bell"], &beside)];
    for picture in &pictures {
        assert_eq!((picture.status.code(), stderr(picture)), (Some(0), String::new()));
        let dot = String::from_utf8_lossy(&picture.stdout);
        for part in ["Bell", "quiet", "loud", "push / ring"] {
            assert!(dot.contains(part), "{part}: {dot}");
        }
    }
    assert_eq!(pictures[0].stdout, pictures[1].stdout);
}

#[test]
fn what_another_file_lacks_is_highlighted() {
    let folder = Folder::new("new-to");
    let old = folder.file("old.afg", BELL);
    let file =
        folder.file("bell.afg", BELL.replace("state loud { on push => quiet; }", "state loud { on push => loud; }"));
    let news = |file: &Path, more: &[&str]| {
        let output = graph(&[&["--new-to", old.to_str().unwrap()], more].concat(), file);
        (output.status.code(), stderr(&output), String::from_utf8(output.stdout).unwrap())
    };
    let said = |count: &str| format!("note: {count} nodes are of types that `{}` does not use\n", old.display());
    let (code, errors, svg) = news(&file, &[]);
    assert_eq!((code, errors), (Some(0), said("1 of 1")));
    assert!(svg.contains("class=\"item active new\"") || svg.contains("class=\"item new\""), "{svg}");
    let (_, _, dot) = news(&file, &["--format", "dot"]);
    assert!(dot.contains("penwidth=3"), "{dot}");
    let (_, errors, svg) = news(&old, &[]);
    assert!(errors == said("0 of 1") && !svg.contains(".new"), "{errors}{svg}");
    // What cannot be compared.
    let (code, errors, _) = news(&file, &["--graph", "Bell"]);
    assert!(code == Some(2) && errors.contains("`Bell` is a state machine, which has no nodes"), "{errors}");
    fs::write(&old, "graph A {\n    node a = Nothing();\n}\n").unwrap();
    let (code, errors, svg) = news(&file, &[]);
    assert!(code == Some(1) && errors.contains("unknown-node") && svg.is_empty(), "{errors}");
    fs::remove_file(&old).unwrap();
    let (code, errors, _) = news(&file, &[]);
    assert!(code == Some(2) && errors.contains("cannot read"), "{errors}");
}

#[test]
fn large_graphs_are_folded_unless_all_is_wanted() {
    let folder = Folder::new("folded");
    let rooms: String =
        (0..30).map(|i| format!("    node house{i} = House();\n    push -> house{i}.push;\n")).collect();
    let file = folder.file("town.afg", format!("graph Town {{\n    slot push;\n{rooms}}}\n{BELL}"));
    let (folded, all) = (graph(&[], &file), graph(&["--depth", "all"], &file));
    assert_eq!((folded.status.code(), all.status.code()), (Some(0), Some(0)));
    assert!(stderr(&folded).contains("note: `Town` is too large to be readable as a whole"), "{}", stderr(&folded));
    assert!(stderr(&folded).contains("`--depth all` opens all"), "{}", stderr(&folded));
    assert_eq!(stderr(&all), "");
    let bells = |picture: &Output| String::from_utf8_lossy(&picture.stdout).matches("<title>bell").count();
    assert_eq!((bells(&folded), bells(&all)), (0, 30));
}

#[test]
fn graphs_that_cannot_be_drawn() {
    let folder = Folder::new("undrawn");
    let file = folder.file("bell.afg", BELL);
    let fails = |arguments: &[&str], file: &Path, words: &str| {
        let output = graph(arguments, file);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}");
        assert!(stderr(&output).contains(words), "{arguments:?}: {}", stderr(&output));
    };
    fails(&[], &folder.0.join("none.afg"), "cannot read");
    fails(&["-o", "bell.png"], &file, "ends neither in .svg nor in .dot: choose the format with `--format`");
    fails(&["-o", "bell"], &file, "ends neither in .svg nor in .dot");
    fails(&["-o", folder.0.join("no/such/folder.svg").to_str().unwrap()], &file, "there is no folder `");
    fails(&["--graph", "Hose"], &file, "there is no graph `Hose` to draw; did you mean `House`?");
    fails(&["--graph", "Bath"], &file, "there is no graph `Bath` to draw; there are graph `House`, fsm `Bell`");
    let robot = |name: &str| format!("robot {name} {{\n    node bell = Bell();\n    start -> bell.push;\n}}\n");
    let two = [&BELL[..BELL.find("graph").unwrap()], &robot("House"), &robot("Home")].concat();
    let named = "has several graphs: choose one with `--graph NAME`; there are robot `House`, robot `Home`, fsm `Bell`";
    fails(&[], &folder.file("two.afg", &two), named);
    fails(&["--depth", "deep"], &file, "a whole number, or `all`");
    fails(&["-o", file.to_str().unwrap(), "--format", "svg"], &file, "would overwrite its source file");
    assert_eq!(fs::read_to_string(&file).unwrap(), BELL);
    let empty = graph(&[], &folder.file("empty.afg", "\n"));
    assert!(empty.status.code() == Some(1) && stderr(&empty).contains("no-graph"), "{}", stderr(&empty));
    fails(&["--activity"], &folder.file("still.afg", "graph Still { }\n"), "no activity reaches a node of `Still`");
    let wrong = folder.file("wrong.afg", "graph A {\n    node a = Nothing();\n}\n");
    let picture = folder.0.join("wrong.svg");
    let output = graph(&["-o", picture.to_str().unwrap()], &wrong);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("unknown-node") && !picture.exists(), "{}", stderr(&output));
}

/// Something that is not a file is not replaced by a file.
#[cfg(unix)]
#[test]
fn a_pipe_stays_a_pipe() {
    use std::os::unix::fs::FileTypeExt as _;
    let folder = Folder::new("fifo");
    let pipe = folder.0.join("pipe.afg");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let writer = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::write(pipe, UGLY).unwrap()
    });
    let output = apex().arg("fmt").arg(&pipe).output().unwrap();
    writer.join().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(stderr(&output).contains("it is a device or a pipe"), "{}", stderr(&output));
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
}

/// A file without an end, and one that cannot be written.
#[cfg(target_os = "linux")]
#[test]
fn devices() {
    let folder = Folder::new("devices");
    for command in ["check", "import"] {
        let output = apex().args([command, "/dev/zero"]).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).starts_with("error: cannot read `/dev/zero`: at most "), "{}", stderr(&output));
    }
    let file = folder.file("a.afg", BELL).display().to_string();
    for arguments in [&["explain", "--list"][..], &["expand", &file], &["graph", &file], &["test", &file]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = apex().args(arguments).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).starts_with("error: cannot write to standard output: "), "{}", stderr(&output));
    }
}

#[test]
fn nobody_reads_what_is_printed() {
    let folder = Folder::new("unread");
    let file = folder.file("a.afg", BELL).display().to_string();
    for arguments in [&["explain", "--list"][..], &["expand", &file], &["test", &file], &["completions", "zsh"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = apex().args(arguments).stdout(writer).output().unwrap();
        assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()), "{arguments:?}");
    }
}

#[test]
fn a_machine_without_cargo() {
    let folder = Folder::new("no_cargo");
    package(&folder, "");
    let file = folder.file("a.afg", BELL);
    for command in ["check", "run", "test", "doc"] {
        let output = apex().arg(command).arg(&file).env("CARGO", folder.0.join("cargo")).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{command}");
        assert!(stderr(&output).starts_with("error: there is no `cargo`: install Rust"), "{}", stderr(&output));
    }
}

/// Without the runtime or `graph!` a text can be checked, but not run.
#[test]
fn a_package_without_the_runtime_or_the_macro() {
    let runtime = Path::new(env!("CARGO_MANIFEST_DIR")).join("../apex-rt");
    cannot_run("no_runtime", "", "apex-rt");
    cannot_run("no_macro", &format!("[dependencies]\napex-rt = {{ path = {runtime:?} }}\n"), "apex-macros");
}

/// A package with these dependencies, which `apex run` and `apex test` refuse because `missing` is not one of them.
fn cannot_run(name: &str, dependencies: &str, missing: &str) {
    let folder = Folder::new(name);
    let manifest = format!("[package]\nname = \"plain\"\nedition = \"2024\"\n[workspace]\n{dependencies}");
    folder.file("Cargo.toml", manifest);
    fs::create_dir(folder.0.join("src")).unwrap();
    folder.file("src/lib.rs", "");
    let file = folder.file("a.afg", BELL.to_owned() + "test a: House { feed push; }\n");
    for (command, code) in [("check", 0), ("run", 2), ("test", 2)] {
        let output = apex().arg(command).arg(&file).output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{command}: {}", stderr(&output));
        let message = format!("does not depend on `{missing}`: add it");
        assert_eq!(stderr(&output).contains(&message), code == 2, "{}", stderr(&output));
    }
}

/// Nodes are missing because their Rust file has an error: the message names the error.
#[test]
fn nodes_in_broken_rust() {
    let folder = Folder::new("broken_rust");
    package(&folder, "#[node]\npub fn ramp() -> u64 { 1 }\nfn broken( {\n");
    let file = folder.file("a.afg", "use crate::ramp;\ngraph A {\n    out y: u64;\n    ramp() -> y;\n}\n");
    for _ in 0..2 {
        let said = stderr(&check(&[], &file));
        let reason = "note: the nodes in src/lib.rs are unknown: line 3 cannot be read (";
        assert_eq!(said.matches(reason).count(), 1, "{said}");
    }
}

/// Errors in the file arguments of a run are reported before the build.
#[test]
fn files_of_a_run() {
    let folder = Folder::new("files");
    package(&folder, "");
    let file = folder.file("a.afg", BELL);
    let missing = folder.0.join("no/such.toml");
    for (option, path, reason) in [
        ("--params", &missing, "such.toml`: there is no such file"),
        ("--save-params", &missing, "such.toml`: there is no folder `"),
        ("--save-params", &folder.0, "it is not a regular file"),
        ("--save-params", &file, "the parameters would overwrite the source file `"),
    ] {
        let output = apex().arg("run").arg(&file).arg(option).arg(path).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{option}");
        assert!(stderr(&output).contains(reason), "{}", stderr(&output));
    }
    assert_eq!(fs::read_to_string(&file).unwrap(), BELL);
}
