use super::Run;
use crate::{
    LENGTH, WIDTH,
    world::clinic::{STAIRWELL, Snapshot},
};
use apex_nodes::scan::{Point2, Pose2};
use apex_sim::experiment::Drawing;

/// Pixels per metre.
const SCALE: f32 = 20.0;
/// Margin around the plan, in m.
const MARGIN: f32 = 1.0;

/// Drawing of a run as SVG: the plan, the stairwell, the way of the vehicle, and containers and people at the end. Pale
/// containers are where they were at the beginning.
pub fn picture(run: &Run) -> String {
    let Some((low, high)) = run.plan.bounds() else { return "<svg/>".to_owned() };
    let mut drawing = Drawing::new([low, high], MARGIN, SCALE, "white");
    for wall in run.plan.segments() {
        drawing.path([wall.a, wall.b], "fill=\"none\" stroke=\"black\" stroke-width=\"2\"");
    }
    let [x, y] = [STAIRWELL.x, STAIRWELL.y];
    let middle = Pose2::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.0);
    drawing.path(corners(&middle, x[1] - x[0], y[1] - y[0]), "fill=\"#c8c8c8\" stroke=\"none\"");
    let way = run.report.trajectory.iter().map(|(_, pose)| pose.position());
    drawing.path(way, "fill=\"none\" stroke=\"#1f5fd0\" stroke-width=\"2\"");
    let [first, last] = &run.ends;
    for (Snapshot { carts, .. }, style) in
        [(first, "fill=\"none\" stroke=\"#d0a080\""), (last, "fill=\"#e08030\" stroke=\"black\"")]
    {
        carts.iter().for_each(|cart| drawing.path(corners(cart, LENGTH, WIDTH), style));
    }
    for pose in &last.people {
        drawing.path(corners(pose, 0.3, 0.5), "fill=\"#30a050\" stroke=\"none\"");
    }
    drawing.finish()
}

fn corners(pose: &Pose2, length: f32, width: f32) -> [Point2; 5] {
    [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5), (0.5, 0.5)]
        .map(|(x, y)| pose.to_outer(Point2::new(x * length, y * width)))
}
