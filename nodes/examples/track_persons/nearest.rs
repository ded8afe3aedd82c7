use apex_nodes::{
    persons::{Detections, Motion, Sensor},
    scan::Point2,
};
use apex_rt::Time;

/// Tracker that updates the nearest person with each detection: what many hypotheses are compared with. Motions are
/// estimated by the same Kalman filter.
pub struct Nearest {
    pub acceleration: f32,
    pub speed: f32,
    /// Maximum Mahalanobis distance of a detection from its person.
    pub gate: f32,
    /// Detections until a person is reported.
    pub hits: u32,
    /// Consecutive missed detections up to which a person is reported.
    pub shown: u32,
    /// Consecutive missed detections up to which a person is kept.
    pub kept: u32,
    persons: Vec<Tracked>,
    next: u32,
    stamp: Time,
}

struct Tracked {
    id: u32,
    motion: Motion,
    hits: u32,
    misses: u32,
}

impl Nearest {
    /// Creates a tracker from: acceleration, speed, gate, hits, shown and kept.
    pub fn new(setting: &[f32]) -> Self {
        let count = |at: usize| setting[at] as u32;
        Self {
            acceleration: setting[0],
            speed: setting[1],
            gate: setting[2],
            hits: count(3),
            shown: count(4),
            kept: count(5),
            persons: Vec::new(),
            next: 0,
            stamp: Time::ZERO,
        }
    }

    pub fn update(&mut self, detections: &Detections, sensor: &Sensor) {
        let seconds = detections.stamp.since(self.stamp).as_secs_f32();
        self.stamp = detections.stamp;
        for person in &mut self.persons {
            person.motion = person.motion.after(seconds, self.acceleration);
            person.misses += 1;
        }
        let mut pairs: Vec<(f32, usize, usize)> = Vec::new();
        for (i, person) in self.persons.iter().enumerate() {
            for (j, position) in detections.positions.iter().enumerate() {
                let (squared, _) = person.motion.likelihood(*position, sensor.deviation);
                if squared <= self.gate * self.gate {
                    pairs.push((squared, i, j));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut used = vec![false; detections.positions.len()];
        for (_, i, j) in pairs {
            let person = &mut self.persons[i];
            if person.misses > 0 && !used[j] {
                used[j] = true;
                person.misses = 0;
                person.hits += 1;
                person.motion = person.motion.measured(detections.positions[j], sensor.deviation);
            }
        }
        self.persons.retain(|person| person.misses <= self.kept);
        for (position, _) in detections.positions.iter().zip(&used).filter(|(_, used)| !**used) {
            self.next += 1;
            let motion = Motion::begin(*position, sensor.deviation, self.speed);
            self.persons.push(Tracked { id: self.next, motion, hits: 1, misses: 0 });
        }
    }

    pub fn persons(&self) -> impl Iterator<Item = (u32, Point2)> + '_ {
        let reported = self.persons.iter().filter(|p| p.hits >= self.hits && p.misses <= self.shown);
        reported.map(|p| (p.id, p.motion.position))
    }
}
