use super::{Columns, Labels};
use crate::scan::Scan;
use apex_rt::{Ctx, Out, node};
use core::f32::consts::{PI, TAU};

/// Greatest number of beams.
const MOST: u16 = 3600;

/// Scan of a virtual scanner with a full turn, at the origin of the robot, that sees the obstacles of a cloud: in each
/// direction the nearest hazard up to `max_height`. So nodes for plane scans stop before what they do not see
/// themselves.
///
/// Several rings see a thing that stands: a hazard counts if at least `min_rings` rows of the cloud have one in its
/// direction and at about its distance. Directions without a hazard are free (infinity). The stamp is the time of the
/// firing. Columns and labels of different sizes give ⊥.
#[node]
#[derive(Debug, Clone)]
pub struct ObstacleScan {
    /// Number of beams.
    #[param(default = 360, range = 8..=3600)]
    beams: u16,
    /// Distance up to which points belong to the robot.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    min_range: f32,
    /// Distance beyond which points do not count.
    #[param(unit = "m", default = 20.0, range = 0.1..=1000.0)]
    max_range: f32,
    /// Height above the robot's origin up to which points count: the robot passes beneath higher ones.
    #[param(unit = "m", default = 1.4, range = 0.0..=100.0)]
    max_height: f32,
    /// Number of rows that have to see a hazard.
    #[param(default = 2, range = 1..=64)]
    min_rings: u32,
    cells: Vec<Seen>,
}

/// Hazards in a direction, at about a distance.
#[derive(Debug, Clone, Copy)]
struct Seen {
    /// Nearest range, in m.
    range: f32,
    /// Rows that see it, one bit for each.
    rows: u64,
}

/// Length of a cell along a beam, in m, and greatest number of cells.
const CELL: f32 = 0.5;
const CELLS: usize = 400;

#[node]
impl ObstacleScan {
    fn process(&mut self, ctx: &Ctx, points: &Columns, labels: &Labels, scan: &mut Out<Scan>) {
        if !points.fits(labels) {
            return;
        }
        let count = self.beams.clamp(8, MOST);
        let step = TAU / f32::from(count);
        let out = scan.get_mut();
        out.stamp = ctx.now();
        (out.angle_min, out.angle_increment) = (-PI, step);
        (out.range_min, out.range_max) = (self.min_range, self.max_range);
        out.ranges.clear();
        out.ranges.extend((0..count).map(|_| f32::INFINITY));
        let cells = ((self.max_range / CELL) as usize + 2).min(CELLS);
        self.cells.clear();
        self.cells.resize(cells * usize::from(count), Seen { range: f32::INFINITY, rows: 0 });
        for (i, _) in labels.labels.iter().enumerate().filter(|(_, label)| label.is_hazard()) {
            let (x, y) = (points.x[i], points.y[i]);
            let range = libm::sqrtf(x * x + y * y);
            // False for NaN.
            let counts = range >= self.min_range && range <= self.max_range && points.z[i] <= self.max_height;
            if !counts {
                continue;
            }
            let beam = (libm::roundf((libm::atan2f(y, x) + PI) / step) as usize) % usize::from(count);
            let cell = &mut self.cells[beam * cells + ((range / CELL) as usize).min(cells - 1)];
            cell.range = cell.range.min(range);
            cell.rows |= 1 << (i % points.height % 64);
        }
        for (range, cells) in out.ranges.iter_mut().zip(self.cells.chunks_exact(cells)) {
            // What stands may be on the border of two cells.
            let counts =
                |pair: &&[Seen]| pair[0].rows != 0 && (pair[0].rows | pair[1].rows).count_ones() >= self.min_rings;
            *range = cells.windows(2).find(counts).map_or(f32::INFINITY, |pair| pair[0].range);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloud::{Label, columns::tests::dark};
    use apex_rt::{Construct, Time};

    #[test]
    fn the_nearest_hazard_of_each_direction_is_seen() {
        let points =
            [[2.0, 0.0, 0.5], [1.5, 0.0, 0.5], [1.0, 0.0, 0.0], [0.0, 3.0, 9.0], [0.0, -2.0, 1.0], [0.1, 0.0, 0.2]];
        let columns = dark(1, &points);
        let mut labels = Labels { height: 1, labels: vec![Label::Obstacle; 6] };
        labels.labels[2] = Label::Floor;
        let mut node = ObstacleScan::construct((360, 0.3, 20.0, 1.4, 1));
        let mut out = Out::new();
        node.process(&Ctx::new(Time::from_millis(70)), &columns, &labels, &mut out);
        let scan = out.get().expect("a scan");
        let seen: Vec<(i32, f32)> =
            scan.points().map(|(beam, p)| (libm::roundf(scan.angle(beam).to_degrees()) as i32, p.norm())).collect();
        assert_eq!((scan.stamp, seen.len()), (Time::from_millis(70), 2));
        assert!(seen[0].0 == -90 && (seen[0].1 - 2.0).abs() < 1e-5);
        assert!(seen[1].0 == 0 && (seen[1].1 - 1.5).abs() < 1e-5);
        assert!(scan.measures_anything() && scan.is_full_turn());
        // Two rows see one thing, and one row another one.
        let columns = dark(2, &[[2.0, 0.0, 0.9], [2.1, 0.0, 0.4], [0.0, 3.0, 0.4], [f32::NAN; 3]]);
        let labels =
            Labels { height: 2, labels: vec![Label::Obstacle, Label::Obstacle, Label::Obstacle, Label::Missing] };
        let mut node = ObstacleScan::construct((360, 0.3, 20.0, 1.4, 2));
        let mut out = Out::new();
        node.process(&Ctx::new(Time::ZERO), &columns, &labels, &mut out);
        let seen: Vec<f32> = out.get().expect("a scan").points().map(|(_, p)| p.norm()).collect();
        assert!(seen.len() == 1 && (seen[0] - 2.0).abs() < 1e-5, "{seen:?}");
        let mut out = Out::new();
        node.process(&Ctx::new(Time::ZERO), &columns, &Labels::default(), &mut out);
        assert!(out.get().is_none());
    }
}
