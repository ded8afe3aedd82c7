use super::{Confusion, ImageWriter, Times};
use crate::{
    programs::{CubeByDeviation, CubeByNetwork, CubeNumber},
    world::Hopper,
};
use apex_nodes::image::GrayImage;
use apex_rt::Time;
use apex_sim::{Random, experiment::Progress};
use std::{fmt, time::Instant};

/// Number of images per kind of hopper and seed. Every second one has a cube.
const IMAGES: u32 = 20;

/// Results of the detection and reading of cubes (thesis 4.4.3, table 4.1).
#[derive(Debug, Clone)]
pub struct Cubes {
    deviation: Confusion<2>,
    network: Confusion<2>,
    /// Bar codes read correctly, wrongly and not at all, for cubes that lie flat and for wedged ones.
    codes: [[u32; 3]; 2],
    /// Number of bar codes read where there is no cube.
    ghosts: u32,
    times: [Times; 3],
}

/// The three graphs of the hopper.
struct Programs {
    deviation: CubeByDeviation,
    network: CubeByNetwork,
    number: CubeNumber,
}

/// Evaluates the detection by deviation on hoppers without a pattern, and the network and the bar code reader on
/// hoppers with one.
///
/// # Errors
/// If an image cannot be written.
/// A picture cannot be written.
pub fn cubes(seeds: u64, image_writer: &ImageWriter, progress: &Progress) -> Result<Cubes, String> {
    let empty = Confusion::new(["empty", "full"]);
    let (deviation, network) = (empty.clone(), empty);
    let mut result = Cubes { deviation, network, codes: Default::default(), ghosts: 0, times: Default::default() };
    let mut programs =
        Programs { deviation: CubeByDeviation::new(), network: CubeByNetwork::new(), number: CubeNumber::new() };
    for seed in 1..=seeds {
        progress.step("cubes", seed, seeds);
        let mut random = Random::new(seed);
        for i in 0..IMAGES {
            let full = i % 2 == 1;
            let plain = Hopper::random(false, full, &mut random).photo(&mut random);
            let hopper = Hopper::random(true, full, &mut random);
            let patterned = hopper.photo(&mut random);
            if seed == 1 {
                image_writer.add(&format!("hopper-{i:02}-plain"), &plain, None)?;
                image_writer.add(&format!("hopper-{i:02}-pattern"), &patterned, None)?;
            }
            result.look(&mut programs, full, plain, &hopper, patterned);
        }
    }
    Ok(result)
}

impl Cubes {
    fn look(&mut self, programs: &mut Programs, full: bool, plain: GrayImage, hopper: &Hopper, patterned: GrayImage) {
        let Programs { deviation, network, number } = programs;
        let code = patterned.clone();
        // The inputs are free: each frame is taken at once.
        let (start, _) = (Instant::now(), deviation.inputs().image.put(plain));
        deviation.react(Time::ZERO);
        self.times[0].push(start.elapsed());
        self.deviation.count(usize::from(full), usize::from(deviation.outputs().full == Some(true)));

        let (start, _) = (Instant::now(), network.inputs().image.put(patterned));
        network.react(Time::ZERO);
        self.times[1].push(start.elapsed());
        self.network.count(usize::from(full), usize::from(network.outputs().full == Some(true)));

        let (start, _) = (Instant::now(), number.inputs().image.put(code));
        number.react(Time::ZERO);
        let time = start.elapsed();
        let read = number.outputs().number;
        match hopper.cube {
            Some(cube) => {
                // Only with a cube: without one there is hardly any work.
                self.times[2].push(time);
                let outcome = read.map_or(2, |number| usize::from(number != cube.number));
                self.codes[usize::from(cube.lean > 0.0)][outcome] += 1;
            }
            None => self.ghosts += u32::from(read.is_some()),
        }
    }
}

impl fmt::Display for Cubes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [deviation, network, number] = &self.times;
        writeln!(f, "Cubes by the deviation of the intensities, without a pattern (table 4.1)\n{}", self.deviation)?;
        writeln!(f, "CubeByDeviation takes {deviation}\n")?;
        writeln!(f, "Cubes by the network, with the pattern (table 4.1)\n{}", self.network)?;
        writeln!(f, "CubeByNetwork takes {network}\n")?;
        writeln!(f, "Bar codes\n{:<16}{:>8}{:>8}{:>10}", "", "right", "wrong", "not read")?;
        for (name, [right, wrong, unread]) in ["cube lies flat", "cube is wedged"].iter().zip(&self.codes) {
            writeln!(f, "{name:<16}{right:>8}{wrong:>8}{unread:>10}")?;
        }
        writeln!(f, "read without a cube: {}", self.ghosts)?;
        write!(f, "CubeNumber takes {number}")
    }
}
