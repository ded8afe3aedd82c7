//! Errors of the pose of a cart by its distance, found in the scan alone and verified in the point cloud (thesis
//! 6.10.2, figure 6.24).

use super::{
    chart::{Curve, Panel},
    evaluate::pose_error,
};
use crate::{BODY, Detector, Finder, LENGTH, Search, TOP, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH, world::Cart};
use apex_nodes::{
    cloud::{ClusterCloud, VerifyContainer},
    scan::{Container, Pose2, Scan},
};
use apex_rt::{Construct as _, Out, Time};
use apex_sim::{
    Laser, Random, World, in_order,
    tof::{Distortion, Floor, Material, Shape, Solid, SolidKind, Space, TofCamera, TofFrame},
};
use core::{
    f32::consts::{FRAC_PI_2, PI},
    fmt,
    hint::black_box,
    num::NonZero,
};
use std::{io, time::Instant};

/// Distances from the scanner to the near face of the cart, in m.
const DISTANCES: [f32; 5] = [1.0, 1.5, 2.0, 2.5, 3.0];

/// Number of rounds of a computing time.
const ROUNDS: u32 = 20;

/// Errors at one distance.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// Distance from the scanner to the near face, in m.
    pub distance: f32,
    /// Number of carts.
    pub carts: usize,
    /// Number of carts with a detection in the scan.
    pub found: usize,
    /// Errors of the verified carts, in the frame of the cart: in the scan alone, and with the cloud.
    pub errors: Vec<[Pose2; 2]>,
    /// Computing times of clustering and of verification, in s.
    pub times: Vec<[f64; 2]>,
}

/// Errors at all distances, of one cart for each seed. The seed gives its pose, the directions of its castors, the
/// static errors of the camera, and the noise.
///
/// # Errors
/// If a thread cannot be started.
pub fn accuracy(seeds: &[u64], threads: Option<NonZero<usize>>) -> io::Result<Vec<Row>> {
    DISTANCES
        .iter()
        .map(|distance| {
            let trials = in_order(seeds, threads, |seed| Trial::run(*seed, *distance), |_| {})?;
            Ok(Row {
                distance: *distance,
                carts: trials.len(),
                found: trials.iter().filter(|trial| trial.is_found).count(),
                errors: trials.iter().filter_map(|trial| trial.errors).collect(),
                times: trials.iter().filter_map(|trial| trial.times).collect(),
            })
        })
        .collect()
}

/// Errors with one cart.
#[derive(Debug, Clone, Copy, Default)]
struct Trial {
    is_found: bool,
    errors: Option<[Pose2; 2]>,
    times: Option<[f64; 2]>,
}

impl Trial {
    fn run(seed: u64, distance: f32) -> Self {
        let mut random = Random::new(seed);
        let truth = Pose2::new(distance + 0.5 * LENGTH, random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15));
        // Pushed into its place, so that the castors trail, or turned there.
        let is_pushed = random.chance(0.5);
        let ahead = if random.chance(0.5) { 0.0 } else { PI };
        let castors = [0; 4].map(|_| {
            let off = random.uniform(-FRAC_PI_2, FRAC_PI_2);
            truth.theta + ahead + if is_pushed { 0.1 * off } else { off }
        });
        let Some(container) = find(&truth, castors, &mut random) else { return Self::default() };
        let (verified, times) = verify(&truth, castors, &container, &mut random);
        let errors = verified.map(|found| [container, found].map(|found| pose_error(&found.pose, &truth)));
        Self { is_found: true, errors, times }
    }
}

/// Cart in the scan.
fn find(truth: &Pose2, castors: [f32; 4], random: &mut Random) -> Option<Container> {
    let (mut world, mut scan) = (World::default(), Scan::default());
    world.block(&Pose2::new(2.0, 0.0, 0.0), 9.0, 7.0);
    Cart::new(*truth, castors).add_to(&mut world);
    Laser::default().measure(&world, &Pose2::default(), random, &mut scan);
    Finder::new(&Search::CART).find(&scan).ok().flatten()
}

/// Cart in the cloud, and the times of clustering and verification.
fn verify(
    truth: &Pose2,
    castors: [f32; 4],
    container: &Container,
    random: &mut Random,
) -> (Option<Container>, Option<[f64; 2]>) {
    let (space, mut frame) = (space(truth, castors), TofFrame::default());
    let camera = TofCamera { distortion: Distortion::random(random), ..TofCamera::default() };
    camera.take(&space, &Pose2::default(), Time::ZERO, random, &mut frame);
    let mut detector = Detector::default();
    let Some((columns, labels, _)) = detector.detect(&frame.cloud) else { return (None, None) };
    let (mut cluster, mut clusters) = (ClusterCloud::construct((0.05, 5.0, 20, 3.0)), Out::new());
    let clustered = timed(|| cluster.process(columns, labels, &mut clusters)).1;
    let Some(clusters) = clusters.get() else { return (None, None) };
    let mut node = VerifyContainer::construct((LENGTH, WIDTH, BODY, 0.05, 0.05, 100, 0.1, WHEEL_BOXES));
    let (verified, time) = timed(|| node.process(columns, clusters, container));
    (verified, Some([clustered, time]))
}

/// Result of some work, and the mean computing time of several rounds, in s. The first one, which allocates, does not
/// count.
fn timed<T>(mut work: impl FnMut() -> T) -> (T, f64) {
    let result = work();
    let start = Instant::now();
    (0..ROUNDS).for_each(|_| drop(black_box(work())));
    (result, start.elapsed().as_secs_f64() / f64::from(ROUNDS))
}

/// Cart in a room with a back wall, for the camera.
fn space(truth: &Pose2, castors: [f32; 4]) -> Space {
    let mut space = Space::new(Floor::default());
    let mut block = |pose: &Pose2, size: [f32; 3], bottom: f32, albedo: f32, kind| {
        let shape = Shape::Block { centre: [pose.x, pose.y, bottom + 0.5 * size[2]], size, yaw: pose.theta };
        space.add(Solid { shape, material: Material { albedo, retro: 0.0, transmission: 0.0 }, kind });
    };
    block(truth, [LENGTH, WIDTH, TOP - BODY], BODY, 0.5, SolidKind::Overhanging);
    for (wheel, castor) in Cart::new(*truth, castors).wheels() {
        block(
            &Pose2::new(wheel.x, wheel.y, castor),
            [WHEEL_LENGTH, WHEEL_WIDTH, WHEEL_LENGTH],
            0.0,
            0.2,
            SolidKind::Object,
        );
    }
    block(&Pose2::new(6.6, 0.0, 0.0), [0.2, 8.0, 2.5], 0.0, 0.6, SolidKind::Object);
    space
}

/// Table of the mean absolute errors of the verified carts, and of the mean computing times.
pub fn table(rows: &[Row]) -> String {
    let head = ["x, 2D (cm)", "x, 3D (cm)", "y, 2D (cm)", "y, 3D (cm)", "turn, 2D (°)", "turn, 3D (°)"];
    let mut text = format!("{:>12}{:>8}{:>10}", "distance (m)", "found", "verified");
    head.iter().for_each(|name| text += &format!("{name:>14}"));
    text += &format!("{:>17}{:>18}\n", "clustering (ms)", "verification (ms)");
    rows.iter().for_each(|row| text += &format!("{row}\n"));
    text
}

/// Mean absolute errors along and across by distance, in the scan alone and with the cloud (figure 6.24).
pub fn figure(rows: &[Row]) -> Vec<Panel> {
    let panel = |name: &str, value: fn(&Pose2) -> f32| {
        let curve = |(method, name): (usize, &str)| {
            let points = rows.iter().map(|row| [row.distance, row.mean_error(method, value) as f32]);
            Curve { name: name.to_owned(), points: points.collect() }
        };
        let axes = ["distance (m)".to_owned(), format!("mean error along {name} (cm)")];
        let curves = [(0, "2D"), (1, "2D and 3D")].map(curve).to_vec();
        Panel { axes, is_logarithmic: false, mark: None, curves }
    };
    vec![panel("x", |e| 100.0 * e.x), panel("y", |e| 100.0 * e.y)]
}

impl Row {
    /// Mean absolute value of an error, in the scan alone (`method` 0) or with the cloud (1).
    fn mean_error(&self, method: usize, value: fn(&Pose2) -> f32) -> f64 {
        mean(self.errors.iter().map(|errors| f64::from(value(&errors[method]).abs())))
    }
}

/// One line of the table.
impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |count: usize| 100.0 * count as f64 / self.carts.max(1) as f64;
        let (found, verified) = (share(self.found), share(self.errors.len()));
        write!(f, "{:>12.1}{found:>6.1} %{verified:>8.1} %", self.distance)?;
        let values: [fn(&Pose2) -> f32; 3] = [|e| 100.0 * e.x, |e| 100.0 * e.y, |e| e.theta.to_degrees()];
        for value in values {
            for method in 0..2 {
                write!(f, "{:>14.2}", self.mean_error(method, value))?;
            }
        }
        let [clustering, verification] = [0, 1].map(|step| 1e3 * mean(self.times.iter().map(|times| times[step])));
        write!(f, "{clustering:>17.3}{verification:>18.3}")
    }
}

/// Mean, or 0 without values.
fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cart_nearby_is_found_and_verified_whatever_the_number_of_threads() {
        let rows = [1, 2].map(|threads| accuracy(&[1, 2, 3], NonZero::new(threads)).expect("threads").swap_remove(0));
        let [one, two] = &rows;
        assert_eq!((one.found, &one.errors), (two.found, &two.errors));
        assert!(!one.errors.is_empty() && one.errors.iter().all(|[_, e]| e.position().norm() < 0.1), "{one:?}");
    }

    #[test]
    fn the_table_has_a_line_for_each_distance() {
        let error = Pose2::new(-0.02, 0.0, 0.0);
        let row = Row { distance: 1.0, carts: 2, found: 1, errors: vec![[error; 2]], ..Row::default() };
        let text = table(&[row.clone(), Row::default()]);
        assert_eq!(text.lines().count(), 3);
        assert!(text.contains("50.0 %") && text.contains("2.00"), "{text}");
        let figure = figure(&[row]);
        assert_eq!(figure[0].curves[1].points, [[1.0, 2.0]]);
    }
}
