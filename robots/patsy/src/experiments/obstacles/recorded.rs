use super::{Plane, Scores};
use crate::{Detector, Weights};
use apex_nodes::{
    cloud::{Label, PointCloud},
    io::{RecordedCloud, read_cloud},
};
use apex_sim::Random;
use core::fmt;
use std::path::{Path, PathBuf};

/// Cloud in a frame at its camera whose x and y axes are level.
#[derive(Debug, Clone)]
pub struct Levelled {
    /// The cloud.
    pub cloud: PointCloud,
    /// Floor in the frame of the camera.
    pub plane: Plane,
}

/// Turns a recorded cloud into a level frame, x forward and z up, by the plane of its floor.
///
/// The camera may be upright in an optical frame (z forward, y down) or in that of a robot: forward is the axis on
/// which the points lie farther ahead.
///
/// # Errors
/// If the cloud has no measured points, or no plane that may be a floor.
pub fn level(cloud: &PointCloud) -> Result<Levelled, String> {
    let mut cloud = cloud.clone();
    let measured = cloud.points().iter().filter(|p| p.is_measured());
    let (count, sums) = measured.fold((0, [0.0; 2]), |(n, [x, z]), p| (n + 1, [x + p.x, z + p.z]));
    if count == 0 {
        return Err("no pixel of the cloud has a measurement".to_owned());
    }
    if sums[1].abs() > sums[0].abs() {
        cloud.points_mut().iter_mut().for_each(|p| (p.x, p.y, p.z) = (p.z, -p.x, -p.y));
    }
    let plane = Plane::find(&cloud, &mut Random::new(1)).ok_or("the cloud has no plane that may be a floor")?;
    let up = plane.normal.map(|n| n as f32);
    let length = libm::sqrtf(1.0 - up[0] * up[0]);
    let forward = [length, -up[0] * up[1] / length, -up[0] * up[2] / length];
    let left = [0.0, up[2] / length, -up[1] / length];
    for p in cloud.points_mut() {
        let along = |axis: [f32; 3]| axis[0] * p.x + axis[1] * p.y + axis[2] * p.z;
        (p.x, p.y, p.z) = (along(forward), along(left), along(up));
    }
    Ok(Levelled { cloud, plane })
}

/// Results on recorded clouds.
#[derive(Debug, Clone, Default)]
pub struct RecordedTable {
    rows: Vec<Row>,
}

#[derive(Debug, Clone)]
struct Row {
    path: PathBuf,
    measured: usize,
    artefacts: usize,
    obstacles: usize,
    /// Areas of the plane, the weights of the thesis, the graph, and weights chosen on the other files.
    areas: Option<[Option<f64>; 4]>,
}

/// Labels of the recordings: the table or floor, and objects. 0 is not labelled.
const FLOOR: core::ops::RangeInclusive<u32> = 1..=9;
const FIRST_OBJECT: u32 = 20;

/// Recorded cloud with what is needed to detect obstacles in it.
struct Recording {
    path: PathBuf,
    recorded: RecordedCloud,
    levelled: Levelled,
}

impl RecordedTable {
    /// Reads the files and detects obstacles in them. If several have labels, the weights of depth, intensity and
    /// elevation are also chosen for each of them by the areas of all others.
    ///
    /// # Errors
    /// If a file cannot be read, or if nothing can be detected in it.
    pub fn read(paths: &[PathBuf]) -> Result<Self, String> {
        let recordings = paths.iter().map(|path| Recording::open(path)).collect::<Result<Vec<_>, _>>()?;
        let mut detector = Detector::default();
        let graph = detector.weights()?;
        let candidates = candidates(&graph);
        let labelled: Vec<&Recording> = recordings.iter().filter(|r| r.recorded.labels.is_some()).collect();
        // Area of each labelled file with each candidate.
        let mut areas = vec![];
        for recording in &labelled {
            let of = candidates.iter().map(|weights| recording.auc(&mut detector, weights));
            areas.push(of.collect::<Result<Vec<_>, _>>()?);
        }
        let mut rows = vec![];
        for recording in &recordings {
            let at = labelled.iter().position(|other| core::ptr::eq(*other, recording));
            let chosen = at.and_then(|at| best_of_others(&areas, at)).map(|best| candidates[best]);
            rows.push(recording.row(&mut detector, &graph, chosen.as_ref())?);
        }
        Ok(Self { rows })
    }

    /// Areas under the curves for each labelled file: of the plane, of the weights of the thesis, of those of the
    /// graph, and of weights that were chosen on the other files.
    pub fn areas(&self) -> impl Iterator<Item = [Option<f64>; 4]> + '_ {
        self.rows.iter().filter_map(|row| row.areas)
    }
}

/// Size of the cloud of a file, and the labels of its points with the weights of the graph, row by row.
///
/// # Errors
/// If the file cannot be read, or if nothing can be detected in it.
pub fn recorded_labels(path: &Path) -> Result<((usize, usize), Vec<Label>), String> {
    let (recording, mut detector) = (Recording::open(path)?, Detector::default());
    let weights = detector.weights()?;
    let (labels, _) = recording.detect(&mut detector, &weights)?;
    Ok((recording.levelled.cloud.size(), labels))
}

/// Weights to choose from: parts of those of depth and intensity, with a bent and with a plane floor.
fn candidates(graph: &Weights) -> Vec<Weights> {
    const PARTS: [f32; 4] = [0.0, 0.1, 0.3, 1.0];
    let pairs = PARTS.iter().flat_map(|alpha| PARTS.map(|beta| (*alpha, beta)));
    let all = pairs.flat_map(|(a, b)| [graph.bend, 0.0].map(|bend| (a, b, bend)));
    all.map(|(a, b, bend)| Weights { alpha: a * graph.alpha, beta: b * graph.beta, bend, ..*graph }).collect()
}

/// Candidate with the greatest sum of areas over all files but one.
fn best_of_others(areas: &[Vec<f64>], left_out: usize) -> Option<usize> {
    let others = || areas.iter().enumerate().filter(|(file, _)| *file != left_out).map(|(_, areas)| areas);
    let sum = |candidate: usize| others().map(|areas| areas[candidate]).sum::<f64>();
    let count = others().next()?.len();
    (0..count).max_by(|a, b| sum(*a).total_cmp(&sum(*b)))
}

impl Recording {
    fn open(path: &Path) -> Result<Self, String> {
        let recorded = read_cloud(path).map_err(|e| e.to_string())?;
        if !recorded.is_organised() {
            let why = "the cloud is not organised: its height is 1, but the rows of a depth image are needed";
            return Err(format!("{}: {why}", path.display()));
        }
        let levelled = level(&recorded.cloud).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Self { path: path.to_owned(), recorded, levelled })
    }

    /// Labels and probabilities with these weights, row by row.
    fn detect(&self, detector: &mut Detector, weights: &Weights) -> Result<(Vec<Label>, Vec<f32>), String> {
        detector.set(weights)?;
        detector.set_param("prepare.mount.z", self.levelled.plane.height as f32)?;
        detector.set_param("prepare.mount.pitch", 0.0)?;
        // The maximum intensity of the sensor is not known.
        detector.set_param("prepare.bright.max_intensity", 1e9)?;
        let found = detector.detect(&self.levelled.cloud);
        let (_, labels, probabilities) = found.ok_or("the graph has not sent labels")?;
        let (width, height) = self.levelled.cloud.size();
        let order = || (0..width * height).map(|i| i % width * height + i / width);
        Ok((order().map(|i| labels.labels[i]).collect(), order().map(|i| probabilities[i]).collect()))
    }

    fn scores(&self, score: impl Fn(usize) -> f32) -> Scores {
        let mut scores = Scores::default();
        let labels = self.recorded.labels.iter().flatten();
        for (i, (label, point)) in labels.zip(self.levelled.cloud.points()).enumerate() {
            if point.is_measured() && (FLOOR.contains(label) || *label >= FIRST_OBJECT) {
                scores.push(*label >= FIRST_OBJECT, score(i));
            }
        }
        scores
    }

    fn auc(&self, detector: &mut Detector, weights: &Weights) -> Result<f64, String> {
        let (_, probabilities) = self.detect(detector, weights)?;
        Ok(self.scores(|i| probabilities[i]).auc().unwrap_or_default())
    }

    fn row(&self, detector: &mut Detector, graph: &Weights, chosen: Option<&Weights>) -> Result<Row, String> {
        let (labels, probabilities) = self.detect(detector, graph)?;
        let mut areas = None;
        if self.recorded.labels.is_some() {
            let height = self.levelled.plane.height as f32;
            let plane = self.scores(|i| self.levelled.cloud.points()[i].z + height).auc();
            let of_graph = self.scores(|i| probabilities[i]).auc();
            let thesis = self.auc(detector, &Weights::THESIS)?;
            let chosen = chosen.map(|weights| self.auc(detector, weights)).transpose()?;
            areas = Some([plane, Some(thesis), of_graph, chosen]);
        }
        let count = |is: fn(&Label) -> bool| labels.iter().filter(|label| is(label)).count();
        Ok(Row {
            path: self.path.clone(),
            measured: count(|label| *label != Label::Missing),
            artefacts: count(|label| *label == Label::Artefact),
            obstacles: count(|label| label.is_hazard()),
            areas,
        })
    }
}

impl fmt::Display for RecordedTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |row: &Row| row.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let width = self.rows.iter().map(|row| name(row).len()).max().unwrap_or_default().max(4) + 2;
        write!(f, "{:<width$}{:>9}{:>11}{:>11}", "file", "points", "artefacts", "obstacles")?;
        write!(f, "{:>12}{:>9}{:>15}{:>22}", "AUC: plane", "thesis", "obstacles.afg", "chosen on the others")?;
        for row in &self.rows {
            write!(f, "\n{:<width$}{:>9}{:>11}{:>11}", name(row), row.measured, row.artefacts, row.obstacles)?;
            for (area, width) in row.areas.iter().flatten().zip([12, 9, 15, 22]) {
                match area {
                    Some(area) => write!(f, "{area:>width$.5}")?,
                    None => write!(f, "{:>width$}", "–")?,
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::cloud::CloudPoint;
    use apex_rt::Time;

    /// A cloud of these points, one row per point.
    fn column(points: &[[f32; 3]]) -> PointCloud {
        let mut cloud = PointCloud::default();
        cloud.reset(Time::ZERO, (1, points.len()));
        for (point, [x, y, z]) in cloud.points_mut().iter_mut().zip(points) {
            *point = CloudPoint { x: *x, y: *y, z: *z, intensity: 0.0 };
        }
        cloud
    }

    #[test]
    fn both_kinds_of_frames_are_levelled() {
        // A floor 0.5 m below a camera that looks down by 0.4 rad.
        let (sin, cos) = 0.4_f32.sin_cos();
        let floor: Vec<[f32; 2]> = (0..900).map(|i| [0.5 + 0.05 * (i / 30) as f32, 0.05 * (i % 30) as f32]).collect();
        let robot: Vec<[f32; 3]> = floor.iter().map(|[x, y]| [x * cos + 0.5 * sin, *y, x * sin - 0.5 * cos]).collect();
        let optical: Vec<[f32; 3]> = robot.iter().map(|[x, y, z]| [-y, -z, *x]).collect();
        for points in [robot, optical] {
            let levelled = level(&column(&points)).expect("a floor");
            assert!((levelled.plane.height - 0.5).abs() < 1e-4);
            for (point, [x, y]) in levelled.cloud.points().iter().zip(&floor) {
                assert!((point.x - x).abs() < 1e-4 && (point.y - y).abs() < 1e-4 && (point.z + 0.5).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn clouds_without_a_floor_are_errors() {
        let error = level(&column(&[[f32::NAN; 3]; 5])).expect_err("nothing");
        assert_eq!(error, "no pixel of the cloud has a measurement");
        let error = level(&column(&[[1.0, 2.0, 3.0]; 5])).expect_err("a point");
        assert_eq!(error, "the cloud has no plane that may be a floor");
        assert!(level(&PointCloud::default()).is_err());
    }

    #[test]
    fn weights_are_chosen_without_the_file_that_they_are_for() {
        let areas = [vec![0.9, 0.1], vec![0.2, 0.8], vec![0.3, 0.4]];
        assert_eq!([0, 1, 2].map(|file| best_of_others(&areas, file)), [Some(1), Some(0), Some(0)]);
        assert_eq!(best_of_others(&areas[..1], 0), None);
    }
}
