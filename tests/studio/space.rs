//! Tokens in space: what is seen of them, and from where.

use crate::{
    browser::Browser,
    hands::HALTED,
    page::{RUNNING, Started, start_of, studio},
    socket,
    stream::Viewer,
};
use apex_macros::graph;
use apex_rt::studio::message::{Command, Report};
use std::{thread, time::Duration};

graph! {
    use apex_nodes::{cloud::RingCloud, scan::Scan};
    use apex_messages::visualization_msgs::MarkerArray;
    use apex_tests::nodes::{CountUp, box_ahead, pose_on_circle, scan_ahead, wall_ahead};

    /// Goes round, and sees a wall and a box ahead.
    graph Sees {
        out wall: RingCloud;
        out marks: MarkerArray;
        out scan: Scan;
        node count = CountUp() every 100ms;
        node pose  = pose_on_circle();
        count -> pose;
        pose -> wall_ahead() -> wall;
        pose -> box_ahead() -> marks;
        pose -> scan_ahead() -> scan;
    }
}

/// Numbers of pixels in the colours of low and high points and of the box.
const PIXELS: &str = "(() => {
    const space = document.getElementById('space');
    const flat = new OffscreenCanvas(space.width, space.height).getContext('2d');
    flat.drawImage(space, 0, 0);
    const { data } = flat.getImageData(0, 0, space.width, space.height);
    const found = [0, 0, 0];
    for (let at = 0; at < data.length; at += 4) {
        const [red, green, blue] = data.subarray(at, at + 3);
        if (green > 60) continue;
        if (blue > 160 && red < 60) found[0] += 1;
        if (red > 160 && blue < 60) found[1] += 1;
        if (red > 160 && blue > 160) found[2] += 1;
    }
    return found;
})()";
const SPACE: &str = "document.getElementById('space')";
const IMAGE: &str = "document.getElementById('space').toDataURL()";

/// Starts the robot, and opens its page with the tokens of some nodes in the plane.
fn seen(name: &'static str, nodes: &[&str]) -> Option<(Browser, Started)> {
    let robot = start_of(name, Sees::new, 3600);
    let mut page = Browser::open(&studio(name, false).0)?;
    page.size(1200, 900, false);
    page.wait_for(RUNNING);
    page.click("document.querySelector('[data-tab=values]')");
    for (at, node) in nodes.iter().enumerate() {
        let channel = format!("document.querySelector('[data-channel^=\"{node}\"] input')");
        page.wait_for(&channel);
        page.click(&channel);
        page.wait_for(&format!("document.getElementById('world').dataset.drawn === '{}'", at + 1));
    }
    Some((page, robot))
}

/// Halts the robot. Drawing in space keeps a machine busy, and a page may just have lost its connection: its header
/// says so, and until it has another one it drops what it is told.
fn halt(page: &mut Browser) {
    let is_halted = (0..6).any(|_| {
        page.press(" ");
        page.is_soon(HALTED, Duration::from_secs(10))
    });
    assert!(is_halted, "the robot does not halt: {}", page.words());
}

#[test]
fn clouds_and_boxes_are_seen_in_space_and_the_mouse_moves_the_eye() {
    let Some((mut page, _robot)) = seen("space-cloud", &["wall_ahead", "box_ahead"]) else { return };
    // The box stays beside the wall, wherever the robot is by then.
    page.choose("document.querySelector('[data-channel^=box_ahead] select')", "option.value === 'pose.out'");
    page.wait_for("document.getElementById('world').dataset.from === '2'");
    page.press("d");
    page.wait_for(&format!("!{SPACE}.hidden && document.getElementById('world').hidden"));
    page.wait_for(&format!("{PIXELS}.every((count) => count > 40)"));
    // Halted, the picture changes only if the eye does.
    halt(&mut page);
    let mut last = String::new();
    let mut changes = |page: &mut Browser, what: &str| {
        page.wait_for(&format!("{IMAGE} !== {last:?}"));
        last = page.value(IMAGE).as_str().expect(what).to_owned();
    };
    changes(&mut page, "it is there");
    let (x, y) = page.place(SPACE);
    page.drag((x, y), (x + 60.0, y + 20.0), false);
    changes(&mut page, "it turns");
    page.wheel(SPACE, -300.0);
    changes(&mut page, "it comes nearer");
    page.double_click(SPACE);
    changes(&mut page, "it sees all");
    page.press("d");
    page.wait_for(&format!("{SPACE}.hidden && !document.getElementById('world').hidden"));
    assert_eq!(page.complaints, Vec::<String>::new());
}

#[test]
fn without_webgl_there_is_the_plane() {
    let Some((mut page, _robot)) = seen("space-none", &["scan_ahead"]) else { return };
    page.click("document.getElementById('third')");
    // The scan is where it was taken.
    page.wait_for(&format!("{SPACE}.dataset.from === '1' && {SPACE}.dataset.can === 'true'"));
    page.click("document.getElementById('third')");
    let Some((mut other, _robot)) = seen("space-never", &["scan_ahead"]) else { return };
    other.value("(HTMLCanvasElement.prototype.getContext = () => null, 0)");
    other.click("document.getElementById('third')");
    other.wait_for("document.getElementById('third').disabled && !document.getElementById('world').hidden");
    other.wait_for("document.getElementById('third').title.includes('no WebGL')");
    for page in [page, other] {
        assert_eq!(page.complaints, Vec::<String>::new());
    }
}

#[test]
fn a_viewer_that_reads_slowly_gets_the_newest_tokens() {
    let _robot = start_of("behind", Sees::new, 3600);
    let mut viewer = Viewer::connect(socket("behind").to_str().expect("UTF-8")).expect("the robot listens");
    let wall = viewer.about().channels.iter().position(|channel| channel.name.starts_with("wall_ahead"));
    viewer.tell(&Command::Watch { channel: wall.expect("a port") as u32, every: 1 });
    viewer.tell(&Command::Run { speed: 100.0 });
    let newest = |viewer: &mut Viewer| match viewer.until(|report| matches!(report, Report::Value { .. })).pop() {
        Some(Report::Value { now, .. }) => now,
        other => panic!("{other:?}"),
    };
    let before = newest(&mut viewer);
    // 64 kB every 2 ms would be too much for the robot to keep.
    thread::sleep(Duration::from_secs(2));
    let mut tokens = 0;
    while newest(&mut viewer) < before + 150_000_000_000 {
        tokens += 1;
    }
    assert!(tokens < 500, "{tokens} tokens have waited");
}

#[test]
fn an_uncertain_pose_has_an_ellipse() {
    let Some((mut page, _robot)) = seen("space-ellipse", &[]) else { return };
    // Of all points of the ellipse, the Mahalanobis distance from the pose is 2.
    let distances = "import('./drawn.js').then(({ drawAll, hasPlace, isPose }) => {
        const drawn = [];
        const pen = { arrow: () => {}, line: (all) => drawn.push(...all) };
        const orientation = { x: 0, y: 0, z: 0, w: 1 };
        const covariance = Array(36).fill(0);
        [covariance[0], covariance[1], covariance[6], covariance[7]] = [0.5, 0.2, 0.2, 0.3];
        const estimate = { pose: { position: { x: 3, y: -1, z: 0 }, orientation }, covariance };
        const schemas = ['geometry_msgs/msg/PoseWithCovarianceStamped', 'nav_msgs/msg/Odometry'];
        const from = { pose: { pose: estimate.pose } };
        drawAll(pen, schemas.map((schema) => ({ schema, message: { pose: estimate }, from: null })), (_, draw) => draw());
        const seen = [];
        drawAll(pen, [{ schema: schemas[0], message: { pose: { ...estimate, covariance: Array(36).fill(0) } }, from }], ({ x }) => seen.push(x));
        const distance = ([x, y]) => {
            const [dx, dy, determinant] = [x - 3, y + 1, 0.5 * 0.3 - 0.2 * 0.2];
            return Math.sqrt((0.3 * dx * dx - 2 * 0.2 * dx * dy + 0.5 * dy * dy) / determinant);
        };
        const isRight = schemas.every(hasPlace) && schemas.every(isPose) && !isPose('geometry_msgs/msg/PoseArray');
        return [isRight, drawn.length, Math.min(...drawn.map(distance)), Math.max(...drawn.map(distance)), seen];
    })";
    let found = page.value(distances);
    assert_eq!((&found[0], &found[1], &found[4]), (&true.into(), &98.into(), &serde_json::json!([3])));
    let [least, most] = [2, 3].map(|at| found[at].as_f64().expect("a distance"));
    assert!((least - 2.0).abs() < 1e-9 && (most - 2.0).abs() < 1e-9, "{least} {most}");
}
