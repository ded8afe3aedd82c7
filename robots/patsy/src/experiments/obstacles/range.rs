use crate::{
    Detector,
    experiments::chart::{Curve, Panel},
    world::{Scene, Thing},
};
use apex_sim::tof::{TofFrame, Truth};
use core::fmt;

/// Class of things whose range of detection is measured (thesis fig. 6.20).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeClass {
    /// Name of the class.
    pub name: &'static str,
    /// The thing.
    pub thing: Thing,
    /// Range in the thesis, in m.
    pub thesis: f32,
    /// Only points that hang over count.
    is_overhanging: bool,
}

/// Classes of figure 6.20.
pub const RANGES: [RangeClass; 4] = [
    RangeClass { name: "screwdriver", thing: Thing::Screwdriver, thesis: 2.3, is_overhanging: false },
    RangeClass { name: "glass", thing: Thing::Glass, thesis: 1.3, is_overhanging: false },
    RangeClass { name: "larger object", thing: Thing::Carton, thesis: 5.0, is_overhanging: false },
    RangeClass { name: "overhanging", thing: Thing::Table, thesis: 5.0, is_overhanging: true },
];

/// Minimum number of detected points of a detected thing (thesis 6.10.1).
const LEAST_POINTS: usize = 10;
/// Share of the trials in which a thing within its range is detected.
const RELIABLE: f64 = 0.9;
const NEAREST: f32 = 0.7;
const SPACING: f32 = 0.2;
/// Number of distances, up to 6.3 m.
const DISTANCES: usize = 29;

/// Numbers of points that show a thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Trial {
    /// Measured points.
    pub shown: usize,
    /// Points that are detected.
    pub detected: usize,
}

impl RangeClass {
    /// Distances of the trials, in m.
    pub fn distances() -> impl Iterator<Item = f32> {
        (0..DISTANCES).map(|i| NEAREST + SPACING * i as f32)
    }

    /// Places the thing at a distance, with the camera, place and floor of a seed.
    pub fn trial(&self, distance: f32, seed: u64) -> Trial {
        let mut scene = Scene::new(seed);
        scene.place(self.thing, distance);
        let parts = scene.space.solids().len();
        if seed.is_multiple_of(2) {
            scene.wall(distance + 2.0);
        }
        let frame = scene.take();
        let mut detector = Detector::default();
        let Some((_, labels, _)) = detector.detect(&frame.cloud) else { return Trial::default() };
        let (width, height) = frame.cloud.size();
        let shown = || (0..width * height).filter(|i| self.shows(&frame, *i, parts));
        let is_detected = |i: &usize| labels.labels[i % width * height + i / width].is_hazard();
        Trial { shown: shown().count(), detected: shown().filter(is_detected).count() }
    }

    fn shows(&self, frame: &TofFrame, i: usize, parts: usize) -> bool {
        let is_part = frame.solids[i].is_some_and(|solid| solid < parts);
        is_part && (!self.is_overhanging || frame.truth[i] == Truth::Overhanging)
    }
}

/// Trials by class and distance.
#[derive(Debug, Clone, Default)]
pub struct RangeTable {
    /// Class, distance in m, and trial.
    pub trials: Vec<(usize, f32, Trial)>,
}

impl RangeTable {
    fn at(&self, class: usize, distance: f32) -> impl Iterator<Item = Trial> + Clone {
        let of = self.trials.iter().filter(move |(c, d, _)| *c == class && *d == distance);
        of.map(|(_, _, trial)| *trial)
    }

    /// Median number of detected points of a class at a distance.
    pub fn median(&self, class: usize, distance: f32) -> usize {
        let mut counts: Vec<usize> = self.at(class, distance).map(|trial| trial.detected).collect();
        counts.sort_unstable();
        counts.get(counts.len() / 2).copied().unwrap_or_default()
    }

    /// Distance up to which a class is detected in this share of the trials at each distance, in m, from the nearest
    /// one at which it is in view.
    pub fn range(&self, class: usize, share: f64) -> Option<f32> {
        self.range_of(class, share, |trial| trial.detected)
    }

    /// Distance up to which enough points show a class for it to be detected, in this share of the trials, in m.
    pub fn limit(&self, class: usize, share: f64) -> Option<f32> {
        self.range_of(class, share, |trial| trial.shown)
    }

    fn range_of(&self, class: usize, share: f64, points: impl Fn(&Trial) -> usize) -> Option<f32> {
        let is_out_of_view = |distance: &f32| self.at(class, *distance).all(|trial| trial.shown < LEAST_POINTS);
        let is_enough = |distance: &f32| {
            let trials = self.at(class, *distance);
            let enough = trials.clone().filter(|trial| points(trial) >= LEAST_POINTS).count();
            enough as f64 >= share * trials.count() as f64
        };
        RangeClass::distances().skip_while(is_out_of_view).take_while(is_enough).last()
    }

    /// Median number of detected points by distance (figure 6.20), with the number from which on a thing is detected.
    pub fn figure(&self) -> Panel {
        let curve = |(class, RangeClass { name, .. }): (usize, &RangeClass)| {
            let points = RangeClass::distances().map(|distance| [distance, self.median(class, distance) as f32]);
            Curve { name: (*name).to_owned(), points: points.collect() }
        };
        Panel {
            axes: ["distance (m)".to_owned(), "detected points".to_owned()],
            is_logarithmic: true,
            mark: Some(LEAST_POINTS as f32),
            curves: RANGES.iter().enumerate().map(curve).collect(),
        }
    }
}

impl fmt::Display for RangeTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = [0, 3, 8, 13, 21].map(|i| NEAREST + SPACING * i as f32);
        let head = ["9 of 10", "half", "thesis", "10 points shown"];
        write!(
            f,
            "{:<16}{:>12}{:>10}{:>10}{:>18}   median points at",
            "detected up to", head[0], head[1], head[2], head[3]
        )?;
        shown.iter().try_for_each(|distance| write!(f, "{distance:>7.1} m"))?;
        for (class, RangeClass { name, thesis, .. }) in RANGES.iter().enumerate() {
            write!(f, "\n{name:<16}")?;
            let text = |range: Option<f32>| range.map_or_else(|| "–".to_owned(), |range| format!("{range:.1} m"));
            let [reliable, half] = [RELIABLE, 0.5].map(|share| text(self.range(class, share)));
            let limit = text(self.limit(class, RELIABLE));
            write!(f, "{reliable:>12}{half:>10}{thesis:>8.1} m{limit:>18}{:>19}", "")?;
            shown.iter().try_for_each(|distance| write!(f, "{:>9}", self.median(class, *distance)))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_ends_where_detections_get_rare() {
        let trial = |distance: f32| {
            let (shown, detected) = if distance < 2.0 { (20, 12) } else { (9, 3) };
            (0, distance, if distance < 1.0 { Trial::default() } else { Trial { shown, detected } })
        };
        let table = RangeTable { trials: RangeClass::distances().flat_map(|d| [trial(d); 4]).collect() };
        let range = table.range(0, RELIABLE);
        assert!(range.is_some_and(|range| (range - 1.9).abs() < 1e-4), "{range:?}");
        assert_eq!(table.limit(0, RELIABLE), range);
        let figure = table.figure();
        assert_eq!((figure.curves.len(), figure.curves[0].points[4]), (4, [NEAREST + 4.0 * SPACING, 12.0]));
        assert_eq!((table.range(1, RELIABLE), table.median(0, NEAREST + 4.0 * SPACING)), (None, 12));
    }
}
