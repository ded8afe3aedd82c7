use crate::Random;
use crate::{Space, eigen::eigen};
use serde::{Deserialize, Serialize};

/// Relative difference of fitness below which a descent has converged.
const SAME_FITNESS: f64 = 1e-13;
/// Standard deviation below which a descent has converged, as a share of the axis.
const SAME_POINT: f64 = 1e-13;
/// Ratio of the longest to the shortest axis of the distribution above which a descent ends.
const LONGEST_AXIS: f64 = 1e7;
/// Spread of fitness below which a descent is given up, as a share of the distance to the best fitness of all descents.
const HOPELESS: f64 = 0.1;
/// Number of generations over which this spread is measured.
const RECENT: usize = 10;
/// Minimum standard deviation of an integer, in steps.
const INTEGER_SPREAD: f64 = 0.3;

/// Weights and rates of a descent, by dimensions and size of the generation (Hansen: The CMA Evolution Strategy, a
/// Tutorial, 2016, table 1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Rates {
    /// Weight of each candidate, best first.
    weights: Vec<f64>,
    /// Number of positive weights (μ).
    parents: usize,
    /// Variance-effective selection mass (μ_eff).
    mass: f64,
    /// Rates of the two paths (c_c, c_σ).
    path: f64,
    step_path: f64,
    /// Rates of the covariance (c_1, c_μ).
    rank_one: f64,
    rank_mu: f64,
    /// Damping of the step size (d_σ).
    damping: f64,
    /// Expected length of a normally distributed vector.
    length: f64,
}

impl Rates {
    fn new(n: usize, size: usize, active: bool) -> Self {
        let dim = n as f64;
        let raw: Vec<f64> = (1..=size).map(|i| libm::log((size as f64 + 1.0) / 2.0) - libm::log(i as f64)).collect();
        let parents = size / 2;
        let mass = |w: &[f64]| w.iter().sum::<f64>().powi(2) / w.iter().map(|w| w * w).sum::<f64>();
        let (positive, negative) = (mass(&raw[..parents]), mass(&raw[parents..]));
        let path = (4.0 + positive / dim) / (dim + 4.0 + 2.0 * positive / dim);
        let step_path = (positive + 2.0) / (dim + positive + 5.0);
        let rank_one = 2.0 / ((dim + 1.3).powi(2) + positive);
        let gain = 2.0 * (0.25 + positive + 1.0 / positive - 2.0) / ((dim + 2.0).powi(2) + positive);
        let rank_mu = gain.min(1.0 - rank_one);
        let damping = 1.0 + 2.0 * (((positive - 1.0) / (dim + 1.0)).sqrt() - 1.0).max(0.0) + step_path;
        let bound = (1.0 + rank_one / rank_mu)
            .min(1.0 + 2.0 * negative / (positive + 2.0))
            .min((1.0 - rank_one - rank_mu) / (dim * rank_mu));
        let sum: f64 = raw[..parents].iter().sum();
        let below: f64 = raw.iter().filter(|w| **w < 0.0).map(|w| w.abs()).sum();
        let weight = |w: f64| if w >= 0.0 { w / sum } else { f64::from(u8::from(active)) * bound.max(0.0) * w / below };
        let weights = raw.iter().enumerate().map(|(i, &w)| if i < parents { w / sum } else { weight(w.min(0.0)) });
        let length = dim.sqrt() * (1.0 - 1.0 / (4.0 * dim) + 1.0 / (21.0 * dim * dim));
        Self {
            weights: weights.collect(),
            parents,
            mass: positive,
            path,
            step_path,
            rank_one,
            rank_mu,
            damping,
            length,
        }
    }
}

/// Descent of a multivariate normal distribution from one start (CMA-ES with weighted recombination, step-size control
/// and optionally negative weights; Hansen 2016). The points are reflected at the bounds of the unit cube.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Descent {
    rates: Rates,
    mean: Vec<f64>,
    sigma: f64,
    covariance: Vec<f64>,
    /// Eigenvectors by column, and square roots of the eigenvalues.
    axes: Vec<f64>,
    lengths: Vec<f64>,
    path: Vec<f64>,
    step_path: Vec<f64>,
    generation: u32,
    /// Generation of the eigenvectors.
    decomposed: u32,
    /// Best fitness of the last generations.
    history: Vec<f64>,
    /// Vectors of the current generation, before and after the transformation to the distribution.
    drawn: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Descent {
    /// Starts at a point of the unit cube, with a standard deviation as a share of each axis. A generation has at least
    /// 4 candidates. The order of all but the best half only matters to `active` descents.
    pub fn new(mean: Vec<f64>, sigma: f64, size: usize, active: bool) -> Self {
        let n = mean.len();
        let mut one = vec![0.0; n * n];
        (0..n).for_each(|i| one[i * n + i] = 1.0);
        Self {
            rates: Rates::new(n, size.max(4), active),
            mean,
            sigma,
            covariance: one.clone(),
            axes: one,
            lengths: vec![1.0; n],
            path: vec![0.0; n],
            step_path: vec![0.0; n],
            generation: 0,
            decomposed: 0,
            history: Vec::new(),
            drawn: Vec::new(),
        }
    }

    /// Number of candidates of a generation.
    pub fn size(&self) -> usize {
        self.rates.weights.len()
    }

    /// Number of candidates with a positive weight.
    pub fn parents(&self) -> usize {
        self.rates.parents
    }

    /// Draws the points of a generation.
    pub fn draw(&mut self, random: &mut Random) -> Vec<Vec<f64>> {
        let n = self.mean.len();
        self.drawn.clear();
        for _ in 0..self.size() {
            let z: Vec<f64> = (0..n).map(|_| random.standard_normal()).collect();
            let y = (0..n).map(|i| (0..n).map(|j| self.axes[i * n + j] * self.lengths[j] * z[j]).sum()).collect();
            self.drawn.push((z, y));
        }
        let point = |y: &Vec<f64>| self.mean.iter().zip(y).map(|(m, y)| reflect(m + self.sigma * y)).collect();
        self.drawn.iter().map(|(_, y)| point(y)).collect()
    }

    /// Replaces the first point that was drawn by the mean.
    pub fn draw_mean_first(&mut self) {
        if let Some((z, y)) = self.drawn.first_mut() {
            z.fill(0.0);
            y.fill(0.0);
        }
    }

    /// Moves the distribution. `fitness` has a finite or infinite number for each drawn point; `best` is the best
    /// fitness of all descents. Returns `false` if the descent has ended.
    pub fn update(&mut self, fitness: &[f64], best: f64, space: &Space) -> bool {
        let mut order: Vec<usize> = (0..self.size()).collect();
        order.sort_by(|a, b| fitness[*a].total_cmp(&fitness[*b]));
        if fitness[order[0]] == f64::INFINITY {
            return false;
        }
        self.generation += 1;
        self.move_mean(&order);
        self.adapt_covariance(&order);
        self.widen_integers(space);
        let gap = 1.0 / (10.0 * self.mean.len() as f64 * (self.rates.rank_one + self.rates.rank_mu));
        if f64::from(self.generation - self.decomposed) > gap && !self.decompose() {
            return false;
        }
        let (first, last) = (fitness[order[0]], fitness[order[self.rates.parents - 1]]);
        !self.has_converged(first, last, space) && !self.is_hopeless(best, last)
    }

    fn move_mean(&mut self, order: &[usize]) {
        let Rates { weights, parents, mass, step_path, .. } = &self.rates;
        let n = self.mean.len();
        let mut step = vec![0.0; n];
        let mut white = vec![0.0; n];
        for (&k, w) in order.iter().zip(weights).take(*parents) {
            let (z, y) = &self.drawn[k];
            step.iter_mut().zip(y).for_each(|(s, y)| *s += w * y);
            white.iter_mut().zip(z).for_each(|(s, z)| *s += w * z);
        }
        let gain = (step_path * (2.0 - step_path) * mass).sqrt();
        self.mean.iter_mut().zip(&step).for_each(|(mean, step)| *mean += self.sigma * step);
        for (path, row) in self.step_path.iter_mut().zip(self.axes.chunks_exact(n)) {
            let along: f64 = row.iter().zip(&white).map(|(axis, white)| axis * white).sum();
            *path = (1.0 - step_path) * *path + gain * along;
        }
        let length = self.step_path.iter().map(|p| p * p).sum::<f64>().sqrt() / self.rates.length;
        let settled = (1.0 - (1.0 - step_path).powi(2 * self.generation as i32)).sqrt();
        let steady = length / settled < 1.4 + 2.0 / (n as f64 + 1.0);
        let gain = (self.rates.path * (2.0 - self.rates.path) * mass).sqrt();
        for (p, s) in self.path.iter_mut().zip(&step) {
            *p = (1.0 - self.rates.path) * *p + if steady { gain * s } else { 0.0 };
        }
        if !steady {
            // Keeps the variance that the path would have added.
            let kept = self.rates.rank_one * self.rates.path * (2.0 - self.rates.path);
            self.covariance.iter_mut().for_each(|c| *c *= 1.0 + kept);
        }
        self.sigma *= libm::exp((step_path / self.rates.damping * (length - 1.0)).min(1.0));
    }

    fn adapt_covariance(&mut self, order: &[usize]) {
        let Rates { weights, rank_one, rank_mu, .. } = &self.rates;
        let n = self.mean.len();
        let keep = 1.0 - rank_one - rank_mu * weights.iter().sum::<f64>();
        for i in 0..n {
            for j in 0..=i {
                self.covariance[i * n + j] = keep * self.covariance[i * n + j] + rank_one * self.path[i] * self.path[j];
            }
        }
        for (&k, &w) in order.iter().zip(weights) {
            let (z, y) = &self.drawn[k];
            let norm: f64 = z.iter().map(|z| z * z).sum();
            let w = rank_mu * if w < 0.0 { w * n as f64 / norm.max(1e-12) } else { w };
            for i in 0..n {
                for j in 0..=i {
                    self.covariance[i * n + j] += w * y[i] * y[j];
                }
            }
        }
        for i in 0..n {
            for j in 0..i {
                self.covariance[j * n + i] = self.covariance[i * n + j];
            }
        }
    }

    /// Keeps the standard deviation of integers so large that other integers are drawn.
    fn widen_integers(&mut self, space: &Space) {
        let n = self.mean.len();
        for (i, axis) in space.axes().iter().enumerate() {
            let (least, now) = (INTEGER_SPREAD * axis.step(), self.sigma * self.covariance[i * n + i].max(0.0).sqrt());
            if now < least && now > 0.0 {
                (0..n).for_each(|k| self.covariance[i * n + k] *= least / now);
                (0..n).for_each(|k| self.covariance[k * n + i] *= least / now);
            }
        }
    }

    /// Computes the axes of the distribution. Returns `false` if it has degenerated.
    fn decompose(&mut self) -> bool {
        let n = self.mean.len();
        let (values, axes) = eigen(&self.covariance, n);
        let (least, most) = values.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        self.decomposed = self.generation;
        self.axes = axes;
        self.lengths = values.iter().map(|v| v.max(0.0).sqrt()).collect();
        least > 0.0 && most < least * LONGEST_AXIS * LONGEST_AXIS && self.sigma.is_finite()
    }

    fn has_converged(&mut self, best: f64, worst_parent: f64, space: &Space) -> bool {
        let n = self.mean.len();
        let longest = 10 + 30 * n / self.size();
        self.history.insert(0, best);
        self.history.truncate(longest);
        let (low, high) = self.history.iter().fold((best, worst_parent), |(a, b), f| (a.min(*f), b.max(*f)));
        let flat = high.is_finite() && high - low <= SAME_FITNESS * high.abs().max(low.abs());
        let spread = |i: usize| self.sigma * self.covariance[i * n + i].max(0.0).sqrt();
        let reals = space.axes().iter().enumerate().filter(|(_, axis)| !axis.is_integer());
        let small = reals.clone().count() > 0 && reals.clone().all(|(i, _)| spread(i) < SAME_POINT);
        // Nothing tells the candidates apart: on a plateau at once, else after some generations.
        small || flat && (self.history.len() == longest || self.history.len() > 2 && best == worst_parent)
    }

    /// Returns `true` if the descent converges to a fitness that is worse than the best one.
    fn is_hopeless(&self, best: f64, worst_parent: f64) -> bool {
        let recent = self.history.iter().take(RECENT);
        let (low, high) = recent.fold((f64::INFINITY, worst_parent), |(a, b), f| (a.min(*f), b.max(*f)));
        self.history.len() >= RECENT && high - low < HOPELESS * (low - best)
    }
}

/// Reflects a coordinate at 0 and 1 into the unit interval.
fn reflect(x: f64) -> f64 {
    let x = x.rem_euclid(2.0);
    if x > 1.0 { 2.0 - x } else { x }
}
