use super::Run;
use crate::{
    LENGTH, WIDTH,
    clinic::{STAIRWELL, Snapshot},
};
use apex_nodes::scan::{Point2, Pose2};
use std::fmt::Write as _;

/// Pixels per metre.
const SCALE: f32 = 20.0;
/// Margin around the plan, in m.
const MARGIN: f32 = 1.0;

/// Drawing of a run as SVG: the plan, the stairwell, the way of the vehicle, and containers and people at the end. Pale
/// containers are where they were at the beginning.
pub fn picture(run: &Run) -> String {
    let Some((low, high)) = run.plan.bounds() else { return "<svg/>".to_owned() };
    let size = high - low;
    let (width, height) = (SCALE * (size.x + 2.0 * MARGIN), SCALE * (size.y + 2.0 * MARGIN));
    let place = |p: Point2| (SCALE * (p.x - low.x + MARGIN), SCALE * (high.y - p.y + MARGIN));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\">\n\
         <rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"white\"/>\n"
    );
    let mut line = |points: &[Point2], style: &str| {
        let mut path = String::new();
        for (i, point) in points.iter().enumerate() {
            let (x, y) = place(*point);
            // Writing to a string cannot fail.
            let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        }
        let _ = writeln!(svg, "<path d=\"{path}\" {style}/>");
    };
    for wall in run.plan.segments() {
        line(&[wall.a, wall.b], "fill=\"none\" stroke=\"black\" stroke-width=\"2\"");
    }
    let [x, y] = [STAIRWELL.x, STAIRWELL.y];
    let middle = Pose2::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.0);
    line(&corners(&middle, x[1] - x[0], y[1] - y[0]), "fill=\"#c8c8c8\" stroke=\"none\"");
    let way: Vec<Point2> = run.report.trajectory.iter().map(|(_, pose)| pose.position()).collect();
    line(&way, "fill=\"none\" stroke=\"#1f5fd0\" stroke-width=\"2\"");
    let [first, last] = &run.ends;
    for (Snapshot { carts, .. }, style) in
        [(first, "fill=\"none\" stroke=\"#d0a080\""), (last, "fill=\"#e08030\" stroke=\"black\"")]
    {
        carts.iter().for_each(|cart| line(&corners(cart, LENGTH, WIDTH), style));
    }
    for pose in &last.people {
        line(&corners(pose, 0.3, 0.5), "fill=\"#30a050\" stroke=\"none\"");
    }
    svg.push_str("</svg>\n");
    svg
}

fn corners(pose: &Pose2, length: f32, width: f32) -> [Point2; 5] {
    [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5), (0.5, 0.5)]
        .map(|(x, y)| pose.to_outer(Point2::new(x * length, y * width)))
}
