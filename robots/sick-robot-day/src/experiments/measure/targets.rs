use super::{ImageWriter, Times, percentile, places};
use crate::{
    camera,
    programs::FindTarget,
    world::{Arena, Sensors, hall_light},
};
use apex_nodes::{image::Target, scan::Pose2};
use apex_rt::Time;
use apex_sim::{Random, experiment::Progress};
use std::{fmt, time::Instant};

/// Distances of the camera from the target, in m.
const DISTANCES: [f32; 8] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];

/// Angular velocities of the robot, in rad/s. At 1 rad/s, an exposure of 10 ms blurs the image over 5 pixels.
const TURNS: [f32; 2] = [0.0, 1.0];

/// Maximum angle of the camera from straight ahead of the target, in rad.
const SLANT: f32 = 0.5;

/// Maximum position error of a correct detection, in m. Detections with a greater error are other objects.
const NEAR: f32 = 0.3;

/// Results of the detection of targets.
#[derive(Debug, Clone, Default)]
pub struct Targets {
    /// Results by distance, then by angular velocity.
    cells: [[Cell; TURNS.len()]; DISTANCES.len()],
    times: Times,
}

#[derive(Debug, Clone, Default)]
struct Cell {
    frames: u32,
    elsewhere: u32,
    /// Errors of the detected targets, in m and rad.
    places: Vec<f32>,
    angles: Vec<f32>,
}

/// Evaluates one station at each distance and angular velocity, for each seed.
///
/// # Errors
/// If an image cannot be written.
pub fn targets(
    seeds: u64,
    sensors: &mut Sensors,
    image_writer: &ImageWriter,
    progress: &Progress,
) -> Result<Targets, String> {
    let (mut result, mut program) = (Targets::default(), FindTarget::new());
    for seed in 1..=seeds {
        progress.step("targets", seed, seeds);
        let (arena, mut random) = (Arena::new(seed), Random::new(seed));
        for (row, distance) in DISTANCES.into_iter().enumerate() {
            let station = arena.stations().nth(random.bits() as usize % 8);
            let found = station.and_then(|s| Some((s, places::before(&arena, s, distance, SLANT, &mut random)?)));
            let Some((station, robot)) = found else { continue };
            let light = hall_light(&mut random);
            for (column, turn) in TURNS.into_iter().enumerate() {
                let view = sensors.see(&arena, &robot, turn, &light, &mut random);
                let image = (seed == 1).then(|| view.image.clone());
                let start = Instant::now();
                let (target, pose) = locate(&mut program, view);
                result.times.push(start.elapsed());
                result.cells[row][column].count(&station.pose.relative_to(&robot), pose);
                if let Some(image) = image {
                    let name = format!("target-{distance:.1}m-{turn:.0}rad-per-s");
                    image_writer.add(&name, &image, target.map(|t| t.region).as_ref())?;
                }
            }
        }
    }
    Ok(result)
}

/// Target in a view, in the image and in the frame of the robot.
fn locate(program: &mut FindTarget, view: crate::world::View) -> (Option<Target>, Option<Pose2>) {
    let inputs = program.inputs();
    // The inputs are free: each frame is taken at once.
    let _ = (inputs.image.put(view.image), inputs.camera.put(camera()), inputs.scan.put(view.scan));
    program.react(Time::ZERO);
    let outputs = program.outputs();
    (outputs.target, outputs.pose)
}

impl Cell {
    fn count(&mut self, truth: &Pose2, found: Option<Pose2>) {
        self.frames += 1;
        let Some(error) = found.map(|pose| pose.relative_to(truth)) else { return };
        if error.position().norm() > NEAR {
            self.elsewhere += 1;
            return;
        }
        self.places.push(error.position().norm());
        self.angles.push(error.theta.abs());
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:>3}/{:<3}{:>5}", self.places.len(), self.frames, self.elsewhere)?;
        let parts = [(&self.places, 1e3), (&self.angles, 1.0_f32.to_degrees())];
        for (values, scale) in parts {
            match percentile(values, 0.5).zip(percentile(values, 0.9)) {
                Some((median, most)) => write!(f, "{:>7.1}{:>7.1}", scale * median, scale * most)?,
                None => write!(f, "{:>7}{:>7}", "–", "–")?,
            }
        }
        Ok(())
    }
}

impl fmt::Display for Targets {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Targets: found, found elsewhere, error of the place (mm) and of the angle (°): median and 90 %")?;
        write!(f, "{:<8}", "")?;
        TURNS.iter().try_for_each(|turn| write!(f, "| {:<39}", format!("turning at {turn:.0} rad/s")))?;
        write!(f, "\n{:<8}", "m")?;
        for _ in TURNS {
            write!(f, "| {:<7}{:>5}{:>7}{:>7}{:>7}{:>7} ", "found", "else", "mm", "90 %", "°", "90 %")?;
        }
        for (distance, cells) in DISTANCES.iter().zip(&self.cells) {
            write!(f, "\n{distance:<8.1}")?;
            cells.iter().try_for_each(|cell| write!(f, "| {cell} "))?;
        }
        write!(f, "\nFindTarget takes {}", self.times)
    }
}
