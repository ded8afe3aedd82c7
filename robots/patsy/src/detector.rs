use crate::obstacles::DetectObstacles;
use apex_nodes::{
    cloud::{Columns, Labels, PointCloud},
    persons::Persons,
    scan::{Pose2, Scan},
};
use apex_rt::{Observer, Parameters as _, Program as _, Time};

/// Compiled graph `DetectObstacles`, which takes one cloud after the other.
pub struct Detector {
    program: Box<DetectObstacles>,
}

/// Weights and limits of the classification (thesis eqs. 6.1 to 6.10), as parameters of `ColumnClassifier`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// Weight of the depth, α.
    pub alpha: f32,
    /// Weight of the intensity, β.
    pub beta: f32,
    /// Weight of the elevation over the floor, γ.
    pub gamma: f32,
    /// Distance of the compared points, δ_x, in m.
    pub step: f32,
    /// Least difference in height, ε_z, in m.
    pub min_height: f32,
    /// Greatest curvature, κ_max, in rad.
    pub max_curvature: f32,
    /// Greatest difference of intensities, I_max.
    pub max_intensity: f32,
    /// Greatest elevation, in rad.
    pub max_elevation: f32,
    /// Threshold P_t.
    pub threshold: f32,
    /// Bend of the floor by the distortion of the camera, in m at 1 m: a parameter of `FloorFit`.
    pub bend: f32,
}

impl Weights {
    /// Values that the thesis gives (6.5.2), without a weight of the elevation, which it does not have. κ_max and
    /// I_max, for which it gives no values, were chosen on scenes with seeds from 1001.
    pub const THESIS: Self = Self {
        alpha: 25.57,
        beta: 19.18,
        gamma: 0.0,
        step: 0.0012,
        min_height: 0.01,
        max_curvature: 0.38,
        max_intensity: 2000.0,
        max_elevation: 0.05,
        threshold: 0.92,
        bend: 0.02,
    };

    /// Names of the parameters with their values.
    const fn named(&self) -> [(&'static str, f32); 10] {
        [
            ("classify.alpha", self.alpha),
            ("classify.beta", self.beta),
            ("classify.gamma", self.gamma),
            ("classify.step", self.step),
            ("classify.min_height", self.min_height),
            ("classify.max_curvature", self.max_curvature),
            ("classify.max_intensity", self.max_intensity),
            ("classify.max_elevation", self.max_elevation),
            ("classify.threshold", self.threshold),
            ("floor.bend", self.bend),
        ]
    }
}

/// The detector with the parameters of the graph.
impl Default for Detector {
    fn default() -> Self {
        Self { program: Box::new(DetectObstacles::new()) }
    }
}

impl Detector {
    /// Sets the weights.
    ///
    /// # Errors
    /// If a value is out of range.
    pub fn set(&mut self, weights: &Weights) -> Result<(), String> {
        weights.named().into_iter().try_for_each(|(name, value)| self.set_param(name, value))
    }

    /// Weights in use.
    ///
    /// # Errors
    /// If the graph has been changed so that it has no such parameters.
    pub fn weights(&mut self) -> Result<Weights, String> {
        let mut values = Weights::THESIS.named();
        for (name, value) in &mut values {
            *value = self.program.param::<f32>(name).map_err(|e| e.to_string())?;
        }
        let [alpha, beta, gamma, step, min_height, max_curvature, max_intensity, max_elevation, threshold, bend] =
            values.map(|(_, value)| value);
        Ok(Weights {
            alpha,
            beta,
            gamma,
            step,
            min_height,
            max_curvature,
            max_intensity,
            max_elevation,
            threshold,
            bend,
        })
    }

    /// Sets a parameter of the graph by its name.
    ///
    /// # Errors
    /// If there is no such parameter, or if the value is out of range.
    pub fn set_param(&mut self, name: &str, value: f32) -> Result<(), String> {
        self.program.set_param(name, value).map_err(|e| e.to_string())
    }

    /// Classifies a cloud. Returns the points, their labels and their probabilities, column by column.
    pub fn detect(&mut self, cloud: &PointCloud) -> Option<(&Columns, &Labels, &[f32])> {
        self.detect_with(cloud, &mut ())
    }

    /// Same as [`detect`](Self::detect), watched by an observer.
    pub fn detect_with(
        &mut self,
        cloud: &PointCloud,
        observer: &mut impl Observer,
    ) -> Option<(&Columns, &Labels, &[f32])> {
        let inputs = self.program.inputs();
        // All inputs are empty: the last reaction has taken the tokens. The scan has no points, and there are no
        // persons.
        let _ = (inputs.cloud.put(cloud.clone()), inputs.pose.put(Pose2::default()), inputs.scan.put(Scan::default()));
        let _ = (inputs.persons.put(Persons::default()), inputs.trailer.put(Pose2::default()));
        self.program.react_with(Time::ZERO, observer);
        let outputs = self.program.outputs();
        Some((outputs.points.as_ref()?, outputs.labels.as_ref()?, outputs.probabilities.as_deref()?))
    }
}
