//! The pictures of the documentation: of robots that run, so that they are drawn on demand only.

use crate::{
    browser::Browser,
    page::{moment, wiring},
    socket,
};
use std::{
    env, fs,
    io::{self, BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// The folder of the workspace.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder of the workspace")
}

/// Builds a package of the workspace.
fn build(arguments: &[&str]) {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let built = cargo.args(["build", "--quiet", "--package"]).args(arguments).current_dir(root()).status();
    assert!(built.expect("cargo starts").success());
}

/// Builds the command `apex`, and returns its path: beside that of the tests.
fn apex() -> PathBuf {
    build(&["apex-cli"]);
    let own = env::current_exe().expect("a path");
    own.ancestors().nth(2).expect("the folder of the build").join("apex")
}

/// Settings of builds as in the tests of the command, so that what these have built is used again.
const SETTINGS: [(&str, &str); 4] = [
    ("CARGO_INCREMENTAL", "0"),
    ("CARGO_PROFILE_DEV_DEBUG", "0"),
    ("CARGO_PROFILE_DEV_BUILD_OVERRIDE_OPT_LEVEL", "0"),
    ("CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL", "0"),
];

/// A studio of `apex studio`, which ends with it.
struct Studio {
    process: Child,
    address: String,
}

impl Studio {
    fn open(mut command: Command, folder: &Path, arguments: &[&str]) -> Self {
        command.args(["studio", "--listen", "127.0.0.1:0"]).args(arguments).current_dir(folder);
        let mut process = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
        let mut lines = BufReader::new(process.stderr.take().expect("it is piped")).lines().map_while(Result::ok);
        let address = lines.find_map(|line| Some(line.strip_prefix("studio: ")?.to_owned())).expect("an address");
        thread::spawn(move || lines.for_each(drop));
        Self { process, address }
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        // The robot has to end, too.
        let _ = Command::new("kill").arg(self.process.id().to_string()).status();
        let _ = self.process.wait();
    }
}

fn save(page: &mut Browser, name: &str) {
    fs::write(root().join("docs/images").join(name), page.picture()).expect("a folder for pictures");
}

/// Time between two pictures of a film.
const INTERVAL: Duration = Duration::from_millis(250);

/// Pictures of the page, one after the other, as RGBA.
#[derive(Default)]
struct Film {
    size: (u32, u32),
    frames: Vec<Vec<u8>>,
}

impl Film {
    /// Takes `count` pictures, one each [`INTERVAL`].
    fn take(&mut self, page: &mut Browser, count: usize) {
        let mut next = Instant::now();
        for _ in 0..count {
            let mut decoder = png::Decoder::new(io::Cursor::new(page.picture()));
            decoder.set_transformations(png::Transformations::ALPHA);
            let mut reader = decoder.read_info().expect("a picture");
            let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
            let frame = reader.next_frame(&mut pixels).expect("a picture");
            self.size = (frame.width, frame.height);
            self.frames.push(pixels);
            next += INTERVAL;
            thread::sleep(next.saturating_duration_since(Instant::now()));
        }
    }

    /// Writes the film as an animated PNG that begins again at its end. Pixels that stay are transparent.
    fn save(&self, name: &str) -> Result<(), png::EncodingError> {
        let file = fs::File::create(root().join("docs/images").join(name)).expect("a folder for pictures");
        let mut encoder = png::Encoder::new(io::BufWriter::new(file), self.size.0, self.size.1);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_compression(png::Compression::High);
        encoder.set_animated(self.frames.len() as u32, 0)?;
        encoder.set_frame_delay(INTERVAL.as_millis() as u16, 1000)?;
        encoder.set_blend_op(png::BlendOp::Over)?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.frames[0])?;
        for frames in self.frames.windows(2) {
            let pixels = frames[0].as_chunks::<4>().0.iter().zip(frames[1].as_chunks::<4>().0);
            let changes: Vec<u8> = pixels.flat_map(|(old, new)| if old == new { [0; 4] } else { *new }).collect();
            writer.write_image_data(&changes)?;
        }
        writer.finish()
    }
}

fn time_is_over(page: &mut Browser, seconds: f64) {
    page.wait_for(&format!("parseFloat(document.getElementById('now').textContent) > {seconds}"));
}

/// Clicks what a selector finds, once it is there.
fn click(page: &mut Browser, selector: &str) {
    page.wait_for(&format!("document.querySelector('{selector}')"));
    page.click(&format!("document.querySelector('{selector}')"));
}

/// Shows the tokens of a channel from the pose at another one.
fn see_from(page: &mut Browser, channel: &str, pose: &str) {
    let from = format!("document.querySelector('[data-channel=\"{channel}\"] select')");
    page.choose(&from, &format!("option.value === '{pose}'"));
}

#[test]
#[ignore = "draws docs/images/studio*.png: cargo test -p apex-tests --test studio -- --ignored pictures"]
fn pictures() {
    let folder = socket("pictures");
    fs::create_dir_all(&folder).expect("a new folder");
    let robot = root().join("robots/rover/robot.afg");
    let studio =
        Studio::open(Command::new(apex()), &folder, &["--simulated", "--speed", "4", robot.to_str().expect("UTF-8")]);
    let mut page = Browser::open(&studio.address).expect("a browser");
    page.size(1280, 760, false);
    click(&mut page, "[data-tab=params]");
    page.fill("document.getElementById('params-filter')", "mission");
    time_is_over(&mut page, 44.0);
    page.press("0");
    save(&mut page, "studio.png");
    page.size(1280, 760, true);
    click(&mut page, "[data-tab=values]");
    click(&mut page, "[data-channel=\"sim.base.battery\"] input");
    click(&mut page, "[data-channel=\"sim.laser.scan\"] input");
    time_is_over(&mut page, 60.0);
    wiring(&mut page);
    page.press("0");
    save(&mut page, "studio_dark.png");
    // Narrow, for a look only.
    if let Some(place) = env::var_os("APEX_NARROW") {
        page.size(640, 760, true);
        page.press("0");
        page.value("new Promise((done) => setTimeout(done, 500))");
        fs::write(place, page.picture()).expect("a place for it");
    }
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
#[ignore = "draws docs/images/studio_competition.png: cargo test -p apex-tests --test studio -- --ignored film"]
fn film_of_the_competition() {
    let folder = socket("film");
    fs::create_dir_all(&folder).expect("a new folder");
    let robot = root().join("robots/sick-robot-day/competition.afg");
    let robot = robot.to_str().expect("UTF-8");
    let arguments = ["--release", "--speed", "4", robot, "--", "--minutes", "3"];
    let studio = Studio::open(Command::new(apex()), &folder, &arguments);
    let mut page = Browser::open(&studio.address).expect("a browser");
    page.size(1120, 700, false);
    click(&mut page, "[data-tab=values]");
    for channel in ["slam.map", "slam.pose", "around.both.merged"] {
        click(&mut page, &format!("[data-channel$=\"{channel}\"] input"));
    }
    see_from(&mut page, "surroundings.around.both.merged", "surroundings.localize.slam.pose");
    page.fill("document.getElementById('lanes-filter')", "follow");
    time_is_over(&mut page, 20.0);
    // The plane is above the ports.
    page.value("document.querySelector('[data-panel=values]').scrollTop = 0");
    page.press("0");
    let mut film = Film::default();
    film.take(&mut page, 48);
    film.save("studio_competition.png").expect("a file");
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
#[ignore = "draws docs/images/studio_space.png: cargo test -p apex-tests --test studio -- --ignored in_space"]
fn picture_in_space() {
    let folder = socket("in-space");
    fs::create_dir_all(&folder).expect("a new folder");
    let address = folder.join("robot");
    build(&["follow", "--release"]);
    let apex = apex();
    let mut follow = Command::new(apex.with_file_name("../release/follow"));
    follow.args(["--metres", "200", "--out"]).arg(folder.join("track.svg"));
    follow.env("APEX_STUDIO", &address).env("APEX_STUDIO_WAIT", "1");
    let mut follow = follow.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let robot = root().join("robots/follow/follow.afg");
    let [address, robot] = [&address, &robot].map(|path| path.to_str().expect("UTF-8"));
    let studio = Studio::open(Command::new(apex), &folder, &["--connect", address, robot]);
    let mut page = Browser::open(&studio.address).expect("a browser");
    page.size(1280, 760, false);
    click(&mut page, "[data-tab=values]");
    let pose = "wheels.out";
    for channel in ["scanner.turn", "pursue.fast.planner.path", pose] {
        click(&mut page, &format!("[data-channel=\"{channel}\"] input"));
    }
    see_from(&mut page, "scanner.turn", pose);
    click(&mut page, "#pause");
    time_is_over(&mut page, 20.0);
    click(&mut page, "#pause");
    click(&mut page, "#third");
    page.value("document.querySelector('[data-panel=values]').scrollTop = 0");
    page.press("0");
    let (x, y) = page.place("document.getElementById('space')");
    page.drag((x, y), (x + 10.0, y + 5.0), false);
    page.wheel("document.getElementById('space')", -900.0);
    save(&mut page, "studio_space.png");
    follow.kill().expect("it runs");
    follow.wait().expect("it ends");
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
#[ignore = "draws docs/images/studio_travel.png: cargo test -p apex-tests --test studio -- --ignored travel"]
fn film_of_a_travel_in_time() {
    let folder = socket("travel");
    fs::create_dir_all(&folder).expect("a new folder");
    let robot = root().join("robots/rover/robot.afg");
    let studio = Studio::open(Command::new(apex()), &folder, &["--simulated", robot.to_str().expect("UTF-8")]);
    let mut page = Browser::open(&studio.address).expect("a browser");
    page.size(1120, 640, false);
    click(&mut page, "[data-tab=params]");
    page.fill("document.getElementById('params-filter')", "mission.drive");
    time_is_over(&mut page, 12.0);
    page.press("0");
    let mut film = Film::default();
    film.take(&mut page, 12);
    page.press(" ");
    page.wait_for("document.getElementById('run').textContent === 'halted'");
    film.take(&mut page, 4);
    // Back to where it drove towards the wall.
    let place = moment(&mut page, 8.0);
    page.click_at(place);
    film.take(&mut page, 2);
    page.press("g");
    page.wait_for(
        "document.getElementById('run').textContent === 'halted' && parseFloat(document.getElementById('now').textContent) < 8.1",
    );
    film.take(&mut page, 4);
    let text = "document.querySelector('[data-param=\"sim.mission.drive.near\"] input[type=text]')";
    page.fill(text, "1.5");
    page.wait_for("document.querySelector('[data-param=\"sim.mission.drive.near\"]').classList.contains('is-changed')");
    film.take(&mut page, 4);
    page.press(" ");
    film.take(&mut page, 16);
    film.save("studio_travel.png").expect("a file");
    fs::remove_dir_all(folder).expect("it is still there");
}

#[test]
#[ignore = "draws docs/images/study*.png: cargo test -p apex-tests --test studio -- --ignored pictures"]
fn pictures_of_a_study() {
    let folder = socket("study-picture");
    let cart = root().join("robots/cart/cart.afg");
    let mut tune = Command::new(apex());
    tune.arg("tune").arg(cart).args(["Swift", "--candidates", "200", "--quiet", "--output"]).arg(&folder);
    assert!(tune.stdout(Stdio::null()).status().expect("it starts").success());
    let studio = Studio::open(Command::new(apex()), root(), &[folder.to_str().expect("UTF-8")]);
    let mut page = Browser::open(&studio.address).expect("a browser");
    for (name, is_dark) in [("study.png", false), ("study_dark.png", true)] {
        page.size(1280, 760, is_dark);
        page.wait_for("document.getElementById('run').textContent === 'finished'");
        page.wait_for("document.getElementById('toml').textContent.includes('stiffness')");
        page.value("new Promise((done) => setTimeout(done, 500))");
        save(&mut page, name);
        page.press("2");
        page.press("o");
    }
    fs::remove_dir_all(folder).expect("it is still there");
}

/// Makes the robot of `docs/debugging.md` in a folder.
fn robot_with_a_mistake(folder: &Path) {
    fs::create_dir_all(folder).expect("a new folder");
    let made = Command::new(apex()).args(["new", "rover"]).current_dir(folder).stdout(Stdio::null()).status();
    assert!(made.expect("it starts").success());
    let path = folder.join("rover/robot.afg");
    let text = fs::read_to_string(&path).expect("the robot");
    let wrong =
        text.replace("free -> drive.free", "wide -> drive.free").replace("wide -> turn.free", "free -> turn.free");
    assert!(text != wrong);
    fs::write(path, wrong).expect("a file");
}

#[test]
#[ignore = "draws docs/images/debugging*.png: cargo test -p apex-tests --test studio -- --ignored pictures"]
fn pictures_of_a_mistake() {
    let folder = socket("mistake");
    robot_with_a_mistake(&folder);
    let mut command = Command::new(apex());
    command.env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("../tests/trybuild")).envs(SETTINGS);
    let rover = folder.join("rover");
    let studio = Studio::open(command, &rover, &["--simulated", "--speed", "4", "robot.afg"]);
    let mut page = Browser::open(&studio.address).expect("a browser");
    page.size(1280, 760, false);
    time_is_over(&mut page, 13.5);
    page.press(" ");
    page.wait_for("document.getElementById('run').textContent === 'halted'");
    page.value("import('./studio.js').then(({ select }) => select('sim.mission.turn'))");
    // From 9.5 s to 12.5 s, with the cursor in it.
    let look = |page: &mut Browser| {
        page.value(
            "document.getElementById('timeline').dispatchEvent(new CustomEvent('look', { detail: [9.5, 12.5, 10.52] }))",
        );
        page.value("new Promise((done) => setTimeout(done, 600))");
    };
    look(&mut page);
    page.press("w");
    page.wait_for("document.querySelector('#why button')");
    page.press("0");
    save(&mut page, "debugging.png");
    page.size(1280, 760, true);
    let place = moment(&mut page, 10.0);
    page.click_at(place);
    page.press("g");
    page.wait_for(
        "document.getElementById('run').textContent === 'halted' && parseFloat(document.getElementById('now').textContent) < 10.1",
    );
    click(&mut page, "[data-tab=params]");
    page.fill("document.getElementById('params-filter')", "mission.drive");
    let text = "document.querySelector('[data-param=\"sim.mission.drive.near\"] input[type=text]')";
    page.fill(text, "0.4");
    page.wait_for("document.querySelector('[data-param=\"sim.mission.drive.near\"]').classList.contains('is-changed')");
    page.press(" ");
    time_is_over(&mut page, 13.0);
    page.press(" ");
    look(&mut page);
    page.press("0");
    save(&mut page, "debugging_dark.png");
    fs::remove_dir_all(folder).expect("it is still there");
}
