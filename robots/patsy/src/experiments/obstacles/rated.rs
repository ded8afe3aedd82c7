use super::Scores;
use crate::world::labelled_scene;
use apex_nodes::{
    cloud::{Label, Labels, PointCloud, Probabilities},
    scan::Pose2,
};
use apex_rt::{Out, Outputs, node};
use apex_sim::tof::{TofFrame, Truth};

/// Seed of the first scene on which weights are chosen. Those of the measurements in the documentation are smaller.
const FIRST: u64 = 1001;

/// Time-of-flight camera in scenes whose points are labelled, in another one at each firing: a source, which is silent
/// after the last scene.
#[node]
#[derive(Debug)]
pub struct SceneTof {
    /// Number of scenes.
    #[param(default = 24, range = 1..=100_000)]
    scenes: u64,
    /// Number of the set of scenes. No scene is in two sets of the same size.
    #[param(default = 0, range = 0..=1_000_000_000)]
    seed: u64,
    /// Number of scenes so far.
    taken: u64,
    frame: TofFrame,
}

#[node]
impl SceneTof {
    /// Sends the cloud, the pose of the robot, and the true class of each pixel in the order of the cloud.
    fn process(&mut self, cloud: &mut Out<PointCloud>, pose: &mut Out<Pose2>, truth: &mut Out<Vec<Truth>>) {
        if self.taken >= self.scenes {
            return;
        }
        self.frame = labelled_scene(FIRST + self.seed * self.scenes + self.taken).take();
        self.taken += 1;
        cloud.get_mut().clone_from(&self.frame.cloud);
        truth.get_mut().clone_from(&self.frame.truth);
        pose.set(Pose2::default());
    }
}

/// Rates the detection of obstacles over all points of some scenes, after the last one.
#[node]
#[derive(Debug)]
pub struct RateDetection {
    /// Number of scenes.
    #[param(default = 24, range = 1..=100_000)]
    scenes: u64,
    /// Number of scenes so far.
    seen: u64,
    /// Scores of all obstacles and all other points.
    all: Scores,
    /// Scores of small obstacles and of the floor.
    small: Scores,
    /// Numbers of points of small obstacles and of the floor that are labelled as hazards.
    hazards: [usize; 2],
}

/// Rating of a detection.
#[derive(Debug, Clone, Copy, PartialEq, Outputs)]
pub struct Rating {
    /// Mean of the areas under the ROC curves of all obstacles against all other points, and of small obstacles against
    /// the floor.
    pub area: Option<f64>,
    /// Share of the points of small obstacles that are labelled as hazards.
    pub small: Option<f64>,
    /// Share of the points of the floor that are labelled as hazards.
    pub floor: Option<f64>,
}

#[node]
impl RateDetection {
    fn process(&mut self, truth: &Vec<Truth>, labels: &Labels, probabilities: &Probabilities) -> Rating {
        each_measured(truth, labels, probabilities, |truth, label, probability| {
            if truth != Truth::Unlabelled {
                self.all.push(!matches!(truth, Truth::Floor | Truth::Artefact), probability);
            }
            if let Some(class) = [Truth::Small, Truth::Floor].iter().position(|class| *class == truth) {
                self.small.push(class == 0, probability);
                self.hazards[class] += usize::from(label.is_hazard());
            }
        });
        self.seen += 1;
        if self.seen == self.scenes { self.rating() } else { Rating { area: None, small: None, floor: None } }
    }

    fn rating(&self) -> Rating {
        let share = |class: usize, points: &[f32]| {
            (!points.is_empty()).then(|| self.hazards[class] as f64 / points.len() as f64)
        };
        Rating {
            area: self.all.auc().zip(self.small.auc()).map(|(all, small)| 0.5 * (all + small)),
            small: share(0, &self.small.positive),
            floor: share(1, &self.small.negative),
        }
    }
}

/// Calls `take` with the true class, the label and the probability of each measured point. The classes are in the order
/// of the cloud, row by row.
pub fn each_measured(truth: &[Truth], labels: &Labels, probabilities: &[f32], mut take: impl FnMut(Truth, Label, f32)) {
    let height = labels.height.max(1);
    let width = labels.labels.len() / height;
    for (i, truth) in truth.iter().enumerate().take(width * height) {
        let at = i % width * height + i / width;
        if labels.labels[at] != Label::Missing {
            take(*truth, labels.labels[at], probabilities[at]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn a_rating_counts_all_scenes() {
        let mut rate = RateDetection::construct((2,));
        // Two rows of three points.
        let truth = vec![Truth::Floor, Truth::Small, Truth::Object, Truth::Floor, Truth::Artefact, Truth::Small];
        let [m, f, o] = [Label::Missing, Label::Floor, Label::Obstacle];
        let labels = Labels { height: 2, labels: vec![f, o, o, f, o, m] };
        let probabilities = vec![0.1, 0.6, 0.9, 0.85, 0.8, 0.0];
        let none = Rating { area: None, small: None, floor: None };
        assert_eq!(rate.process(&truth, &labels, &probabilities), none);
        // Obstacles have 0.9 and 0.8, of which the first is small; the floor has 0.1 and 0.6, the artefact 0.85.
        let rating = Rating { area: Some(0.5 * (5.0 / 6.0 + 1.0)), small: Some(1.0), floor: Some(0.5) };
        assert_eq!(rate.process(&truth, &labels, &probabilities), rating);
        assert_eq!(rate.process(&truth, &labels, &probabilities), none);
    }

    #[test]
    fn sets_of_scenes_have_nothing_in_common() {
        let take = |seed: u64, count: usize| {
            let mut camera = SceneTof::construct((2, seed));
            let (mut cloud, mut pose, mut truth) = (Out::new(), Out::new(), Out::<Vec<Truth>>::new());
            let mut scene = || {
                truth.clear();
                camera.process(&mut cloud, &mut pose, &mut truth);
                truth.get().cloned()
            };
            (0..count).map(|_| scene()).collect::<Vec<_>>()
        };
        let (first, second) = (take(0, 3), take(1, 1));
        assert_eq!(first[0], Some(labelled_scene(1001).take().truth));
        assert!(first[1].is_some() && first[1] != first[0] && first[2].is_none());
        assert_eq!(second[0], Some(labelled_scene(1003).take().truth));
    }
}
