use super::{Confusion, ImageWriter, Times, places};
use crate::{
    NumberSign, camera,
    programs::FindSign,
    world::{Arena, Sensors, View, hall_light},
};
use apex_nodes::scan::Pose2;
use apex_rt::Time;
use apex_sim::{Random, experiment::Progress};
use std::{fmt, time::Instant};

/// Distances of the camera from the sign, in m.
const DISTANCES: [f32; 6] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];

/// Maximum angle of the camera from straight ahead of the sign, in rad.
const SLANT: f32 = 0.7;

/// Class of images without a sign.
const NONE: usize = 4;

/// Results of reading number signs.
#[derive(Debug, Clone)]
pub struct Signs {
    all: Confusion<5>,
    by_distance: [Confusion<5>; DISTANCES.len()],
    times: Times,
}

/// Evaluates each sign at each distance, and as many places without a sign, for each seed.
///
/// # Errors
/// If an image cannot be written.
pub fn signs(
    seeds: u64,
    sensors: &mut Sensors,
    image_writer: &ImageWriter,
    progress: &Progress,
) -> Result<Signs, String> {
    let empty = Confusion::new(["1", "2", "3", "4", "none"]);
    let by_distance = std::array::from_fn(|_| empty.clone());
    let (mut result, mut program) = (Signs { all: empty, by_distance, times: Times::default() }, FindSign::new());
    for seed in 1..=seeds {
        progress.step("signs", seed, seeds);
        let (arena, mut random) = (Arena::new(seed), Random::new(seed));
        for (row, distance) in DISTANCES.into_iter().enumerate() {
            for actual in 0..=NONE {
                let Some(robot) = place(&arena, actual, distance, &mut random) else { continue };
                let light = hall_light(&mut random);
                let view = sensors.see(&arena, &robot, 0.0, &light, &mut random);
                let image = (seed == 1).then(|| view.image.clone());
                let start = Instant::now();
                let sign = read(&mut program, view);
                result.times.push(start.elapsed());
                let found = sign.map_or(NONE, |sign| sign.number as usize - 1);
                result.all.count(actual, found);
                result.by_distance[row].count(actual, found);
                if let Some(image) = image {
                    let name = |class: usize| if class == NONE { "none".to_owned() } else { (class + 1).to_string() };
                    let name = format!("sign-{distance:.0}m-{}-read-{}", name(actual), name(found));
                    image_writer.add(&name, &image, sign.map(|s| s.region).as_ref())?;
                }
            }
        }
    }
    Ok(result)
}

/// A pose from which this sign is visible and no other one.
fn place(arena: &Arena, class: usize, distance: f32, random: &mut Random) -> Option<Pose2> {
    let expected = (class < NONE).then_some(class as u32 + 1);
    (0..100).find_map(|_| {
        let pose = match arena.delivery.get(class) {
            Some(station) => places::before(arena, station, distance, SLANT, random),
            None => places::anywhere(arena, random),
        };
        pose.filter(|pose| places::numbers_in_view(arena, pose).eq(expected))
    })
}

/// Sign in a view.
fn read(program: &mut FindSign, view: View) -> Option<NumberSign> {
    let inputs = program.inputs();
    // The inputs are free: each frame is taken at once.
    let _ = (inputs.image.put(view.image), inputs.camera.put(camera()), inputs.scan.put(view.scan));
    program.react(Time::ZERO);
    program.outputs().sign
}

impl fmt::Display for Signs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Number signs from 1 to 6 m\n{}", self.all)?;
        write!(f, "{:<8}{:>8}{:>8}{:>8}{:>14}", "m", "right", "wrong", "missed", "false alarms")?;
        for (distance, table) in DISTANCES.iter().zip(&self.by_distance) {
            let sum = |cells: &dyn Fn(usize, usize) -> bool| -> u32 {
                let all = (0..=NONE).flat_map(|a| (0..=NONE).map(move |b| (a, b)));
                all.filter(|(a, b)| cells(*a, *b)).map(|(a, b)| table.get(a, b)).sum()
            };
            let right = sum(&|a, b| a == b && a != NONE);
            let wrong = sum(&|a, b| a != b && a != NONE && b != NONE);
            let (missed, alarms) = (sum(&|a, b| a != NONE && b == NONE), sum(&|a, b| a == NONE && b != NONE));
            write!(f, "\n{distance:<8.0}{right:>8}{wrong:>8}{missed:>8}{alarms:>14}")?;
        }
        write!(f, "\nFindSign takes {}", self.times)
    }
}
