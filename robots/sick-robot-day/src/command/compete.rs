use super::setup::read_setup;
use apex_sim::{
    experiment::{Options, write_file},
    say,
};
use sick_robot_day::{
    experiments::{
        measure::ImageWriter,
        run::{Outcome, Recording, Setup, StepView, Watch},
        run_report::{Film, LiveView, Snapshot},
    },
    world::{
        Arena,
        contest::{Fault, Hall},
    },
};
use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Duration,
};

/// Default folder of the pictures.
const PICTURES: &str = "out/sick-robot-day";

/// Plays a competition, and prints its result.
pub fn compete(options: &mut Options) -> Result<ExitCode, String> {
    let mut setup = Setup { seed: 1, duration: Duration::from_secs(600), ..Setup::default() };
    let (mut out, mut film, mut file, mut images) = (None, None, None, false);
    while let Some(name) = options.next_name()? {
        match name.as_str() {
            "seed" => setup.seed = options.number(&name, 0..)?,
            "fault" => setup.faults.push(options.text()?.parse()?),
            "out" => out = Some(options.path()?),
            "film" => film = Some(options.path()?),
            "record" => file = Some(options.path()?),
            "record-images" => images = true,
            _ => read_setup(&mut setup, &name, options)?,
        }
    }
    if images && file.is_none() {
        return Err("`--record-images` needs `--record`, which says where".to_owned());
    }
    setup.record = file.map(|path| Recording { path, images });
    play(&setup, out, film.as_deref())
}

fn play(setup: &Setup, out: Option<PathBuf>, film: Option<&Path>) -> Result<ExitCode, String> {
    let folder = out.unwrap_or_else(free_folder);
    // Checked before the run: the folder of the pictures must be usable.
    let image_writer = ImageWriter::new(&folder)?;
    let studio = setup.mission.studio().map_err(|e| format!("cannot open the socket in `APEX_STUDIO`: {e}"))?;
    let mut view = View::of(setup);
    let outcome = setup.run(&mut view, studio.as_ref())?;
    outcome.run_report.write(&image_writer)?;
    if let Some(path) = film {
        write_file(path, &view.film.svg(&outcome.run_report))?;
    }
    say(&summary(setup, &outcome, &folder))?;
    Ok(if outcome.is_fine() { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Default folder of the pictures. If it is not empty, a folder with a number.
fn free_folder() -> PathBuf {
    let is_free = |path: &Path| !path.exists() || path.read_dir().is_ok_and(|mut files| files.next().is_none());
    let numbered = (2_u32..).map(|number| PathBuf::from(format!("{PICTURES}-{number}")));
    let all = std::iter::once(PathBuf::from(PICTURES)).chain(numbered);
    all.into_iter().find(|path| is_free(path)).unwrap_or_else(|| PICTURES.into())
}

fn summary(setup: &Setup, outcome: &Outcome, folder: &Path) -> String {
    let mut text = format!("{}\n\n", outcome.run_report.table());
    // Writing to a `String` cannot fail.
    for failure in &outcome.failures {
        let _ = writeln!(text, "failure: {failure}");
    }
    let _ = write!(text, "seed {}", setup.seed);
    if !setup.faults.is_empty() {
        let faults: Vec<String> = setup.faults.iter().map(Fault::to_string).collect();
        let _ = write!(text, "; faults: {}", faults.join(", "));
    }
    let _ = writeln!(text, "; pictures: {}/*.png", folder.display());
    if let Some(recorded) = &outcome.recorded {
        let _ = writeln!(text, "recorded to {}", recorded.path.display());
        for (channel, count) in &recorded.dropped {
            let _ = writeln!(text, "warning: {count} messages of `{channel}` were lost");
        }
    }
    text
}

/// View of a run in progress.
struct View {
    live: LiveView,
    film: Film,
    /// Walls, which do not move.
    arena: Arena,
}

impl View {
    fn of(setup: &Setup) -> Self {
        Self { live: LiveView::new(false), film: Film::default(), arena: Arena::new(setup.seed) }
    }
}

impl Watch for View {
    fn reacted(&mut self, moment: &StepView<'_>) {
        self.film.take(moment.now, || moment.hall.robots());
        let arena = &self.arena;
        self.live.show(moment.now, || snapshot(moment, moment.hall, arena));
    }
}

fn snapshot<'a>(moment: &StepView<'_>, hall: &Hall, arena: &'a Arena) -> Snapshot<'a> {
    let ([ours, rivals @ ..], report) = (hall.robots(), hall.report());
    Snapshot {
        now: moment.now,
        arena,
        pose: ours.pose,
        rivals: rivals.iter().map(|rival| rival.pose.position()).collect(),
        points: report.points() as u32,
        penalties: report.penalties() as u32,
        active: moment.active(),
        hopper: ours.cube,
    }
}
