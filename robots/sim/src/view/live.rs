use super::{picture::Picture, svg, terminal};
use crate::{FloorPlan, PlanError};
use apex_nodes::scan::{Pose2, Scan};
use apex_rt::{Ctx, Time, node};
use core::{fmt, time::Duration};
use std::{
    fs, io,
    io::{IsTerminal as _, Write as _},
    path::Path,
};

/// Period of writing the file.
const FILE_PERIOD: Duration = Duration::from_secs(1);

/// Shows a drawn world ([`FloorPlan`](crate::FloorPlan)) with the robot, its trail and the points of its scan.
///
/// On a terminal the picture is redrawn in place, with the last note below. If the output is redirected, each note is a
/// line with its time, and no picture is drawn. The picture is also written to a file, once per second and with each
/// note.
#[node]
#[derive(Debug, Clone)]
pub struct LiveView {
    /// Drawing of the world.
    #[param]
    world: &'static str,
    /// Time between two pictures on the terminal.
    #[param(unit = "s", default = 0.1, range = 0.01..=60.0)]
    period: f32,
    /// SVG file to write, or empty for none.
    #[param(default = "")]
    file: &'static str,
    picture: Option<Picture>,
    shown: Option<Time>,
    written: Option<Time>,
    lines: usize,
    failed: bool,
}

/// Error of the view.
#[derive(Debug)]
pub enum ViewError {
    /// The drawing is not a world.
    Plan(PlanError),
    /// The picture cannot be written: the file, and the error.
    File(&'static str, io::Error),
    /// The terminal cannot be written to.
    Terminal(io::Error),
}

impl fmt::Display for ViewError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Plan(error) => error.fmt(f),
            Self::File(file, error) => write!(f, "cannot write the picture `{file}`: {error}"),
            Self::Terminal(error) => write!(f, "cannot draw on the terminal: {error}"),
        }
    }
}

impl core::error::Error for ViewError {}

#[node]
impl LiveView {
    /// Takes the true pose of the robot, and its scan.
    fn process(&mut self, ctx: &Ctx, pose: &Pose2, scan: Option<&Scan>) -> Result<(), ViewError> {
        if self.failed {
            return Ok(());
        }
        self.look(ctx, pose, scan).and_then(|()| self.show(false)).inspect_err(|_| self.failed = true)
    }

    /// Shows a note from now on.
    #[slot]
    fn note(&mut self, text: &String, ctx: &Ctx) -> Result<(), ViewError> {
        let now = ctx.now();
        if !io::stdout().is_terminal() {
            println!("{:7.2} s  {text}", now.as_secs_f64());
        }
        let Some(picture) = &mut self.picture else { return Ok(()) };
        picture.note.clone_from(text);
        picture.now = now;
        if self.failed { Ok(()) } else { self.show(true).inspect_err(|_| self.failed = true) }
    }

    fn look(&mut self, ctx: &Ctx, pose: &Pose2, scan: Option<&Scan>) -> Result<(), ViewError> {
        let picture = match &mut self.picture {
            Some(picture) => picture,
            none => none.insert(Picture::new(FloorPlan::parse(self.world).map_err(ViewError::Plan)?)),
        };
        picture.now = ctx.now();
        picture.come_to(pose);
        if let Some(scan) = scan {
            picture.hits.clear();
            picture.hits.extend(scan.points().map(|(_, point)| pose.to_outer(point)));
        }
        Ok(())
    }

    /// Draws the outputs that are due, or all.
    fn show(&mut self, everything: bool) -> Result<(), ViewError> {
        let Some(picture) = &self.picture else { return Ok(()) };
        let due = |last: Option<Time>, period: Duration| {
            everything || last.is_none_or(|last| picture.now.since(last) >= period)
        };
        if !self.file.is_empty() && due(self.written, FILE_PERIOD) && !apex_rt::is_shadow() {
            write_whole(Path::new(self.file), &svg::draw(picture)).map_err(|e| ViewError::File(self.file, e))?;
            self.written = Some(picture.now);
        }
        let period = Duration::try_from_secs_f32(self.period).unwrap_or(FILE_PERIOD);
        if io::stdout().is_terminal() && due(self.shown, period) {
            self.lines = draw_on_terminal(picture, self.lines).map_err(ViewError::Terminal)?;
            self.shown = Some(picture.now);
        }
        Ok(())
    }
}

/// Draws over the last picture of `lines` lines. Returns the number of lines of the new one.
fn draw_on_terminal(picture: &Picture, lines: usize) -> io::Result<usize> {
    let (columns, rows) = picture.plan.size();
    let room = terminal_size::terminal_size().map_or((80, 24), |(w, h)| (usize::from(w.0), usize::from(h.0)));
    let (text, count) = if columns <= room.0 && rows + 2 <= room.1 {
        (terminal::draw(picture), rows + 1)
    } else {
        let size = format!("{columns} columns and {} lines", rows + 2);
        (format!("(a terminal of {size} shows the map) {}\x1b[K\n", terminal::caption(picture)), 1)
    };
    let mut output = io::stdout().lock();
    // Moves up to the start of the last picture. The rest of it below the new one is removed.
    let up = if lines > 0 { format!("\x1b[{lines}A\r") } else { String::new() };
    output.write_all(format!("{up}{text}\x1b[J").as_bytes())?;
    output.flush()?;
    Ok(count)
}

/// Replaces a file atomically, so that readers never see a part of it.
fn write_whole(path: &Path, text: &str) -> io::Result<()> {
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        fs::create_dir_all(folder)?;
    }
    let part = path.with_extension("part");
    fs::write(&part, text)?;
    fs::rename(&part, path)
}

#[cfg(test)]
mod tests {
    use super::{super::picture::tests::ROOM, *};
    use apex_rt::Construct;

    #[test]
    fn the_file_is_written_once_a_second_and_with_each_note() {
        let file = std::env::temp_dir().join(format!("apex-sim-{}/view.svg", std::process::id()));
        let name: &'static str = file.to_str().expect("a readable path").to_owned().leak();
        let mut node = LiveView::construct((ROOM, 0.1, name));
        let at = |ms| Ctx::new(Time::from_millis(ms));
        let text = || fs::read_to_string(&file).expect("the picture");
        let pose = Pose2::new(0.7, 0.75, 0.0);
        node.process(&at(0), &pose, None).expect("it can be written");
        let first = text();
        node.process(&at(900), &pose, None).expect("it can be written");
        assert_eq!(text(), first);
        node.process(&at(1000), &pose, None).expect("it can be written");
        assert_ne!(text(), first);
        node.note(&"turns".to_owned(), &at(1100)).expect("it can be written");
        assert!(text().contains("turns"));
        let folder = file.parent().expect("a folder");
        assert_eq!(fs::read_dir(folder).expect("the folder").count(), 1, "nothing else is left there");
        fs::remove_dir_all(folder).expect("the folder can be removed");
    }

    #[test]
    fn a_shadow_writes_no_file() {
        let file = std::env::temp_dir().join(format!("apex-sim-shadow-{}.svg", std::process::id()));
        if apex_rt::is_shadow() {
            let name: &'static str = file.to_str().expect("a readable path").to_owned().leak();
            let mut node = LiveView::construct((ROOM, 0.1, name));
            node.process(&Ctx::new(Time::ZERO), &Pose2::new(0.7, 0.75, 0.0), None).expect("it writes nothing");
            assert!(!file.exists());
            return;
        }
        // Only another process has another environment.
        let own = std::env::current_exe().expect("a path");
        let mut shadow = std::process::Command::new(own);
        let output =
            shadow.args(["--exact", "view::live::tests::a_shadow_writes_no_file"]).env("APEX_REPLAY_FOLLOW", "1");
        let output = output.output().expect("it starts");
        assert!(output.status.success() && String::from_utf8_lossy(&output.stdout).contains("1 passed"), "{output:?}");
    }

    #[test]
    fn what_cannot_be_shown_is_reported_once() {
        let mut node = LiveView::construct(("", 0.1, ""));
        let mut look = || node.process(&Ctx::new(Time::ZERO), &Pose2::default(), None);
        assert!(matches!(look(), Err(ViewError::Plan(PlanError::NoStart))));
        assert!(look().is_ok());
    }
}
