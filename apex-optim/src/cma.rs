use crate::Random;
use crate::{
    Best, Search, Selection, Space,
    descent::Descent,
    search::{complete, keep_best},
};
use serde::{Deserialize, Serialize};

/// Standard deviation of the first generation of a descent, as a share of each axis.
const FIRST_SIGMA: f64 = 0.2;
/// Decadic logarithm of the largest ratio by which the first generation of a short descent is narrower.
const SHRINKING: f64 = 2.0;
/// Maximum number of times that the generations are doubled.
const DOUBLINGS: u32 = 9;
/// Number of starts that are spread together over the search space.
const STARTS: usize = 16;

/// Search by CMA-ES with restarts: descents of growing generations alternate with short descents of small ones, so that
/// both use the same number of evaluations (BIPOP; Hansen: Benchmarking a BI-Population CMA-ES, 2009). The starts form
/// Latin hypercubes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CmaSearch {
    space: Space,
    random: Random,
    active: bool,
    descent: Descent,
    candidates: Vec<Vec<f64>>,
    /// Points at which the next descents start.
    starts: Vec<Vec<f64>>,
    /// Number of descents with growing generations.
    large: u32,
    is_large: bool,
    /// Evaluations by descents with small and with growing generations.
    used: [u64; 2],
    /// Evaluations of the current descent, of the last one with growing generations, and those after which the current
    /// one ends.
    here: u64,
    last_large: u64,
    longest: u64,
    best: Option<Best>,
}

impl CmaSearch {
    /// Creates a search in this space.
    pub fn new(space: Space, seed: u64) -> Self {
        Self::with(space, seed, None, true)
    }

    /// Creates a search that starts at these values, and whose course depends on the better half of each generation
    /// only, so that bad candidates need not be evaluated completely.
    pub fn from_better_half(space: Space, seed: u64, start: &[f64]) -> Self {
        Self::with(space, seed, Some(start), false)
    }

    fn with(space: Space, seed: u64, start: Option<&[f64]>, active: bool) -> Self {
        let mut random = Random::new(seed);
        let mut starts = space.sample(STARTS, &mut random);
        let first = start.map(|values| space.point(values)).or_else(|| starts.pop()).unwrap_or_default();
        let descent = Descent::new(first, FIRST_SIGMA, smallest(&space), active);
        let mut search = Self {
            space,
            random,
            active,
            descent,
            candidates: Vec::new(),
            starts,
            large: 0,
            is_large: true,
            used: [0; 2],
            here: 0,
            last_large: 0,
            longest: u64::MAX,
            best: None,
        };
        search.draw();
        if let Some(values) = start {
            search.descent.draw_mean_first();
            search.candidates[0] = search.space.values(&search.space.point(values));
        }
        search
    }

    fn draw(&mut self) {
        let points = self.descent.draw(&mut self.random);
        self.candidates = points.iter().map(|p| self.space.values(p)).collect();
    }

    fn restart(&mut self) {
        if self.is_large {
            self.last_large = self.here;
        }
        let [small, large] = self.used;
        let least = smallest(&self.space);
        let largest = least << self.large.min(DOUBLINGS);
        self.is_large = large <= small;
        let (sigma, size) = if self.is_large {
            self.large += 1;
            (FIRST_SIGMA, least << self.large.min(DOUBLINGS))
        } else {
            let share = libm::pow(0.5 * largest as f64 / least as f64, self.random.unit().powi(2));
            (FIRST_SIGMA * libm::pow(10.0, -SHRINKING * self.random.unit()), (least as f64 * share) as usize)
        };
        self.longest = if self.is_large { u64::MAX } else { (self.last_large / 2).max(100 * least as u64) };
        if self.starts.is_empty() {
            self.starts = self.space.sample(STARTS, &mut self.random);
        }
        let start = self.starts.pop().unwrap_or_default();
        self.descent = Descent::new(start, sigma, size, self.active);
        self.here = 0;
    }
}

/// Number of candidates of a generation in the first descent.
fn smallest(space: &Space) -> usize {
    4 + (3.0 * libm::log(space.dimensions().max(1) as f64)) as usize
}

impl Search for CmaSearch {
    fn space(&self) -> &Space {
        &self.space
    }

    fn ask(&self) -> &[Vec<f64>] {
        &self.candidates
    }

    fn selection(&self) -> Selection<'_> {
        if self.active { Selection::All } else { Selection::Best(self.descent.parents()) }
    }

    fn tell(&mut self, fitness: &[f64]) {
        let fitness = complete(fitness, self.candidates.len());
        keep_best(&mut self.best, &self.candidates, &fitness);
        self.here += fitness.len() as u64;
        self.used[usize::from(self.is_large)] += fitness.len() as u64;
        let best = self.best.as_ref().map_or(f64::INFINITY, |best| best.fitness);
        if !self.descent.update(&fitness, best, &self.space) || self.here >= self.longest {
            self.restart();
        }
        self.draw();
    }

    fn best(&self) -> Option<&Best> {
        self.best.as_ref()
    }
}
