//! The pictures of the documentation: of robots that run, so that they are drawn on demand only.

use crate::browser::Browser;
use base64::{Engine as _, prelude::BASE64_STANDARD};
use std::{
    env, fs,
    io::{BufRead as _, BufReader},
    path::Path,
    process::{Child, Command, Stdio},
};

/// A studio of `apex studio`, which ends with it.
struct Studio {
    process: Child,
    address: String,
}

impl Studio {
    fn open(arguments: &[&str]) -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder of the workspace");
        let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.args(["run", "--quiet", "--release", "--package", "apex-cli", "--", "studio"]).args(arguments);
        command.args(["--listen", "127.0.0.1:0"]);
        let mut process = command.current_dir(root).stderr(Stdio::piped()).spawn().expect("cargo starts");
        let mut lines = BufReader::new(process.stderr.take().expect("it is piped")).lines().map_while(Result::ok);
        let address = lines.find_map(|line| Some(line.strip_prefix("studio: ")?.to_owned())).expect("an address");
        std::thread::spawn(move || lines.for_each(drop));
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
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/images");
    let picture = BASE64_STANDARD.decode(page.picture()).expect("base 64");
    fs::write(folder.join(name), picture).expect("a folder for pictures");
}

#[test]
#[ignore = "draws docs/images/studio*.png: cargo test -p apex-tests --test studio -- --ignored pictures"]
fn pictures() {
    let studio = Studio::open(&["--simulated", "--release", "--speed", "4", "robots/rover/robot.afg"]);
    let mut page = Browser::open(&studio.address).expect("a browser");
    page.size(1280, 760, false);
    page.value("document.querySelector('[data-tab=params]').click()");
    page.value("document.getElementById('params-filter').value = 'mission'");
    page.value("document.getElementById('params-filter').dispatchEvent(new Event('input'))");
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 44");
    page.press("0");
    save(&mut page, "studio.png");
    page.size(1280, 760, true);
    page.value("document.querySelector('[data-tab=values]').click()");
    page.value("document.querySelector('[data-channel=\"sim.base.battery\"] input').click()");
    page.value("document.querySelector('[data-channel=\"sim.laser.scan\"] input').click()");
    let from = "document.querySelector('[data-channel=\"sim.laser.scan\"] select')";
    page.value(&format!("{{ {from}.value = 'sim.base.pose'; {from}.dispatchEvent(new Event('change')); }}"));
    page.wait_for("parseFloat(document.getElementById('now').textContent) > 60");
    page.press("0");
    save(&mut page, "studio_dark.png");
}
