use crate::walks::Frame;
use apex_nodes::{
    math::Random,
    persons::{Detections, Sensor, View},
    scan::Point2,
};

/// Share of the persons that are detected, and share of false detections among all (thesis table 6.4, HOG with SVM).
const RATE: f32 = 0.78;
const FALSE_SHARE: f32 = 0.22;

/// Standard deviation of detected positions along each axis, in m.
const DEVIATION: f32 = 0.1;

/// Detections over time, and the sensor that made them.
pub struct Observed {
    pub sensor: Sensor,
    pub detections: Vec<Detections>,
}

/// Makes detections from annotations: some persons are missed, and false detections are spread evenly over the area.
pub fn observe(frames: &[Frame], seed: u64) -> Observed {
    let mut random = Random::new(seed);
    let all = || frames.iter().flat_map(|frame| frame.persons.iter().map(|(_, position)| *position));
    let (mut min, mut max) = (Point2::new(f32::MAX, f32::MAX), Point2::new(f32::MIN, f32::MIN));
    for p in all() {
        (min.x, min.y, max.x, max.y) = (min.x.min(p.x), min.y.min(p.y), max.x.max(p.x), max.y.max(p.y));
    }
    let annotated = frames.iter().filter(|frame| !frame.persons.is_empty()).count();
    // As many that 22 % of all detections are false: RATE · n · FALSE_SHARE / (1 − FALSE_SHARE).
    let mean = all().count() as f32 / annotated.max(1) as f32 * RATE * FALSE_SHARE / (1.0 - FALSE_SHARE);
    let area = ((max.x - min.x) * (max.y - min.y)).max(1.0);
    let detections = frames.iter().map(|frame| {
        let mut positions: Vec<Point2> = Vec::new();
        for (_, position) in &frame.persons {
            if random.chance(RATE) {
                positions.push(*position + Point2::new(random.normal(DEVIATION), random.normal(DEVIATION)));
            }
        }
        for _ in 0..poisson(mean, &mut random) {
            positions.push(Point2::new(random.uniform(min.x, max.x), random.uniform(min.y, max.y)));
        }
        for i in (1..positions.len()).rev() {
            positions.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
        Detections { stamp: frame.time, view: View::default(), positions: positions.into_iter().take(64).collect() }
    });
    Observed {
        detections: detections.collect(),
        sensor: Sensor { deviation: DEVIATION, rate: RATE, clutter: mean / area },
    }
}

/// Random number of the Poisson distribution (Knuth).
fn poisson(mean: f32, random: &mut Random) -> usize {
    let limit = (-f64::from(mean)).exp();
    let (mut count, mut product) = (0, random.unit());
    while product > limit {
        count += 1;
        product *= random.unit();
    }
    count
}
