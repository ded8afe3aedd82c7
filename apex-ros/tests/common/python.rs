//! Programs in Python that talk as those of ROS 2 do.

use super::{free_address, speaker::Speaker, within};
use apex_ros::Ros;
use std::{
    env,
    ops::Deref,
    path::{Path, PathBuf},
    process::Command,
};

/// Python with the packages; `None` if there is none, which is an error in CI.
pub fn python() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let environment = root.join("target/python/bin/python3");
    let python = [environment, PathBuf::from("python3")].into_iter().find(|python| {
        let test = Command::new(python).args(["-c", "import rosbags, zenoh, zenoh_ros2_sdk"]).output();
        test.is_ok_and(|output| output.status.success())
    });
    if python.is_none() {
        assert!(env::var_os("CI").is_none(), "no Python has `rosbags`, `eclipse-zenoh` and `zenoh-ros2-sdk`");
        println!("skipped: no Python has `rosbags`, `eclipse-zenoh` and `zenoh-ros2-sdk`");
    }
    python
}

/// The same Python with another version of `eclipse-zenoh`, which lies in a folder of its own; `None` if it is not
/// there, which is an error in CI.
pub fn with_zenoh(python: &Path, version: &str) -> Option<Interpreter> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../target/zenoh-{version}"));
    let other = Interpreter { python: python.to_owned(), packages: Some(folder) };
    let asked = other.command().args(["-c", "import zenoh; print(zenoh.__file__)"]).output().expect("python runs");
    let is_there = String::from_utf8_lossy(&asked.stdout).contains(&format!("zenoh-{version}"));
    if !is_there {
        let how = format!("`pip install --no-deps --target target/zenoh-{version} eclipse-zenoh=={version}`");
        assert!(env::var_os("CI").is_none(), "`eclipse-zenoh` {version} is not there: {how}");
        println!("skipped: `eclipse-zenoh` {version} is not there: {how}");
    }
    is_there.then_some(other)
}

/// Python, and a folder whose packages come before those of its own.
pub struct Interpreter {
    python: PathBuf,
    packages: Option<PathBuf>,
}

impl From<&Path> for Interpreter {
    fn from(python: &Path) -> Self {
        Self { python: python.to_owned(), packages: None }
    }
}

impl Interpreter {
    fn command(&self) -> Command {
        let mut command = Command::new(&self.python);
        command.envs(self.packages.iter().map(|folder| ("PYTHONPATH", folder)));
        command
    }
}

/// The peer in Python, and its address as a router of Zenoh.
pub struct Peer {
    speaker: Speaker,
    pub address: String,
}

impl Peer {
    /// Starts a script of this folder, which has the types of services and their hashes as arguments.
    pub fn start(python: impl Into<Interpreter>, script: &str, types: &[&str]) -> Self {
        let address = free_address();
        let speaker = Speaker::start(python.into().command(), script, &[&[address.as_str()], types].concat());
        Self { speaker, address }
    }

    /// Lets the peer do something, and returns what it said.
    pub fn does(&mut self, word: &str) -> Vec<String> {
        self.lines.clear();
        self.speaker.hears(word);
        within(20.0, word, || self.says(&format!("done {word}")));
        self.lines.all()
    }

    pub fn node(&self, name: &str) -> Ros {
        Ros::node(name).args([""; 0]).domain(0).router(&self.address).open().expect("a node")
    }
}

impl Deref for Peer {
    type Target = Speaker;

    fn deref(&self) -> &Speaker {
        &self.speaker
    }
}
