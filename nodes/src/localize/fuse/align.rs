use super::past::Place;
use heapless::Deque;

/// Number of fixes that give a heading.
pub(super) const POINTS: usize = 11;

/// Fixes of the last metres, with the places of the antenna in the frame of odometry.
#[derive(Debug, Clone, Default)]
pub(super) struct Alignment {
    points: Deque<Point, POINTS>,
}

#[derive(Debug, Clone, Copy)]
struct Point {
    fix: [f64; 2],
    antenna: [f64; 2],
}

/// Turn from the frame of odometry to that of the fixes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// Angle, in rad.
    pub angle: f64,
    /// Mean of the fixes, and of the places of the antenna.
    pub fix: [f64; 2],
    antenna: [f64; 2],
    /// Sum of the squared distances of the antenna from its mean, in m².
    pub spread: f64,
}

impl Alignment {
    /// Adds a fix that is far enough from the last one. Returns `true` if there are as many as are needed, on a way of
    /// `length` in m.
    pub fn put(&mut self, fix: [f64; 2], antenna: [f64; 2], length: f64) -> bool {
        let apart = length / (POINTS - 1) as f64;
        let is_near = |last: &Point| libm::hypot(antenna[0] - last.antenna[0], antenna[1] - last.antenna[1]) < apart;
        if self.points.back().is_some_and(is_near) {
            return false;
        }
        if self.points.is_full() {
            self.points.pop_front();
        }
        let full = self.points.push_back(Point { fix, antenna });
        debug_assert!(full.is_ok(), "there is room after one was taken out");
        self.points.is_full()
    }

    /// Forgets the oldest fix.
    pub fn drop_first(&mut self) {
        self.points.pop_front();
    }

    /// Turn with the least squares of the residuals (Procrustes in the plane; Arun, Huang, Blostein 1987). `None` if
    /// the square of a residual is beyond `most`, in m², or the spread is less than `least`.
    pub fn turn(&self, most: f64, least: f64) -> Option<Turn> {
        let count = self.points.len() as f64;
        let mean =
            |of: fn(&Point) -> [f64; 2]| [0, 1].map(|i| self.points.iter().map(|p| of(p)[i]).sum::<f64>() / count);
        let (fix, antenna) = (mean(|point| point.fix), mean(|point| point.antenna));
        let (mut dot, mut cross, mut spread) = (0.0, 0.0, 0.0);
        for point in &self.points {
            let ([a, b], [x, y]) = (minus(point.antenna, antenna), minus(point.fix, fix));
            dot += a * x + b * y;
            cross += a * y - b * x;
            spread += a * a + b * b;
        }
        let turn = Turn { angle: libm::atan2(cross, dot), fix, antenna, spread };
        let agrees = |point: &Point| {
            let [x, y] = minus(minus(point.fix, fix), turn.arm(point.antenna));
            x * x + y * y <= most
        };
        (spread >= least && self.points.iter().all(agrees)).then_some(turn)
    }
}

impl Turn {
    /// Place in the frame of odometry, from the mean of the antenna on, turned into the frame of the fixes.
    pub fn arm(&self, place: [f64; 2]) -> [f64; 2] {
        Place { theta: self.angle, ..Place::default() }.to_outer(minus(place, self.antenna))
    }
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fixes of a frame that is turned by 2 rad and moved, and the alignment after each.
    fn aligned(error: impl Fn(usize) -> f64, count: usize) -> Option<Turn> {
        let frame = Place { x: 30.0, y: -20.0, theta: 2.0 };
        let mut alignment = Alignment::default();
        (0..count).find_map(|i| {
            let antenna = [1.1 * i as f64, (0.3 * i as f64).sin()];
            let [x, y] = frame.to_outer(antenna);
            let is_full = alignment.put([x + error(i), y], antenna, 10.0);
            assert!(!alignment.put([x, y], antenna, 10.0), "it is too near");
            let found = is_full.then(|| alignment.turn(1.0, 25.0)).flatten();
            if is_full && found.is_none() {
                alignment.drop_first();
            }
            found
        })
    }

    #[test]
    fn the_turn_is_that_of_the_frames() {
        let turn = aligned(|_| 0.0, 11).expect("a turn");
        assert!((turn.angle - 2.0).abs() < 1e-12 && turn.spread > 100.0, "{turn:?}");
        assert!(aligned(|_| 0.0, 10).is_none(), "one is missing");
    }

    #[test]
    fn fixes_that_contradict_each_other_give_none() {
        assert!(aligned(|i| if i == 4 { 8.0 } else { 0.0 }, 12).is_none());
        let turn = aligned(|i| if i < 5 { 8.0 } else { 0.0 }, 20).expect("the others agree");
        assert!((turn.angle - 2.0).abs() < 0.05, "{turn:?}");
    }
}
