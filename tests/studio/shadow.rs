//! A robot and its shadow on the page.

use crate::{
    browser::Browser,
    page::{RUNNING, Text, opened},
    socket,
};
use apex_studio::{Recorded, Robot, Seat, Shadow};
use std::{
    fs,
    path::PathBuf,
    process::{Child, Command, Stdio},
    sync::Arc,
};

/// A robot that records its run for its shadow.
struct Original {
    recorded: Arc<Recorded>,
    folder: PathBuf,
    process: Option<Child>,
}

impl Robot for Original {
    fn start(&mut self, _again: bool) -> Result<String, String> {
        let address = self.folder.join("robot");
        let mut command = Command::new(env!("CARGO_BIN_EXE_apex-test-robot"));
        command.env("APEX_STUDIO", &address).env("APEX_STUDIO_WAIT", "1").stdout(Stdio::null());
        self.recorded.begin(&mut command, &self.folder, |_| {});
        self.process = Some(command.spawn().map_err(|error| error.to_string())?);
        Ok(address.display().to_string())
    }

    fn runs(&mut self) -> bool {
        true
    }

    fn stop(&mut self) {
        if let Some(mut process) = self.process.take() {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

impl Drop for Original {
    fn drop(&mut self) {
        self.stop();
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Shows the robot with this number.
fn look(page: &mut Browser, robot: u32) {
    page.choose("document.getElementById('robot')", &format!("option.value === '{robot}'"));
}

#[test]
fn a_shadow_is_compared_with_its_robot_and_hands_its_parameters_over() {
    let (recorded, folder) = (Arc::<Recorded>::default(), socket("shadow-folder"));
    fs::create_dir_all(&folder).expect("a new folder");
    let original = Original { recorded: Arc::clone(&recorded), folder, process: None };
    let seat = |name: &str, robot, shadow_of| Seat {
        name: name.to_owned(),
        robot,
        source: Arc::new(Text::default()),
        shadow_of,
    };
    let robots =
        vec![seat("first", Box::new(original), None), seat("shadow", Box::new(Shadow::new(recorded)), Some(0))];
    let Some(mut page) = Browser::open(&opened(robots, false)) else { return };
    page.wait_for(RUNNING);
    assert_eq!(page.value("document.getElementById('take').hidden"), true);
    look(&mut page, 1);
    page.wait_for("!document.getElementById('take').hidden");
    page.wait_for(RUNNING);
    // It cannot go back: its robot does not.
    assert_eq!(page.value("document.getElementById('back').hidden"), true);
    let row = "document.querySelector('[data-param=\"times.factor\"]')";
    page.wait_for(row);
    page.fill(&format!("{row}.querySelector('input[type=text]')"), "5");
    page.wait_for(&format!("{row}.classList.contains('is-changed')"));
    // Both curves in one plot.
    page.click("document.querySelector('[data-tab=values]')");
    let product = "document.querySelector('[data-channel=\"times.out\"]')";
    page.wait_for(product);
    page.click(&format!("{product}.querySelector('input')"));
    page.wait_for(&format!("Number({product}.dataset.beside) > 10"));
    page.click("document.getElementById('take')");
    look(&mut page, 0);
    page.wait_for(&format!("{row}?.classList.contains('is-changed')"));
    page.wait_for(&format!("{row}.querySelector('input[type=text]').value === '5'"));
    page.wait_for(&format!("Number({product}.dataset.beside) > 10"));
    assert_eq!(page.complaints, Vec::<String>::new());
}
