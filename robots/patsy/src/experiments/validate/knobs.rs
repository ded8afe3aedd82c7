use crate::Search;
use core::fmt;

/// Feet of a EUR pallet, 1.2 m × 0.8 m, seen from the short side, with a tolerance around each.
const fn feet(tolerance: f32) -> [[f32; 4]; 9] {
    let (length, width) = (0.145 + tolerance, 0.1 + tolerance);
    let [x, y] = [0.5275, 0.35];
    [
        [-x, -y, length, width],
        [-x, 0.0, length, width],
        [-x, y, length, width],
        [0.0, -y, length, width],
        [0.0, 0.0, length, width],
        [0.0, y, length, width],
        [x, -y, length, width],
        [x, 0.0, length, width],
        [x, y, length, width],
    ]
}

const FEET: [[[f32; 4]; 9]; 4] = [feet(0.05), feet(0.1), feet(0.15), feet(0.2)];
const BOARDS: [[[f32; 4]; 3]; 3] = [boards(0.15), boards(0.2), boards(0.25)];

/// Boards under the feet, which a low scanner sees to a varying extent.
const fn boards(width: f32) -> [[f32; 4]; 3] {
    [[0.0, -0.35, 1.2, width], [0.0, 0.0, 1.2, width], [0.0, 0.35, 1.2, width]]
}

/// Models and limits that are chosen, with their possible values.
pub const KNOBS: [(&str, &[f32]); 15] = [
    ("gap", &[0.03, 0.05, 0.08, 0.12]),
    ("max_size", &[0.25, 0.35, 0.5, 0.9, 1.3]),
    ("tolerance", &[0.05, 0.075, 0.1, 0.125]),
    ("min_points", &[1.0, 2.0, 3.0]),
    ("min_inliers", &[8.0, 10.0, 12.0, 15.0, 20.0]),
    ("max_outliers", &[5.0, 8.0, 12.0, 18.0, 25.0]),
    ("min_wheels", &[4.0, 5.0, 6.0, 7.0]),
    ("max_missing", &[0.0, 1.0, 2.0, 3.0]),
    ("clearance", &[0.0, 0.2, 0.4, 0.6]),
    ("min_passing", &[0.0, 0.5, 0.8, 0.9]),
    ("max_residual", &[0.02, 0.03, 0.04, 0.05, 0.07]),
    ("max_view_angle", &[40.0, 55.0, 70.0, 90.0]),
    ("max_distance", &[4.0, 4.5, 5.0]),
    ("feet", &[0.0, 1.0, 2.0, 3.0]),
    ("boards", &[0.0, 1.0, 2.0]),
];

/// One choice: the index of the value of each knob.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Choice(pub [u8; KNOBS.len()]);

impl Choice {
    /// Choice at which the search for the best one begins: the middle of each list.
    pub fn middle() -> Self {
        Self(KNOBS.map(|(_, values)| (values.len() / 2) as u8))
    }

    /// Choices that differ from this one in the given knob.
    pub fn others(self, knob: usize) -> impl Iterator<Item = Self> {
        let values = 0..KNOBS[knob].1.len() as u8;
        values.filter(move |v| *v != self.0[knob]).map(move |value| {
            let mut other = self;
            other.0[knob] = value;
            other
        })
    }

    /// Parameters of the search for pallets.
    pub fn search(self) -> Search {
        let mut values = KNOBS.iter().zip(self.0).map(|((_, values), index)| values[usize::from(index)]);
        let mut next = || values.next().unwrap_or_default();
        Search {
            near: 0.3,
            gap: next(),
            max_size: next(),
            dimensions: [0.8, 1.2, 0.1, 0.145, 0.0],
            tolerance: next(),
            min_points: next() as u16,
            min_inliers: next() as u16,
            max_outliers: next() as u16,
            min_wheels: next() as usize,
            max_missing: next() as usize,
            clearance: next(),
            min_passing: next(),
            max_residual: next(),
            max_view_angle: next().to_radians(),
            max_distance: next(),
            boxes: &FEET[next() as usize],
            boards: &BOARDS[next() as usize],
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let all = KNOBS.iter().zip(self.0).map(|((name, values), index)| (name, values[usize::from(index)]));
        all.enumerate().try_for_each(|(i, (name, value))| write!(f, "{}{name} {value}", if i > 0 { ", " } else { "" }))
    }
}
