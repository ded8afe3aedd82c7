//! The programs on the page about ROS 2 are the examples, and only this crate needs Zenoh.

use std::{fs, path::Path};

#[test]
fn the_page_shows_the_examples() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("../docs/ros2.md")).expect("the page");
    let blocks = |word: &str| {
        let fence = format!("```{word}\n");
        page.split(&fence).skip(1).filter_map(|rest| Some(rest.split_once("```")?.0.to_owned())).collect::<Vec<_>>()
    };
    let example = |name: &str| fs::read_to_string(root.join("examples").join(name)).expect("the example");
    let shown = |name: &str| {
        let text = example(name);
        // Without the comment at the top, which says how to run it.
        text.split_once("\n\n").map(|(_, rest)| rest.to_owned()).unwrap_or_default()
    };
    assert_eq!(blocks("rust"), [shown("turtlebot.rs"), shown("goals/main.rs")]);
    assert_eq!(blocks("afg"), [shown("turtlebot.afg"), shown("goals/goals.afg")]);
    assert_eq!(blocks("yaml"), [example("turtlebot.yaml")]);
}

mod turtlebot {
    apex_macros::graph!("../examples/turtlebot.afg");

    /// The parameters on the page are those of the program, and are in range.
    #[test]
    fn the_page_has_a_file_of_parameters() {
        use apex_rt::params::Parameters as _;
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/turtlebot.yaml");
        let ros = apex_ros::Ros::node("forward").args(["--ros-args", "--params-file", path]).open().expect("a node");
        let mut program = Forward::new();
        ros.set_params(&mut program).expect("parameters");
        let mut value = |name| program.param::<f32>(name).expect("a parameter");
        assert_eq!((value("drive.distance"), value("field.radius")), (0.5, 0.3));
    }
}

#[test]
fn the_project_is_built_without_zenoh_and_dds() {
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock");
    let lock = fs::read_to_string(lock).expect("the workspace has one");
    assert!(
        lock.contains("name = \"apex-rt\"")
            && ["zenoh", "rustdds"].iter().all(|it| !lock.contains(&format!("name = \"{it}")))
    );
}
