use crate::{nearest::Nearest, noise::Observed};
use apex_nodes::{
    persons::{Hypotheses, Model, Persons},
    scan::Point2,
};

/// Number and position of a tracked person.
pub type Track = (u32, Point2);

/// Values to choose from for [`with_hypotheses`]: acceleration, speed, births, stay, confirm, presence, gate, depth.
pub const CHOICES: [&[f32]; 8] = [
    &[0.2, 0.3, 0.5],
    &[0.8, 1.2, 1.6],
    &[0.0003, 0.001, 0.003],
    &[3.0, 5.0, 10.0, 20.0],
    &[2.0, 3.0, 4.0, 5.0, 6.0],
    &[0.3, 0.4, 0.5, 0.6],
    &[3.0, 3.5, 4.0],
    &[1.0, 2.0, 3.0, 5.0, 8.0],
];

/// Values to choose from for [`nearest`]: acceleration, speed, gate, hits, shown, kept.
pub const NEAREST_CHOICES: [&[f32]; 6] = [
    &[0.2, 0.3, 0.5],
    &[0.8, 1.2, 1.6],
    &[2.0, 2.5, 3.0, 3.5, 4.0, 5.0],
    &[1.0, 2.0, 3.0, 4.0],
    &[0.0, 1.0, 2.0, 3.0],
    &[1.0, 2.0, 3.0, 4.0, 6.0],
];

/// Tracks of the library, after each measurement.
pub fn with_hypotheses(setting: &[f32], observed: &Observed) -> Vec<Vec<Track>> {
    let model = Model {
        acceleration: setting[0],
        speed: setting[1],
        births: setting[2],
        stay: setting[3],
        forget: 3.0,
        gate: setting[6],
        margin: 8.0,
        branches: 8,
        depth: setting[7] as usize,
    };
    let mut hypotheses = Hypotheses::default();
    let mut persons = Persons::new();
    let track = |detections| {
        hypotheses.update(detections, &observed.sensor, &model);
        hypotheses.persons(hypotheses.stamp(), &model, setting[4], setting[5], &mut persons);
        persons.iter().map(|person| (person.id, person.position)).collect()
    };
    observed.detections.iter().map(track).collect()
}

/// Tracks of the nearest-neighbour tracker, after each measurement.
pub fn nearest(setting: &[f32], observed: &Observed) -> Vec<Vec<Track>> {
    let mut tracker = Nearest::new(setting);
    let track = |detections| {
        tracker.update(detections, &observed.sensor);
        tracker.persons().collect()
    };
    observed.detections.iter().map(track).collect()
}
