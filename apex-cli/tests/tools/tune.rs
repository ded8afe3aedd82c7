//! `apex tune`, with the cart of `robots/cart`.

use crate::{
    TARGET, builds,
    common::{Folder, apex, package, stderr},
    studio::{Page, Studio},
};
use serde_json::json;
use std::{fs, path::Path, process::Command};

/// In place of that of the library, which takes long to build.
const RANDOM: &str = "
struct Random(u64);
impl Random {
    fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn normal(&mut self, sigma: f32) -> f32 {
        sigma * (self.unit() + self.unit() + self.unit() + self.unit() - 2.0) as f32
    }
}
";

pub fn cart(name: &str) -> Folder {
    let folder = Folder::new(name);
    let nodes = include_str!("../../../robots/cart/src/lib.rs").replace("use apex_nodes::math::Random;\n", "");
    package(&folder, &(nodes.replace("#[derive(Debug)]\n", "") + RANDOM));
    folder.file("cart.afg", include_str!("../../../robots/cart/cart.afg"));
    folder
}

/// Command for a study with few candidates, whose results are in `output`.
fn tune(folder: &Folder, study: &str, output: &str, more: &[&str]) -> Command {
    let mut command = apex();
    command.arg("tune").arg(folder.0.join("cart.afg")).args([study, "--debug", "--candidates", "24", "--output"]);
    command.arg(folder.0.join(output)).args(more).env("CARGO_TARGET_DIR", TARGET);
    command
}

fn read(folder: &Folder, path: impl AsRef<Path>) -> String {
    fs::read_to_string(folder.0.join(path)).unwrap()
}

/// Checksum of a line, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg());
    !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

/// The lines of a journal, which are in the order in which the runs have ended.
fn sorted(journal: &str) -> Vec<&str> {
    let mut lines: Vec<&str> = journal.lines().collect();
    lines.sort_unstable();
    lines
}

/// Checks that a command succeeds, and returns its standard output.
fn done(mut command: Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output), "");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_study_is_the_same_on_any_number_of_cores_and_machines() {
    let _guard = builds();
    let folder = cart("tune");
    let params = folder.0.join("tuned.toml");
    let shown = done(tune(&folder, "Swift", "two", &["--jobs", "2", "--params", params.to_str().unwrap()]));
    for part in ["| minimise `error` [m] at 90 % |", "1 × 24 candidates, seed 1", " % of the time of 2 threads."] {
        assert!(shown.contains(part), "{shown}");
    }
    let tuned = read(&folder, "tuned.toml");
    assert!(tuned.starts_with("[pilot]\nstiffness = ") && tuned.contains("\nsmoothing = "), "{tuned}");
    done(tune(&folder, "Swift", "one", &["--jobs", "1"]));
    assert_eq!(read(&folder, "one/report.md"), read(&folder, "two/report.md"));
    let (one, two) = (read(&folder, "one/journal.csv"), read(&folder, "two/journal.csv"));
    assert_eq!(sorted(&one), sorted(&two));
    // The page of the studio has the same result, from the journal alone.
    let studio = Studio::open(&[folder.0.join("two").to_str().unwrap()]);
    let mut page = Page::open_at(&studio.address, "follow");
    let state = page.until("state", |state| state["finished"] == true);
    assert!(shown.contains(page.until("result", |_| true)["cost"].as_str().unwrap()));
    page.ask(&json!({ "candidate": { "search": state["best"][0], "number": state["best"][1] } }));
    assert_eq!(page.until("candidate", |_| true)["params"], tuned);
    drop(studio);
    // Cut off in the middle of a line.
    fs::write(folder.0.join("two/journal.csv"), &two[..two.len() / 2]).unwrap();
    done(tune(&folder, "Swift", "two", &["--resume"]));
    assert_eq!(sorted(&one), sorted(&read(&folder, "two/journal.csv")));
    // A changed digit, a missing value, and zeros after a power failure: these lines are run again.
    let mut lines: Vec<Vec<u8>> = one.lines().map(|line| [line.as_bytes(), b"\n"].concat()).collect();
    lines[3].iter_mut().rev().skip(9).find(|byte| byte.is_ascii_digit()).map(|byte| *byte ^= 1).unwrap();
    let cut = lines[5].iter().rposition(|byte| *byte == b',').unwrap();
    let end = lines[5].len() - 1;
    lines[5].drain(cut..end);
    lines[7] = vec![0; 40];
    lines[8] = b"\xff\n".to_vec();
    fs::write(folder.0.join("two/journal.csv"), lines.concat()).unwrap();
    // Another program has locked the folder meanwhile.
    let lock = fs::File::create(folder.0.join("two/.lock")).unwrap();
    lock.lock().unwrap();
    let second = tune(&folder, "Swift", "two", &["--resume"]).output().unwrap();
    assert!(stderr(&second).contains("another `apex tune` works in `"), "{}", stderr(&second));
    drop(lock);
    let repaired = tune(&folder, "Swift", "two", &["--resume"]).output().unwrap();
    let said = stderr(&repaired);
    assert!(repaired.status.success(), "{said}");
    let damaged = [4, 6, 8].map(|line| format!("two/journal.csv:{line}"));
    assert!(damaged.iter().all(|place| said.contains(place)) && said.matches("journal.csv").count() == 3, "{said}");
    assert_eq!(sorted(&one), sorted(&read(&folder, "two/journal.csv")));
    assert_eq!(read(&folder, "one/report.md"), read(&folder, "two/report.md"));

    done(tune(&folder, "Gentle", "whole", &[]));
    let parts = [("part1", "1/2"), ("part2", "2/2")];
    let parts = parts.map(|(output, shard)| tune(&folder, "Gentle", output, &["--shard", shard]).spawn().unwrap());
    assert!(parts.into_iter().all(|mut part| part.wait().unwrap().success()));
    let part = |name: &str| folder.0.join(name).to_str().unwrap().to_owned();
    let both = [part("part1"), part("part2")];
    done(tune(&folder, "Gentle", "merged", &["--merge", &both[0], "--merge", &both[1]]));
    for file in ["report.md", "front.svg", "convergence.svg", "importance.svg"] {
        assert_eq!(read(&folder, format!("whole/{file}")), read(&folder, format!("merged/{file}")));
    }
    // A part that is of another program: it has other values of the same run.
    let text = read(&folder, "part2/journal.csv");
    fs::create_dir(folder.0.join("other")).unwrap();
    let head = text.lines().next().unwrap();
    let of_defaults = "0,0,0,1.0,2.0";
    let checked = |line: &str| format!("{head}\n{line},{:08x}\n", crc32(line.as_bytes()));
    folder.file("other/journal.csv", checked(of_defaults));
    let wrong = tune(&folder, "Gentle", "wrong", &["--merge", &both[0], "--merge", &part("other")]).output().unwrap();
    let said = stderr(&wrong);
    assert_eq!(wrong.status.code(), Some(2), "{said}");
    assert!(said.contains("the run `0,0,0` has the values [") && said.contains("[1.0, 2.0] in "), "{said}");
    let incomplete = tune(&folder, "Gentle", "half", &["--merge", &both[0]]).output().unwrap();
    assert_eq!(incomplete.status.code(), Some(2));
    assert!(stderr(&incomplete).contains("the journals are not complete"), "{}", stderr(&incomplete));

    done(tune(&folder, "Swift", "written", &["--write"]));
    let text = read(&folder, "cart.afg");
    assert!(text.contains("node pilot = Pilot(stiffness = ") && text.contains(" / 1s^2, damping = "), "{text}");
    let values: Vec<&str> = tuned.lines().filter_map(|line| line.split_once(" = ")).map(|(_, value)| value).collect();
    assert!(values.len() == 3 && values.iter().all(|value| text.contains(value)), "{text}: {values:?}");
    let changed = tune(&folder, "Swift", "written", &["--resume"]).output().unwrap();
    let said = stderr(&changed);
    for part in
        ["a study with other settings: the default of the parameter `pilot.stiffness` was 1, and is ", "; the text"]
    {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn wrong_use_is_explained() {
    let _guard = builds();
    let folder = cart("tune-wrong");
    fs::create_dir(folder.0.join("old")).unwrap();
    folder.file("old/journal.csv", "of another study\n");
    let text = read(&folder, "cart.afg");
    folder.file("cart.afg", text.replace("position > 1.1", "position > -5.0"));
    for (study, output, more, code, message) in [
        ("Swifd", "new", &[][..], 2, "did you mean `Swift`?"),
        ("Swift", "new", &["--resume"], 2, "there is nothing to resume"),
        ("Swift", "old", &[], 2, "continue it with `--resume`"),
        ("Swift", "old", &["--resume"], 2, "belongs to a study with other settings"),
        ("Swift", "new", &["--shard", "1/2"], 2, "a study of 1 searches has no 2 parts"),
        ("Swift", "new", &["--merge", "nowhere"], 2, "`nowhere` has no journal to be merged"),
        ("Swift", "new", &["--params", "nowhere/tuned.toml"], 2, "there is no folder `nowhere`"),
        ("Swift", "failed", &[], 1, "all candidates of `Swift` failed: test `Swift` failed at 0.000000 s"),
    ] {
        let found = tune(&folder, study, output, more).output().unwrap();
        assert_eq!(found.status.code(), Some(code), "{study} {more:?}: {}", stderr(&found));
        assert!(stderr(&found).contains(message), "{study} {more:?}: {}", stderr(&found));
    }
    folder.file("cart.afg", "graph A { }\n");
    let none = tune(&folder, "Swift", "new", &[]).output().unwrap();
    assert!(stderr(&none).contains("has no `tune` item"), "{}", stderr(&none));
    folder.file("cart.afg", text.replace("vary pilot.damping", "vary pilot.dumping"));
    let wrong = tune(&folder, "Swift", "new", &[]).output().unwrap();
    assert_eq!(wrong.status.code(), Some(1));
    assert!(stderr(&wrong).contains("did you mean `pilot.damping`?"), "{}", stderr(&wrong));
}

const GAIN: &str = "
use apex_rt::prelude::*;
/// Factor.
#[node]
pub struct Gain {
    #[param(default = 0.5, range = 0.0..=1.0)]
    gain: f64,
}
#[node]
impl Gain {
    fn process(&mut self, value: &f64) -> f64 {
        self.gain * value.abs()
    }
}
";

const SCALED: &str = "use crate::Gain;\n
graph Scaled { in value: f64; out scaled: f64; node g = Gain(); value -> g -> scaled; }\n
tune Small: Scaled {
    vary g.gain;
    wait 10ms;
    feed value = recording(\"run.mcap\", \"a.out\");
    minimise scaled;
    holdout \"other.mcap\";
}
";

#[test]
fn each_run_of_a_study_is_fed_the_recording() {
    let _guard = builds();
    let folder = Folder::new("tune-recording");
    package(&folder, GAIN);
    let file = folder.file("gain.afg", SCALED);
    for name in ["run.mcap", "other.mcap"] {
        fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/record/small.mcap"), folder.0.join(name))
            .unwrap();
    }
    let mut command = apex();
    command.arg("tune").arg(file).args(["Small", "--debug", "--candidates", "12", "--output"]);
    command.arg(folder.0.join("study")).env("CARGO_TARGET_DIR", TARGET);
    done(command);
    let journal = read(&folder, "study/journal.csv");
    assert!(journal.lines().count() > 12 && !journal.contains("failed"), "{journal}");
}
