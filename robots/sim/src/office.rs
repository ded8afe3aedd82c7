use crate::Random;
use apex_nodes::scan::Point2;
use std::fmt::Write as _;

/// Size of the building, in m.
const SIZE: (f32, f32) = (60.0, 30.0);
/// Thickness of outer and inner walls, in m.
const OUTER: f32 = 0.4;
const INNER: f32 = 0.2;
/// Width of a door, in m.
const DOOR: f32 = 1.0;

/// Rectangle with sides along the axes: x and y from and to, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Area {
    x: [f32; 2],
    y: [f32; 2],
}

/// Floor of an office building of 60 m × 30 m: corridors, a hall, and rooms of different sizes with open doors.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OfficePlan {
    /// Free areas: rooms, corridors, and passages of doors. What is not free is wall.
    free: Vec<Area>,
    /// Solid areas in rooms and corridors.
    pillars: Vec<Area>,
    /// Hinge and free end of the leaf of each door.
    leaves: Vec<(Point2, Point2)>,
}

impl OfficePlan {
    /// Draws a floor. The seed determines the sizes of the rooms and the places of the doors.
    pub fn new(seed: u64) -> Self {
        let mut plan = Self::default();
        let mut random = Random::new(seed);
        let (right, top) = (SIZE.0 - OUTER, SIZE.1 - OUTER);
        let corridors = [Area { x: [OUTER, right], y: [7.2, 9.6] }, Area { x: [OUTER, right], y: [20.6, 23.0] }];
        let hall = Area { x: [OUTER, 7.0], y: [9.6, 20.6] };
        let crossings = [Area { x: [20.0, 22.2], y: [9.6, 20.6] }, Area { x: [44.0, 46.6], y: [9.6, 20.6] }];
        plan.free.extend(corridors.iter().chain(&crossings).chain([&hall]));
        plan.rooms([OUTER, right], [OUTER, 7.0], 7.2, &mut random);
        plan.rooms([OUTER, right], [23.2, top], 23.0, &mut random);
        for x in [[7.2, 19.8], [22.4, 43.8], [46.8, right]] {
            plan.rooms(x, [9.8, 14.6], 9.6, &mut random);
            plan.rooms(x, [14.8, 20.4], 20.6, &mut random);
        }
        for y in [12.0, 17.5] {
            plan.pillars.push(Area { x: [3.4, 3.9], y: [y, y + 0.5] });
        }
        plan
    }

    /// Adds a row of rooms with a door each in the wall towards the corridor, which begins at `corridor`.
    fn rooms(&mut self, x: [f32; 2], y: [f32; 2], corridor: f32, random: &mut Random) {
        let mut from = x[0];
        while from < x[1] {
            let wide = random.uniform(2.8, 7.5);
            // What is left for the next room must be wide enough for it.
            let to = if x[1] - from - wide < 3.2 { x[1] } else { from + (wide * 20.0).round() / 20.0 };
            self.free.push(Area { x: [from, to], y });
            let hinge = from + 0.3 + (random.uniform(0.0, to - from - DOOR - 0.6) * 20.0).round() / 20.0;
            let is_below = corridor >= y[1];
            let passage = if is_below { [y[1], corridor] } else { [corridor, y[0]] };
            self.free.push(Area { x: [hinge, hinge + DOOR], y: passage });
            let (wall, open) = if is_below { (y[1], -DOOR) } else { (y[0], DOOR) };
            self.leaves.push((Point2::new(hinge, wall), Point2::new(hinge, wall + open)));
            from = to + INNER;
        }
    }

    fn is_free(&self, x: f32, y: f32) -> bool {
        let holds = |area: &Area| area.x[0] < x && x < area.x[1] && area.y[0] < y && y < area.y[1];
        self.free.iter().any(holds) && !self.pillars.iter().any(holds)
    }

    /// Walls: all sides between free and solid areas, each as long as possible, and the outline of the building.
    pub fn walls(&self) -> Vec<(Point2, Point2)> {
        let areas = || self.free.iter().chain(&self.pillars);
        let (xs, ys) = (edges(areas().flat_map(|a| a.x), SIZE.0), edges(areas().flat_map(|a| a.y), SIZE.1));
        let middle = |values: &[f32], i: usize| 0.5 * (values[i] + values[i + 1]);
        let mut walls = vec![];
        for (i, &y) in ys.iter().enumerate().skip(1).take(ys.len() - 2) {
            let (below, above) = (middle(&ys, i - 1), middle(&ys, i));
            let is_wall = |x: f32| self.is_free(x, below) != self.is_free(x, above);
            walls.extend(runs(&xs, is_wall).map(|(from, to)| (Point2::new(from, y), Point2::new(to, y))));
        }
        for (i, &x) in xs.iter().enumerate().skip(1).take(xs.len() - 2) {
            let (left, right) = (middle(&xs, i - 1), middle(&xs, i));
            let is_wall = |y: f32| self.is_free(left, y) != self.is_free(right, y);
            walls.extend(runs(&ys, is_wall).map(|(from, to)| (Point2::new(x, from), Point2::new(x, to))));
        }
        let corners = [(0.0, 0.0), (SIZE.0, 0.0), SIZE, (0.0, SIZE.1)].map(|(x, y)| Point2::new(x, y));
        walls.extend((0..4).map(|i| (corners[i], corners[(i + 1) % 4])));
        walls
    }

    /// Plan as the text of a DXF file (release 12) in metres, with the layers `walls` and `doors`. A door is its open
    /// leaf and the arc of its free end.
    pub fn dxf(&self) -> String {
        let mut text = "0\nSECTION\n2\nENTITIES\n".to_owned();
        for (layer, lines) in [("walls", &self.walls()), ("doors", &self.leaves)] {
            for (a, b) in lines {
                line(&mut text, layer, *a, *b);
            }
        }
        for (hinge, end) in &self.leaves {
            let (from, to) = if end.y > hinge.y { (0, 90) } else { (270, 360) };
            let Point2 { x, y } = hinge;
            // Writing to a string cannot fail.
            let _ = write!(text, "0\nARC\n8\ndoors\n10\n{x:.3}\n20\n{y:.3}\n40\n{DOOR:.3}\n50\n{from}\n51\n{to}\n");
        }
        text + "0\nENDSEC\n0\nEOF\n"
    }

    /// Walls as the text of a table: `x1,y1,x2,y2` in metres.
    pub fn table(&self) -> String {
        let row = |(a, b): &(Point2, Point2)| format!("{:.3},{:.3},{:.3},{:.3}\n", a.x, a.y, b.x, b.y);
        self.walls().iter().map(row).collect()
    }
}

fn line(text: &mut String, layer: &str, a: Point2, b: Point2) {
    let _ = write!(text, "0\nLINE\n8\n{layer}\n10\n{:.3}\n20\n{:.3}\n11\n{:.3}\n21\n{:.3}\n", a.x, a.y, b.x, b.y);
}

/// Sorted different values, with the ends of the building.
fn edges(values: impl Iterator<Item = f32>, end: f32) -> Vec<f32> {
    let mut values: Vec<f32> = values.chain([0.0, end]).collect();
    values.sort_by(f32::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() < 1e-3);
    values
}

/// Longest runs of intervals between consecutive values for whose middle `holds` is true.
fn runs(values: &[f32], holds: impl Fn(f32) -> bool) -> impl Iterator<Item = (f32, f32)> {
    let mut found: Vec<(f32, f32)> = vec![];
    for pair in values.windows(2) {
        if holds(0.5 * (pair[0] + pair[1])) {
            match found.last_mut() {
                Some(last) if last.1 == pair[0] => last.1 = pair[1],
                _ => found.push((pair[0], pair[1])),
            }
        }
    }
    found.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_floor_has_rooms_with_doors() {
        let plan = OfficePlan::new(1);
        assert!(plan.leaves.len() > 30, "{} rooms", plan.leaves.len());
        for (hinge, end) in &plan.leaves {
            assert!(plan.is_free(end.x + 0.1, end.y), "a leaf ends in its room");
            assert!(plan.is_free(hinge.x + 0.1, hinge.y + (hinge.y - end.y) * 0.5), "the corridor is behind the door");
        }
        assert_eq!(OfficePlan::new(1), plan);
        assert_ne!(OfficePlan::new(2), plan);
    }

    #[test]
    fn walls_surround_what_is_free() {
        let plan = OfficePlan { free: vec![Area { x: [1.0, 3.0], y: [1.0, 2.0] }], ..OfficePlan::default() };
        assert_eq!(plan.walls().len(), 8, "the sides of the room and of the building");
    }
}
