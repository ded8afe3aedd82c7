use super::{Plane, Scores, rated::each_measured};
use crate::{Detector, Weights, world::labelled_scene};
use apex_nodes::cloud::Label;
use apex_sim::{Random, tof::Truth};
use core::fmt;

/// Method whose scores are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Height over a RANSAC plane.
    Plane,
    /// The graph with the weights of the thesis.
    Thesis,
    /// The graph as it is.
    Graph,
}

/// Classes of points, in the order of the scores.
const CLASSES: [Truth; 5] = [Truth::Floor, Truth::Artefact, Truth::Small, Truth::Object, Truth::Overhanging];
/// Number of the classes before the obstacles.
const OTHERS: usize = 2;
const SMALL: usize = 2;

/// Scores of the labelled points of a scene.
#[derive(Debug, Clone, Default)]
pub struct SceneScores {
    /// Scores by method and class.
    scores: [[Vec<f32>; CLASSES.len()]; 3],
    /// Numbers of obstacle points and of artefacts that were labelled as artefacts.
    removed: [usize; 2],
}

impl Method {
    /// All methods, in the order of the scores.
    pub const ALL: [Self; 3] = [Self::Plane, Self::Thesis, Self::Graph];

    const fn name(self) -> &'static str {
        match self {
            Self::Plane => "RANSAC plane, height",
            Self::Thesis => "weights of the thesis",
            Self::Graph => "obstacles.afg",
        }
    }
}

/// Scores of the points of the scene of a seed, by the methods in [`Method::ALL`].
///
/// # Errors
/// If the graph does not take the weights of the thesis.
pub fn labelled_scores(seed: u64) -> Result<SceneScores, String> {
    let frame = labelled_scene(seed).take();
    let mut scores = SceneScores::default();
    if let Some(plane) = Plane::find(&frame.cloud, &mut Random::new(seed)) {
        for (point, truth) in frame.cloud.points().iter().zip(&frame.truth).filter(|(p, _)| p.is_measured()) {
            let over = plane.over([point.x, point.y, point.z].map(f64::from));
            scores.push(Method::Plane, *truth, over as f32);
        }
    }
    for method in [Method::Thesis, Method::Graph] {
        let mut detector = Detector::default();
        if method == Method::Thesis {
            detector.set(&Weights::THESIS)?;
        }
        let Some((_, labels, probabilities)) = detector.detect(&frame.cloud) else { continue };
        each_measured(&frame.truth, labels, probabilities, |truth, label, probability| {
            scores.push(method, truth, probability);
            if method == Method::Graph && label == Label::Artefact {
                scores.count_removed(truth);
            }
        });
    }
    Ok(scores)
}

impl SceneScores {
    fn push(&mut self, method: Method, truth: Truth, score: f32) {
        if let Some(class) = CLASSES.iter().position(|class| *class == truth) {
            self.scores[method as usize][class].push(score);
        }
    }

    fn count_removed(&mut self, truth: Truth) {
        match CLASSES.iter().position(|class| *class == truth) {
            Some(class) if class >= OTHERS => self.removed[0] += 1,
            _ if truth == Truth::Artefact => self.removed[1] += 1,
            _ => {}
        }
    }

    /// Scores of all obstacles, or of small ones only, against floor and artefacts.
    pub fn against(&self, method: Method, only_small: bool, with_artefacts: bool) -> Scores {
        let classes = &self.scores[method as usize];
        let positive = if only_small { &classes[SMALL..=SMALL] } else { &classes[OTHERS..] };
        let negative = if with_artefacts { &classes[..OTHERS] } else { &classes[..1] };
        Scores { positive: positive.concat(), negative: negative.concat() }
    }
}

/// Table of the methods over many scenes.
#[derive(Debug, Clone)]
pub struct Summary {
    all: SceneScores,
    scenes: usize,
    threshold: f32,
}

impl Summary {
    /// Puts scenes together. `threshold` is that of the graph, P_t.
    pub fn new(scenes: &[SceneScores], threshold: f32) -> Self {
        let mut all = SceneScores::default();
        for scene in scenes {
            for (sum, part) in all.scores.as_flattened_mut().iter_mut().zip(scene.scores.as_flattened()) {
                sum.extend(part);
            }
            (0..2).for_each(|i| all.removed[i] += scene.removed[i]);
        }
        Self { all, scenes: scenes.len(), threshold }
    }

    /// Area under the curve of a method over all points: obstacles against floor and artefacts.
    pub fn auc(&self, method: Method) -> Option<f64> {
        self.all.against(method, false, true).auc()
    }

    /// Threshold of a method: of the plane, the height at which as much floor is called an obstacle as by the graph.
    fn threshold(&self, method: Method) -> f32 {
        if method != Method::Plane {
            return if method == Method::Thesis { Weights::THESIS.threshold } else { self.threshold };
        }
        let [_, rate] = self.all.against(Method::Graph, false, false).rates(self.threshold);
        let mut heights = self.all.scores[Method::Plane as usize][0].clone();
        heights.sort_unstable_by(|a, b| b.total_cmp(a));
        heights.get((rate * heights.len() as f64) as usize).copied().unwrap_or_default()
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = self.all.scores[Method::Graph as usize].each_ref().map(Vec::len);
        write!(f, "{} scenes; points: {} floor, {} artefacts", self.scenes, counts[0], counts[1])?;
        writeln!(f, ", {} small, {} objects, {} overhanging", counts[2], counts[3], counts[4])?;
        writeln!(f, "{:<24}{:>28}{:>46}", "", "AUC of obstacles against", "called an obstacle (%)")?;
        write!(f, "{:<24}{:>12}{:>8}{:>14}", "", "all others", "floor", "small/floor")?;
        write!(f, "{:>8}{:>11}{:>8}{:>9}{:>13}", "floor", "artefact", "small", "object", "overhanging")?;
        for method in Method::ALL {
            write!(f, "\n{:<24}", method.name())?;
            let auc = |only_small, with_artefacts| self.all.against(method, only_small, with_artefacts).auc();
            let areas = [auc(false, true), auc(false, false), auc(true, false)];
            for (area, width) in areas.into_iter().zip([12, 8, 14]) {
                match area {
                    Some(area) => write!(f, "{area:>width$.4}")?,
                    None => write!(f, "{:>width$}", "–")?,
                }
            }
            let threshold = self.threshold(method);
            for (scores, width) in self.all.scores[method as usize].iter().zip([8, 11, 8, 9, 13]) {
                let above = scores.iter().filter(|score| **score >= threshold).count();
                write!(f, "{:>width$.1}", 100.0 * above as f64 / scores.len().max(1) as f64)?;
            }
        }
        let [obstacles, artefacts] = self.all.removed;
        let (all_obstacles, all_artefacts) = (counts[OTHERS..].iter().sum::<usize>(), counts[1]);
        write!(f, "\nremoved as artefacts: {artefacts} of {all_artefacts} artefacts")?;
        write!(f, ", {obstacles} of {all_obstacles} points of obstacles")
    }
}
