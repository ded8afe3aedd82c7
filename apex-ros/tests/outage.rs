//! The robot of `robots/rover` drives a base in another process, which is killed and started again.

mod common;

#[path = "../examples/base.rs"]
#[allow(dead_code, missing_docs)]
mod base;
#[path = "../examples/rover.rs"]
#[allow(dead_code, missing_docs, unused_imports)]
mod rover_node;

use apex_messages::geometry_msgs::Twist;
use common::{Router, within};
use std::{
    env,
    process::{Child, Command, Stdio},
    sync::{Arc, Mutex},
    thread,
    time::{Duration, Instant},
};

// The texts look for these in the root of the crate.
pub use rover::{AskBattery, Drive, Retrace, Turn, free_ahead};

/// Number of times that the base is killed, unless the environment variable `APEX_ROS_KILLS` names another one.
const KILLS: usize = 5;
/// Time within which the robot stops after the last message of its base, with what the machine adds, in s. The guards
/// of the mission wait for 0.5 s.
const TIMEOUT: f32 = 0.5 + 0.5;

/// Environment variable of the processes of this test.
const ROLE: &str = "APEX_ROS_TEST_ROLE";

/// The other processes: this test, started with a role.
#[test]
fn other_process() {
    let run = match env::var(ROLE).as_deref() {
        Ok("base") => base::main,
        Ok("rover") => rover_node::main,
        _ => return,
    };
    run().expect("it runs until it is killed");
}

struct Process(Child);

impl Process {
    fn start(role: &str, router: &Router) -> Self {
        let child = Command::new(env::current_exe().expect("this test"))
            .args(["other_process", "--exact", "--quiet"])
            .env(ROLE, role)
            .env("ZENOH_CONFIG_OVERRIDE", format!("connect/endpoints=[{:?}]", router.address))
            .stdout(Stdio::null())
            .spawn();
        Self(child.expect("it starts"))
    }

    fn kill(&mut self) {
        self.0.kill().expect("it runs");
        self.0.wait().expect("it ends");
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Last twist, and the time at which it came.
type Last = Arc<Mutex<Option<(Twist, Instant)>>>;

fn drives(last: &Last) -> bool {
    let last = last.lock().expect("no panic");
    last.as_ref().is_some_and(|(twist, at)| *twist != Twist::default() && at.elapsed() < Duration::from_millis(300))
}

fn stands(last: &Last) -> bool {
    last.lock().expect("no panic").as_ref().is_some_and(|(twist, _)| *twist == Twist::default())
}

#[test]
fn the_robot_stops_without_its_base_and_goes_on_with_it() {
    let router = Router::start();
    let witness = router.node("witness").open().expect("a node");
    let last = Last::default();
    let twists = Arc::clone(&last);
    witness
        .subscribe("cmd_vel")
        .each(move |twist: Twist| *twists.lock().expect("no panic") = Some((twist, Instant::now())))
        .expect("a topic");
    let mut rover = Process::start("rover", &router);
    let mut base = Process::start("base", &router);
    let kills = env::var("APEX_ROS_KILLS").ok().and_then(|kills| kills.parse().ok()).unwrap_or(KILLS);
    for kill in 1..=kills {
        within(20.0, "the robot drives", || drives(&last));
        thread::sleep(Duration::from_millis(500));
        base.kill();
        let stopped = within(TIMEOUT, "the robot stops", || stands(&last));
        println!("kill {kill}: stopped after {stopped:?}");
        thread::sleep(Duration::from_millis(500));
        assert!(stands(&last), "it stands as long as its base is away");
        base = Process::start("base", &router);
    }
    within(20.0, "the robot drives again", || drives(&last));
    // Ctrl-C: the last twist is zero.
    let id = rover.0.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().is_ok_and(|status| status.success()));
    rover.0.wait().expect("it ends");
    within(1.0, "the last twist", || stands(&last));
}
