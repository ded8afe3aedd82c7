//! Fits the noise of [`OdometryNoise`](apex_sim::OdometryNoise) to a log with raw wheel odometry and reference poses.
//!
//! ```text
//! cargo run --release -p apex-sim --example fit_odometry -- intel_raw_odo_scans.csv.gz intel_raw_gt.csv
//! ```
use apex_nodes::{math::angle_difference, scan::Pose2};
use flate2::read::GzDecoder;
use std::{
    env,
    error::Error,
    fs::File,
    io::{BufRead, BufReader, Read},
};

/// Maximum number of scans between two references. More scans are skipped, as people walked in.
const MOST_SCANS: usize = 40;
/// Share of the smallest errors that are used, as the references also have outliers.
const USED: f64 = 0.98;

/// Wheel odometry between two references.
struct Step {
    /// Distance in m and rotation in rad.
    by: [f64; 2],
    /// Errors of x and y in m and of the heading in rad.
    errors: [f64; 3],
    /// x by the wheels and by the references, in m.
    x: [f64; 2],
}

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<String> = env::args().skip(1).collect();
    let [odometry, references] = paths.as_slice() else {
        return Err(
            "say where the odometry is (gzip csv: k, dx, dy, dtheta, …) and the references (csv: k, id, x, y, theta)"
                .into(),
        );
    };
    let odometry = rows(GzDecoder::new(File::open(odometry)?), 0)?;
    let references = rows(File::open(references)?, 1)?;
    let steps: Vec<Step> = references.windows(2).filter_map(|pair| step(&odometry, &pair[0], &pair[1])).collect();
    let scale = steps.iter().map(|s| s.x[0] * s.x[1]).sum::<f64>() / steps.iter().map(|s| s.x[1] * s.x[1]).sum::<f64>();
    println!("{} steps; a metre measures {scale:.4} m", steps.len());
    for (name, i) in [("along", 0), ("across", 1), ("heading", 2)] {
        let [drift, _] = fit(&steps, |s| s.errors[i]);
        let [way, turn] = fit(&steps, |s| s.errors[i] * s.errors[i]);
        println!("{name:8} variance {way:.4} per m, {turn:.4} per rad; drift {drift:+.4} per m");
    }
    Ok(())
}

/// Numbers of each line, from line `first` on.
fn rows(file: impl Read, first: usize) -> Result<Vec<Vec<f64>>, Box<dyn Error>> {
    let mut rows = vec![];
    for (number, line) in BufReader::new(file).lines().enumerate().skip(first) {
        let line = line?;
        let row: Result<Vec<f64>, _> = line.split(',').take(5).map(str::parse).collect();
        rows.push(row.map_err(|error| format!("line {}: {error}", number + 1))?);
    }
    Ok(rows)
}

fn step(odometry: &[Vec<f64>], a: &[f64], b: &[f64]) -> Option<Step> {
    let (from, to) = (a[0] as usize, b[0] as usize);
    let moves = odometry.get(from..to).filter(|moves| moves.len() <= MOST_SCANS)?;
    let pose = |x: f64, y: f64, theta: f64| Pose2::new(x as f32, y as f32, theta as f32);
    let (mut wheels, mut by) = (Pose2::default(), [0.0; 2]);
    for m in moves {
        wheels = wheels.compose(&pose(m[1], m[2], m[3]));
        by = [by[0] + m[1].hypot(m[2]), by[1] + m[3].abs()];
    }
    let true_step = pose(b[2], b[3], b[4]).relative_to(&pose(a[2], a[3], a[4]));
    let turned = angle_difference(&true_step.theta, &wheels.theta);
    let errors = [wheels.x - true_step.x, wheels.y - true_step.y, turned].map(f64::from);
    Some(Step { by, errors, x: [wheels.x, true_step.x].map(f64::from) })
}

/// Least-squares fit of `value ≈ a · distance + b · rotation`, without the largest values.
fn fit(steps: &[Step], value: impl Fn(&Step) -> f64) -> [f64; 2] {
    let mut sizes: Vec<f64> = steps.iter().map(|s| value(s).abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let Some(largest) = sizes.get((USED * sizes.len() as f64) as usize) else { return [0.0; 2] };
    let (mut square, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
    for s in steps.iter().filter(|s| value(s).abs() <= *largest) {
        for i in 0..2 {
            right[i] += s.by[i] * value(s);
            (0..2).for_each(|j| square[i][j] += s.by[i] * s.by[j]);
        }
    }
    let [[a, b], [_, c]] = square;
    let determinant = a * c - b * b;
    [(c * right[0] - b * right[1]) / determinant, (a * right[1] - b * right[0]) / determinant]
}
