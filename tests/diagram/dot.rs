//! Graphviz accepts the output.

use crate::random;
use apex_diagram::{dot, states};
use std::{
    io::Write as _,
    process::{Command, Stdio},
};

#[test]
fn graphviz_takes_it() {
    if Command::new("dot").arg("-V").output().is_err() {
        println!("skipped: there is no `dot` here");
        return;
    }
    let pictures = random(16).into_iter().flat_map(|(_, item)| [states(&item), Some(item)]).flatten();
    let text: String = pictures.map(|item| dot(&item)).collect();
    let mut child = Command::new("dot")
        .arg("-Tcanon")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it was there before");
    let mut input = child.stdin.take().expect("it is a pipe");
    let writer = std::thread::spawn(move || input.write_all(text.as_bytes()));
    let output = child.wait_with_output().expect("it ends");
    writer.join().expect("the writer does not panic").expect("all is read");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
