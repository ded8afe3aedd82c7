//! Report of a run: a table, pictures, and a live view.

mod activity;
mod canvas;
mod film;
mod frame;
mod live;
mod map;
mod table;

pub use film::Film;
pub use frame::{Frame, Mark};
pub use live::{LiveView, Snapshot};

use crate::{
    experiments::{KnowledgeLog, measure::ImageWriter},
    world::{
        Arena,
        contest::{Hall, Report},
    },
};
use apex_nodes::{
    map::{Grid, Occupancy, Octagon, Signs, Station},
    scan::{Point2, Pose2},
};
use apex_rt::Time;

/// Report of a run.
#[derive(Debug, Clone)]
pub struct RunReport {
    /// Seed of the run.
    pub seed: u64,
    /// True arena.
    pub arena: Arena,
    /// Start pose of the robot. Its knowledge is in the frame of its odometry, which begins there.
    pub start: Pose2,
    /// Last map of the robot.
    pub map: Option<Grid<Occupancy>>,
    /// Detected island.
    pub octagon: Option<Octagon>,
    /// Detected filling stations.
    pub stations: Vec<Station>,
    /// Detected signs.
    pub signs: Signs,
    /// Active phases of the mission.
    pub phases: Vec<Phase>,
    /// Report of the referee.
    pub report: Report,
    /// Camera images with detections.
    pub frames: Vec<Frame>,
}

/// Time in which a part of the mission was active. Several phases may overlap.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Phase {
    /// Name of the part, after those around it: `fetch / position`.
    pub name: String,
    /// Time of activation.
    pub from: Time,
    /// Time of deactivation.
    pub until: Time,
}

impl RunReport {
    /// Creates the report of a finished run in the hall of a seed.
    pub fn of(seed: u64, hall: &Hall, start: Pose2, knowledge_log: &KnowledgeLog, phases: Vec<Phase>) -> Self {
        Self {
            seed,
            arena: hall.arena(),
            start,
            map: knowledge_log.last_map().cloned(),
            octagon: knowledge_log.last_island(),
            stations: knowledge_log.last_stations().to_vec(),
            signs: knowledge_log.last_signs().clone(),
            phases,
            report: hall.report(),
            frames: knowledge_log.frames(),
        }
    }

    /// Writes the pictures: `map`, `activity`, and `frame-01` and so on.
    ///
    /// # Errors
    /// If a picture cannot be written.
    pub fn write(&self, image_writer: &ImageWriter) -> Result<(), String> {
        image_writer.save("map", &self.draw_map())?;
        image_writer.save("activity", &self.draw_activity())?;
        let mut frames = self.frames.iter().zip(1..);
        frames.try_for_each(|(frame, number)| image_writer.save(&format!("frame-{number:02}"), &frame.draw()))
    }

    /// Time of the last event, in s.
    fn end(&self) -> f32 {
        let driven = self.report.trajectory.last().map(|(time, _)| *time);
        let phases = self.phases.iter().map(|phase| phase.until);
        let all = self.report.deliveries.iter().map(|delivery| delivery.at).chain(phases).chain(driven);
        all.max().map_or(0.0, seconds)
    }

    /// Names of the phases, in the order of their first activation.
    fn phase_names(&self) -> Vec<&str> {
        let mut phases: Vec<&Phase> = self.phases.iter().collect();
        phases.sort_by_key(|phase| phase.from);
        let mut names = vec![];
        for phase in phases {
            if !names.contains(&phase.name.as_str()) {
                names.push(&phase.name);
            }
        }
        names
    }

    /// Position of the robot at a time.
    fn place(&self, time: Time) -> Option<Point2> {
        let after = self.report.trajectory.partition_point(|(t, _)| *t < time);
        let nearest = self.report.trajectory.get(after).or(self.report.trajectory.last());
        nearest.map(|(_, pose)| pose.position())
    }
}

/// Time in s.
fn seconds(time: Time) -> f32 {
    time.as_secs_f64() as f32
}

/// Seconds as minutes and seconds: `7:03`.
fn clock(seconds: f32) -> String {
    let whole = seconds as u32;
    format!("{}:{:02}", whole / 60, whole % 60)
}

/// Text shortened to `most` characters.
fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(2)).chain("..".chars()).collect()
}

#[cfg(test)]
mod tests;
