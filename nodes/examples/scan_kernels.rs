//! Measures the kernels of scans, maps and planning: `scan_kernels [ROUNDS [KERNEL…]]` prints the CPU time of the
//! thread for each, or for those with one of these words, beside the same work as an expert writes it by hand for this
//! case alone, or beside another library.
//!
//! Both versions run in turn in each round; the result is the median of the rounds. Their results are compared.

use apex_nodes::{
    localize::{Filter, Settings, TableSettings, VisibilityTable},
    map::{Cell, DistanceTransform, Grid, Occupancy, OccupancyBuilder, Raster, VectorMap},
    math::Random,
    nav::{Articulated, CurveDrive, CurveSearch, Goal, Ground, Search, Start, Terrain},
    scan::{BeamDirections, Point2, Pose2, Scan},
};
use measure::{cpu_time, median};
use std::{f32::consts::PI, hash::Hasher, hint::black_box};

#[path = "kernels/measure.rs"]
mod measure;

const BEAMS: usize = 541;
/// Number of scans of a map.
const SCANS: usize = 118;
const RESOLUTION: f32 = 0.05;

/// Word that selects a kernel, and the function that measures it in this number of rounds.
type Kernel = (&'static str, fn(usize));

const KERNELS: [Kernel; 6] = [
    ("turn", turn_a_scan),
    ("rays", count_rays),
    ("cells", search_cells),
    ("distances", measure_distances),
    ("particles", weigh_particles),
    ("curves", search_curves),
];

fn main() {
    let mut words = std::env::args().skip(1);
    let rounds = words.next().and_then(|word| word.parse().ok()).unwrap_or(21);
    let words: Vec<String> = words.collect();
    println!("{:44}{:>12}{:>12}{:>8}{:>7}", "kernel", "Apex", "by hand", "ratio", "goal");
    for (name, measure) in KERNELS {
        if words.is_empty() || words.iter().any(|word| word == name) {
            measure(rounds);
        }
    }
}

/// CPU time of a run in µs: the mean of so many runs that the clock does not matter.
fn timed(times: usize, mut run: impl FnMut()) -> f64 {
    let start = cpu_time();
    (0..times).for_each(|_| run());
    1e-3 * (cpu_time() - start) / times as f64
}

/// Measures both versions in turn and prints a row.
fn row(name: &str, goal: f64, rounds: usize, times: usize, mut apex: impl FnMut(), mut hand: impl FnMut()) {
    let (mut ours, mut theirs, mut ratios) = (vec![], vec![], vec![]);
    for _ in 0..=rounds {
        let (a, h) = (timed(times, &mut apex), timed(times, &mut hand));
        ours.push(a);
        theirs.push(h);
        ratios.push(a / h);
    }
    let (a, h, ratio) = (median(ours), median(theirs), median(ratios));
    println!("{name:44}{a:9.2} µs{h:9.2} µs{ratio:8.2}{goal:7.1}");
}

/// Room of 20 m × 14 m around the origin with four pillars.
fn range(from: Point2, direction: Point2) -> f32 {
    let wall = |from: f32, d: f32, half: f32| if d == 0.0 { f32::MAX } else { (half.copysign(d) - from) / d };
    let mut range = wall(from.x, direction.x, 10.0).min(wall(from.y, direction.y, 7.0));
    for (x, y) in [(4.0, 3.0), (-4.0, 3.0), (-4.0, -3.0), (4.0, -3.0)] {
        let pillar = Point2::new(x, y) - from;
        let (along, aside) = (pillar.dot(direction), pillar.dot(direction.perpendicular()));
        if aside.abs() < 0.4 && along > 0.0 {
            range = range.min(along - (0.16 - aside * aside).sqrt());
        }
    }
    range
}

fn scan(at: &Pose2, random: &mut Random) -> Scan {
    let mut scan =
        Scan { angle_min: -0.75 * PI, angle_increment: 1.5 * PI / 540.0, range_max: 30.0, ..Scan::default() };
    for beam in 0..BEAMS {
        let range = range(at.position(), Point2::polar(1.0, at.theta + scan.angle(beam)));
        scan.ranges.push(range + random.normal(0.01)).expect("few beams");
    }
    scan
}

/// Pose on a round through the room.
fn place(step: usize) -> Pose2 {
    let turn = 0.08 * step as f32;
    Pose2::new(7.0 * turn.cos(), 5.0 * turn.sin(), turn + 0.5 * PI)
}

fn turn_a_scan(rounds: usize) {
    let scan = scan(&place(0), &mut Random::new(1));
    let at = Pose2::new(3.0, -2.0, 0.7);
    let mut points = vec![Point2::default(); BEAMS];
    let directions: Vec<Point2> = (0..BEAMS).map(|beam| Point2::polar(1.0, scan.angle(beam))).collect();
    let mut expected = points.clone();
    let mut beams = BeamDirections::default();
    row(
        "points of a scan of 541 beams, turned",
        1.0,
        rounds,
        2000,
        || {
            points.clear();
            let frame = at.transform();
            points.extend(beams.points(black_box(&scan)).map(|(_, point)| frame.to_outer(point)));
            black_box(&points);
        },
        || {
            let scan = black_box(&scan);
            let (sin, cos) = at.theta.sin_cos();
            expected.clear();
            expected.extend(scan.ranges.iter().zip(&directions).filter(|(r, _)| scan.is_measured(**r)).map(
                |(r, d)| {
                    let (x, y) = (r * d.x, r * d.y);
                    Point2::new(at.x + (cos * x - sin * y), at.y + (sin * x + cos * y))
                },
            ));
            black_box(&expected);
        },
    );
    assert!(points.len() == expected.len() && points.iter().zip(&expected).all(|(a, b)| (*a - *b).norm() < 1e-4));
}

/// Scans on a round with their positions, in the frame of the room.
fn posed(count: usize) -> Vec<(Point2, Vec<Point2>)> {
    let mut random = Random::new(2);
    let seen = |step| {
        let at = place(step);
        (at.position(), scan(&at, &mut random).points().map(|(_, point)| at.to_outer(point)).collect())
    };
    (0..count).map(seen).collect()
}

/// Rays counted by hand: passes and hits of each cell, side by side.
struct Hand {
    raster: Raster,
    counts: Vec<[u32; 2]>,
}

impl Hand {
    fn add(&mut self, from: Point2, to: Point2) {
        let Raster { corner, resolution, width, .. } = self.raster;
        let cell = |p: Point2| (((p.x - corner.x) / resolution) as i32, ((p.y - corner.y) / resolution) as i32);
        let ((x, y), (end_x, end_y)) = (cell(from), cell(to));
        let (dx, dy) = ((end_x - x).abs(), (end_y - y).abs());
        let (right, up) = ((end_x - x).signum() as isize, (end_y - y).signum() as isize * width as isize);
        let (mut at, mut error) = (y as isize * width as isize + x as isize, dx - dy);
        for _ in 0..=dx.max(dy) {
            self.counts[at as usize][0] += 1;
            let twice = 2 * error;
            if twice > -dy {
                error -= dy;
                at += right;
            }
            if twice < dx {
                error += dx;
                at += up;
            }
        }
        self.counts[end_y as usize * width + end_x as usize][1] += 1;
    }
}

fn count_rays(rounds: usize) {
    let scans = posed(SCANS);
    let all = || scans.iter().flat_map(|(from, points)| points.iter().map(|to| (*from, *to)));
    let raster = Raster::around(all().flat_map(|(a, b)| [a, b]), 0.5, RESOLUTION);
    let mut builder = OccupancyBuilder::default();
    let mut hand = Hand { raster, counts: vec![] };
    row(
        "rays of 118 scans, counted",
        1.1,
        rounds,
        1,
        || {
            builder.reset(raster).expect("a room");
            all().for_each(|(from, to)| builder.add(from, to));
        },
        || {
            hand.counts.clear();
            hand.counts.resize(raster.width * raster.height, [0; 2]);
            all().for_each(|(from, to)| hand.add(from, to));
        },
    );
    let counts = builder.counts().cells().iter().map(|count| [count.passes, count.hits]);
    assert!(counts.eq(hand.counts.iter().copied()));
}

/// Hall of 40 m × 30 m with random boxes.
fn hall(boxes: usize) -> Grid<Occupancy> {
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 400, height: 300 };
    let mut map = Grid::new(raster, Occupancy::Free).expect("a hall");
    let mut random = Random::new(3);
    let mut fill = |x: usize, y: usize, width: usize, height: usize| {
        for (x, y) in (x..x + width).flat_map(|x| (y..y + height).map(move |y| (x, y))) {
            if let Some(cell) = map.get_mut(Cell::new(x, y)) {
                *cell = Occupancy::Occupied;
            }
        }
    };
    for (x, y, width, height) in [(0, 0, 400, 1), (0, 299, 400, 1), (0, 0, 1, 300), (399, 0, 1, 300)] {
        fill(x, y, width, height);
    }
    for _ in 0..boxes {
        let side = |random: &mut Random| 5 + random.below(25) as usize;
        let (x, y) = (random.below(400) as usize, random.below(300) as usize);
        fill(x, y, side(&mut random), side(&mut random));
    }
    map
}

fn search_cells(rounds: usize) {
    let map = hall(60);
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let open = |from: Cell| {
        let cells = (from.y..300).flat_map(|y| (from.x..400).map(move |x| Cell::new(x, y)));
        cells.into_iter().find(|cell| terrain.is_open(*cell)).expect("free floor")
    };
    let (start, goal) = (open(Cell::new(3, 3)), open(Cell::new(390, 290)));
    let (mut search, mut path, mut length, mut other) = (Search::default(), vec![], 0.0, 0);
    let neighbours = |&(x, y): &(i32, i32)| {
        let is_open = |x: i32, y: i32| terrain.is_open(Cell::new(x as usize, y as usize));
        let steps = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)];
        let reachable = steps.into_iter().filter(|(dx, dy)| {
            is_open(x + dx, y + dy) && (*dx == 0 || *dy == 0 || is_open(x + dx, y) && is_open(x, y + dy))
        });
        reachable.map(|(dx, dy)| ((x + dx, y + dy), if dx != 0 && dy != 0 { 14142 } else { 10000 })).collect::<Vec<_>>()
    };
    row(
        "A* over 120,000 cells (pathfinding)",
        1.1,
        rounds,
        1,
        || length = search.run(&terrain, start, goal, &mut path).expect("a way"),
        || {
            let end = (goal.x as i32, goal.y as i32);
            let rest = |&(x, y): &(i32, i32)| {
                let (dx, dy) = ((x - end.0).abs(), (y - end.1).abs());
                4142 * dx.min(dy) + 10000 * dx.max(dy)
            };
            let start = (start.x as i32, start.y as i32);
            other = pathfinding::prelude::astar(&start, neighbours, rest, |at| *at == end).expect("a way").1;
        },
    );
    assert!((length - f64::from(other) * 1e-5).abs() < 0.01, "{length} {other}");
}

/// Distances of a row or column by hand (Felzenszwalb and Huttenlocher), from squares to squares.
fn lower_envelope(squares: &[f32], out: &mut [f32], feet: &mut [usize], from: &mut [f32]) {
    let mut k = 0;
    (feet[0], from[0], from[1]) = (0, f32::NEG_INFINITY, f32::INFINITY);
    let crossing = |a: usize, b: usize| {
        ((squares[b] + (b * b) as f32) - (squares[a] + (a * a) as f32)) / (2.0 * (b as f32 - a as f32))
    };
    for x in 1..squares.len() {
        let mut begin = crossing(feet[k], x);
        while begin <= from[k] {
            k -= 1;
            begin = crossing(feet[k], x);
        }
        k += 1;
        (feet[k], from[k], from[k + 1]) = (x, begin, f32::INFINITY);
    }
    let mut k = 0;
    for (x, out) in out.iter_mut().enumerate() {
        while from[k + 1] < x as f32 {
            k += 1;
        }
        let away = x as f32 - feet[k] as f32;
        *out = away * away + squares[feet[k]];
    }
}

fn measure_distances(rounds: usize) {
    let map = hall(60);
    let (width, height) = (400, 300);
    let (mut transform, mut distances) = (DistanceTransform::default(), Grid::default());
    let (mut squares, mut out) = (vec![0.0; width * height], vec![0.0; width * height]);
    row(
        "exact distances of 120,000 cells",
        1.1,
        rounds,
        1,
        || transform.run(&map, |cell| cell.is_obstacle(), &mut distances),
        || {
            let far = |cell: &Occupancy| if cell.is_obstacle() { 0.0 } else { 1e6 };
            squares.iter_mut().zip(map.cells()).for_each(|(square, cell)| *square = far(cell));
            let (mut feet, mut from) = (vec![0; 401], vec![0.0; 402]);
            let (mut column, mut done) = (vec![0.0; height], vec![0.0; height]);
            for x in 0..width {
                column.iter_mut().enumerate().for_each(|(y, value)| *value = squares[y * width + x]);
                lower_envelope(&column, &mut done, &mut feet, &mut from);
                done.iter().enumerate().for_each(|(y, value)| squares[y * width + x] = *value);
            }
            for (row, out) in squares.chunks(width).zip(out.chunks_mut(width)) {
                lower_envelope(row, out, &mut feet, &mut from);
                out.iter_mut().for_each(|square| *square = 0.1 * square.sqrt());
            }
        },
    );
    assert!(distances.cells().iter().zip(&out).all(|(a, b)| (a - b).abs() < 1e-3));
}

/// Plan of a building: a room of 20 m × 20 m with 40 random walls.
fn plan() -> VectorMap {
    let (mut map, mut random) = (VectorMap::default(), Random::new(5));
    let corners = [(0.0, 0.0), (20.0, 0.0), (20.0, 20.0), (0.0, 20.0)].map(|(x, y)| Point2::new(x, y));
    for i in 0..4 {
        map.add(corners[i], corners[(i + 1) % 4]).expect("a wall");
    }
    for _ in 0..40 {
        let a = Point2::new(random.uniform(0.0, 20.0), random.uniform(0.0, 20.0));
        map.add(a, a + Point2::polar(random.uniform(0.5, 4.0), random.uniform(-PI, PI))).expect("a wall");
    }
    map
}

fn weigh_particles(rounds: usize) {
    let table = VisibilityTable::build(&plan(), TableSettings::default(), |_| ()).expect("a table");
    let settings = Settings { particles: [1000, 1000], travel: 0.0, ..Settings::default() };
    let mut filter = Filter::new(table.clone(), settings);
    let (mut truth, mut odometry) = (Pose2::new(9.0, 9.0, 0.3), Pose2::default());
    let step = Pose2::new(0.05, 0.0, 0.02);
    filter.begin(&truth, &odometry, (0.1, 0.05));
    let mut times = vec![];
    for round in 0..20 + 4 * rounds {
        let mut scan =
            Scan { angle_min: -0.75 * PI, angle_increment: 1.5 * PI / 540.0, range_max: 30.0, ..Scan::default() };
        let view = table.view(truth.position()).expect("inside");
        scan.ranges.extend((0..BEAMS).map(|beam| {
            let angle = truth.theta + 1.5 * PI * (beam as f32 / 540.0 - 0.5);
            view.range(Point2::polar(1.0, angle), angle)
        }));
        let time = timed(1, || _ = filter.update(&odometry, &scan));
        if round >= 20 {
            times.push(time);
        }
        (truth, odometry) = (truth.compose(&step), odometry.compose(&step));
    }
    let error = (filter.pose_at(&odometry).position() - truth.position()).norm();
    assert!(filter.is_localized() && error < 0.1, "{error} m");
    println!("{:44}{:9.2} µs     goal 500 µs, error {error:.3} m", "particle filter, 1000 × 30 beams", median(times));
}

/// Random poses of a vehicle, 12 m apart and at least 1.8 m from what is not free.
fn tasks(map: &Grid<Occupancy>, count: usize) -> Vec<(Pose2, Pose2)> {
    let mut distances = Grid::default();
    DistanceTransform::default().run(map, |cell| cell.is_obstacle(), &mut distances);
    let mut random = Random::new(6);
    let mut tasks = vec![];
    while tasks.len() < count {
        let mut pose = || {
            let heading = random.uniform(-PI, PI);
            Pose2::new(random.uniform(0.0, 40.0), random.uniform(0.0, 30.0), heading)
        };
        let (from, to) = (pose(), pose());
        let is_free = |pose: &Pose2| distances.at(pose.position()).is_some_and(|distance| *distance >= 1.8);
        let apart = (from.position() - to.position()).norm();
        if is_free(&from) && is_free(&to) && (11.5..12.5).contains(&apart) {
            tasks.push((from, to));
        }
    }
    tasks
}

fn search_curves(_rounds: usize) {
    let vehicle = CurveDrive {
        radius: 0.8,
        shape: Articulated::PATSY,
        load: [1.2, 0.7],
        margin: 0.1,
        backing_gain: 2.5,
        straight: 0.0,
        comes_straight: false,
        short: 0.0,
    };
    let map = hall(60);
    for (name, straight) in [("lattice search, 12 m", 0.0), ("lattice search, 12 m, trailer in line", 1.5)] {
        curves(name, &map, &CurveDrive { straight, ..vehicle }, &tasks(&map, 60));
    }
    // The goal is in a room whose door is too narrow.
    let mut closed = hall(0);
    for i in 0..60 {
        *closed.get_mut(Cell::new(60, i)).expect("inside") = Occupancy::Occupied;
        if !(20..28).contains(&i) {
            *closed.get_mut(Cell::new(i, 60)).expect("inside") = Occupancy::Occupied;
        }
    }
    let hopeless: Vec<_> =
        (0..5).map(|i| (Pose2::new(20.0 + 3.0 * i as f32, 20.0, 0.5), Pose2::new(2.4, 2.0, -0.5 * PI))).collect();
    curves("lattice search, gives up", &closed, &vehicle, &hopeless);
}

/// Prints the times of searches, and a checksum of the ways that were found.
fn curves(name: &str, map: &Grid<Occupancy>, vehicle: &CurveDrive, tasks: &[(Pose2, Pose2)]) {
    let ground = Ground { terrain: Terrain { map, costs: None, unknown_is_open: false }, floor: None };
    let (mut search, mut found) = (CurveSearch::default(), 0);
    let mut sum = std::hash::DefaultHasher::new();
    let mut times = vec![];
    for (from, to) in tasks {
        let start = Start { pose: *from, trailer: from.theta, is_back: false };
        let mut way = None;
        times.push(timed(1, || {
            way = search.plan(&ground, vehicle, &start, &[Goal { pose: *to, cost: 0.0 }]).ok();
        }));
        found += usize::from(way.is_some());
        sum.write(format!("{way:?}").as_bytes());
    }
    times.sort_by(f64::total_cmp);
    let [middle, late, last] = [times.len() / 2, times.len() * 9 / 10, times.len() - 1].map(|i| times[i] * 1e-3);
    let (count, sum) = (tasks.len(), sum.finish());
    println!("{name:44}median {middle:.1}, p90 {late:.1}, longest {last:.1} ms; {found} of {count} ways, {sum:016x}");
}
