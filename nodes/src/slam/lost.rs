use super::{
    Pose, Window, heading,
    loops::{CHAIN, is_certain},
    matcher::Match,
    pose,
    scan_graph::ScanGraph,
};
use crate::scan::Point2;
use std::f64::consts::PI;

/// Minimum number of points of a scan that can contradict the map, or be found in it.
pub(super) const ENOUGH: usize = 20;
/// Distance between the places with which a scan is compared, in m.
const SPACING: f64 = 1.0;
/// Half of the width of the window around each of them, in m.
const AROUND: f64 = 0.8;
/// Number of places to each side of the path of the map, where it was seen to be free.
const ASIDE: i32 = 3;
/// Half of the angle in which a place has to be free for the scanner, in rad.
const CONE: f64 = 0.1;
/// Number of places with which a scan is compared at once.
const PLACES: usize = 2;
/// Number of points by which places are compared first.
const FEW: usize = 60;
/// Minimum response at a place of interest.
const LEAST: f64 = 0.5;
/// Maximum response at a second place, relative to the best one: where two places look alike, none is right for sure.
const RIVAL: f64 = 0.85;
/// Maximum distance and difference of the headings of two poses at the same place, in m and rad.
const SAME: (f64, f64) = (0.5, 0.3);

/// Place at which the robot may be.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Scan of the map from which it was seen.
    scan: usize,
    at: Pose,
}

impl Place {
    fn distance(&self, pose: &Pose) -> f64 {
        (self.at.translation.vector - pose.translation.vector).norm()
    }
}

/// Search for a lost robot on the map, and the scans that it has kept since.
#[derive(Debug, Clone)]
pub(super) struct Lost {
    /// The first scan that was kept since. Those before are the map.
    pub first: usize,
    /// The scan whose place is searched, or was searched last.
    asked: Option<usize>,
    /// Places that were not compared with it yet.
    places: Vec<Place>,
    /// Scans of the map at which it may have been taken, and its poses there.
    found: Vec<(usize, Match)>,
}

impl Lost {
    pub fn new(first: usize) -> Self {
        Self { first, asked: None, places: Vec::new(), found: Vec::new() }
    }

    /// The only place at which the scan can have been taken, if there is one.
    fn place(&self, least: f64) -> Option<&(usize, Match)> {
        let best = self.found.iter().max_by(|(_, a), (_, b)| a.response.total_cmp(&b.response))?;
        let is_rival = |other: &Match| {
            let offset = best.1.pose.inv_mul(&other.pose);
            let is_elsewhere = offset.translation.vector.norm() > SAME.0 || heading(&offset).abs() > SAME.1;
            is_elsewhere && other.response > RIVAL * best.1.response
        };
        let is_alone = !self.found.iter().any(|(_, other)| is_rival(other));
        (is_alone && best.1.response >= least && is_certain(&best.1)).then_some(best)
    }

    /// Compares the newest scan with some places of the map, at any heading, which takes some milliseconds. If it fits
    /// one place alone, all that was seen since the robot was lost gets to its place on the map: then the robot is not
    /// lost any more, and this returns `true`.
    pub fn search(&mut self, map: &mut ScanGraph) -> bool {
        if self.places.is_empty() {
            self.begin(map);
        }
        let Some(scan) = self.asked.filter(|_| !self.places.is_empty()) else { return false };
        let points = std::mem::take(&mut map.scans[scan]);
        for place in self.places.split_off(self.places.len().saturating_sub(PLACES)).into_iter().rev() {
            let found = find_at(&place, &points, map, self.first);
            self.found.extend(found.map(|found| (place.scan, found)));
        }
        map.scans[scan] = points;
        if !self.places.is_empty() {
            return false;
        }
        let place = self.place(map.settings.loop_response);
        if let Some((place, found)) = place {
            join(map, self.first, *place, scan, found);
        }
        place.is_some()
    }

    /// Begins to search the newest scan, unless that was done before.
    fn begin(&mut self, map: &ScanGraph) {
        let newest = map.last().filter(|newest| *newest >= self.first);
        if newest == self.asked {
            return;
        }
        self.asked = newest;
        self.found.clear();
        if let Some(scan) = newest.filter(|&scan| map.scans[scan].len() >= ENOUGH) {
            self.places = places(map, self.first, scan);
        }
    }
}

/// Places some distance from each other where the robot has been, or that it saw to be free, of the scans before one.
/// The nearest to another scan is the last.
fn places(map: &ScanGraph, first: usize, scan: usize) -> Vec<Place> {
    let poses = map.graph.poses();
    let mut places: Vec<Place> = Vec::new();
    for (scan, at) in poses.iter().copied().enumerate().take(first) {
        if is_apart(&places, &at) {
            places.push(Place { scan, at });
        }
    }
    for k in 0..places.len() {
        let Place { scan, at } = places[k];
        let seen: Vec<(f64, f64)> = map.scans[scan].iter().map(|p| (p.angle().into(), p.norm().into())).collect();
        let around = (-ASIDE..=ASIDE).flat_map(|x| (-ASIDE..=ASIDE).map(move |y| (x, y)));
        for (x, y) in around.map(|(x, y)| (SPACING * f64::from(x), SPACING * f64::from(y))) {
            let at = at * pose(x, y, 0.0);
            if is_apart(&places, &at) && is_free(&seen, x, y) {
                places.push(Place { scan, at });
            }
        }
    }
    places.sort_by(|a, b| b.distance(&poses[scan]).total_cmp(&a.distance(&poses[scan])));
    places
}

/// Finds the pose of a scan near a place.
fn find_at(place: &Place, points: &[Point2], map: &mut ScanGraph, end: usize) -> Option<Match> {
    let chain = || place.scan.saturating_sub(CHAIN)..(place.scan + CHAIN + 1).min(end);
    let few: Vec<Point2> = points.iter().step_by((points.len() / FEW).max(1)).copied().collect();
    let roughly = Window { distance: AROUND, angle: PI };
    let found = map.compare(&few, &place.at, chain(), &roughly, LEAST)?;
    let nearly = Window { distance: 0.2, angle: 0.05 };
    map.compare(points, &found.pose, chain(), &nearly, LEAST)
}

/// Moves all that was seen since the robot was lost to its place on the map.
fn join(map: &mut ScanGraph, first: usize, place: usize, scan: usize, found: &Match) {
    let moved: Pose = found.pose * map.graph.poses()[scan].inverse();
    map.graph.move_from(first, &moved);
    map.connect(place, scan, &found.pose, found.information);
    map.spread.carry(scan, first, map.graph.poses());
}

/// Returns `true` if no place is near a pose.
fn is_apart(places: &[Place], pose: &Pose) -> bool {
    places.iter().all(|place| place.distance(pose) >= 0.999 * SPACING)
}

/// Returns `true` if the scanner saw something behind a position and nothing before it. The position is in m in the
/// frame of the robot, what was seen are angles and distances.
fn is_free(seen: &[(f64, f64)], x: f64, y: f64) -> bool {
    let (distance, direction) = (x.hypot(y), y.atan2(x));
    let turn = |angle: f64| (angle - direction + PI).rem_euclid(2.0 * PI) - PI;
    let mut toward = seen.iter().filter(|(angle, _)| turn(*angle).abs() < CONE).peekable();
    toward.peek().is_some() && toward.all(|(_, range)| *range > distance)
}
