use crate::Random;
use crate::{
    Best, Search, Selection, Space,
    search::{complete, keep_best},
    space::below,
};
use serde::{Deserialize, Serialize};

/// Members of the first population per dimension.
const MEMBERS: usize = 3;
/// Number of remembered pairs of mutation factor and crossover rate.
const MEMORY: usize = 5;
/// Share of the best members towards which others move.
const ELITE: f64 = 0.15;
/// Growth of the population with each restart.
const GROWTH: f64 = 1.5;
/// Maximum members per dimension.
const MOST: usize = 100;
/// Number of generations without any success after which a search starts again.
const PATIENCE: u32 = 25;
/// Relative difference of fitness, and difference of points as a share of the axes, below which a population has
/// converged.
const SAME: f64 = 1e-13;

/// Search by differential evolution (Storn and Price 1997). Each member of the population moves towards one of the best
/// and by the difference of two others; the mutation factor and the crossover rate are learned from past successes
/// (Tanabe and Fukunaga: Success-History Based Parameter Adaptation for Differential Evolution, 2013). When the
/// population has converged, a larger one starts. The first members form a Latin hypercube.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DeSearch {
    space: Space,
    random: Random,
    size: usize,
    population: Vec<Vec<f64>>,
    /// Fitness of the members. Before the first generation it is empty.
    fitness: Vec<f64>,
    /// Members that were replaced.
    archive: Vec<Vec<f64>>,
    trials: Vec<Trial>,
    candidates: Vec<Vec<f64>>,
    /// Learned mutation factors and crossover rates, and the next one to be replaced.
    memory: [(f64, f64); MEMORY],
    oldest: usize,
    /// Generations since the last success.
    quiet: u32,
    best: Option<Best>,
}

/// Point to be compared with a member.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Trial {
    point: Vec<f64>,
    factor: f64,
    rate: f64,
}

impl DeSearch {
    /// Creates a search in this space.
    pub fn new(space: Space, seed: u64) -> Self {
        let size = (MEMBERS * space.dimensions()).max(6);
        Self::with(space, seed, size)
    }

    /// Creates a search whose first candidate has these values.
    pub fn starting_at(space: Space, seed: u64, start: &[f64]) -> Self {
        let mut search = Self::new(space, seed);
        let point = search.space.point(start);
        search.candidates[0] = search.space.values(&point);
        search.trials[0].point = point;
        search
    }

    fn with(space: Space, seed: u64, size: usize) -> Self {
        let mut search = Self {
            space,
            random: Random::new(seed),
            size,
            population: Vec::new(),
            fitness: Vec::new(),
            archive: Vec::new(),
            trials: Vec::new(),
            candidates: Vec::new(),
            memory: [(0.5, 0.5); MEMORY],
            oldest: 0,
            quiet: 0,
            best: None,
        };
        search.start();
        search
    }

    /// Proposes a new population.
    fn start(&mut self) {
        self.population.clear();
        self.fitness.clear();
        self.archive.clear();
        (self.memory, self.oldest, self.quiet) = ([(0.5, 0.5); MEMORY], 0, 0);
        let points = self.space.sample(self.size, &mut self.random);
        self.propose(points.into_iter().map(|point| Trial { point, factor: 0.0, rate: 0.0 }).collect());
    }

    fn propose(&mut self, trials: Vec<Trial>) {
        self.candidates = trials.iter().map(|t| self.space.values(&t.point)).collect();
        self.trials = trials;
    }

    /// Replaces members by better trials, and learns from them.
    fn select(&mut self, fitness: &[f64]) {
        let mut successes = Vec::new();
        for (i, trial) in self.trials.iter_mut().enumerate() {
            let (before, after) = (self.fitness[i], fitness[i]);
            if after > before || after == f64::INFINITY {
                continue;
            }
            let replaced = std::mem::replace(&mut self.population[i], std::mem::take(&mut trial.point));
            self.fitness[i] = after;
            if after < before {
                successes.push((if before.is_finite() { before - after } else { 1.0 }, trial.factor, trial.rate));
                self.archive.push(replaced);
            }
        }
        while self.archive.len() > self.size {
            self.archive.swap_remove(below(&mut self.random, self.archive.len()));
        }
        self.quiet = if successes.is_empty() { self.quiet + 1 } else { 0 };
        self.learn(&successes);
    }

    /// Remembers the means of the successful factors and rates, weighted by the improvement of fitness.
    fn learn(&mut self, successes: &[(f64, f64, f64)]) {
        let mean = |x: fn(&(f64, f64, f64)) -> f64| {
            let (top, bottom) = successes.iter().fold((0.0, 0.0), |(a, b), s| (a + s.0 * x(s) * x(s), b + s.0 * x(s)));
            if bottom > 0.0 { top / bottom } else { 0.0 }
        };
        if !successes.is_empty() {
            self.memory[self.oldest] = (mean(|s| s.1).clamp(0.1, 1.0), mean(|s| s.2).clamp(0.0, 1.0));
            self.oldest = (self.oldest + 1) % MEMORY;
        }
    }

    fn breed(&mut self) {
        let mut order: Vec<usize> = (0..self.size).collect();
        order.sort_by(|a, b| self.fitness[*a].total_cmp(&self.fitness[*b]));
        order.truncate(((ELITE * self.size as f64) as usize).max(2));
        let trials = (0..self.size).map(|i| self.trial(i, &order)).collect();
        self.propose(trials);
    }

    fn trial(&mut self, member: usize, elite: &[usize]) -> Trial {
        let random = &mut self.random;
        let (factor, rate) = self.memory[below(random, MEMORY)];
        let rate = (rate + 0.1 * random.standard_normal()).clamp(0.0, 1.0);
        let factor = cauchy(factor, random);
        let (size, dimensions) = (self.size, self.space.dimensions());
        let towards = elite[below(random, elite.len())];
        let one = other(size, &[member], random);
        let two = other(size + self.archive.len(), &[member, one], random);
        let all = |i: usize| self.population.get(i).unwrap_or_else(|| &self.archive[i - size]);
        let (x, towards, one, two) = (all(member), all(towards), all(one), all(two));
        let always = below(random, dimensions.max(1));
        let mut point = x.clone();
        for j in 0..dimensions {
            if j == always || random.unit() < rate {
                let to = x[j] + factor * (towards[j] - x[j] + one[j] - two[j]);
                // Half of the points beyond a bound stop at it, where the optimum may be.
                let bound = to.clamp(0.0, 1.0);
                point[j] = if to == bound || random.chance(0.5) { bound } else { 0.5 * (x[j] + bound) };
            }
        }
        Trial { point, factor, rate }
    }

    fn has_converged(&self) -> bool {
        let spread = |values: &mut dyn Iterator<Item = f64>| {
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
            (high - low, low.abs().max(high.abs()))
        };
        let (gap, size) = spread(&mut self.fitness.iter().copied());
        let mut axes = (0..self.space.dimensions()).map(|j| spread(&mut self.population.iter().map(|p| p[j])).0);
        // The gap is NaN if all have failed, and infinite if some have.
        let flat = gap.is_nan() || gap.is_finite() && gap <= SAME * size;
        self.quiet >= PATIENCE || flat || axes.all(|gap| gap <= SAME)
    }
}

/// Positive random number up to 1, with a Cauchy distribution of width 0.1 around a mean.
fn cauchy(mean: f64, random: &mut Random) -> f64 {
    for _ in 0..100 {
        let x = mean + 0.1 * libm::tan(std::f64::consts::PI * (random.unit() - 0.5));
        if x > 0.0 {
            return x.min(1.0);
        }
    }
    mean
}

/// Random number below `count` that is none of `without`, if there is one.
fn other(count: usize, without: &[usize], random: &mut Random) -> usize {
    loop {
        let x = below(random, count);
        if !without.contains(&x) || count <= without.len() {
            return x;
        }
    }
}

impl Search for DeSearch {
    fn space(&self) -> &Space {
        &self.space
    }

    fn ask(&self) -> &[Vec<f64>] {
        &self.candidates
    }

    fn selection(&self) -> Selection<'_> {
        // In the first generation the order of all matters.
        if self.fitness.is_empty() { Selection::All } else { Selection::AtMost(&self.fitness) }
    }

    fn tell(&mut self, fitness: &[f64]) {
        let fitness = complete(fitness, self.candidates.len());
        keep_best(&mut self.best, &self.candidates, &fitness);
        if self.fitness.is_empty() {
            self.population = self.trials.iter_mut().map(|t| std::mem::take(&mut t.point)).collect();
            self.fitness = fitness;
        } else {
            self.select(&fitness);
        }
        if self.has_converged() {
            let grown = (GROWTH * self.size as f64) as usize;
            self.size = grown.min(MOST * self.space.dimensions()).max(self.size);
            self.start();
        } else {
            self.breed();
        }
    }

    fn best(&self) -> Option<&Best> {
        self.best.as_ref()
    }
}
