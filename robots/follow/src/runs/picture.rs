use super::Run;
use apex_nodes::scan::Point2;
use apex_sim::outdoor::Surface;
use std::fmt::Write as _;

/// Pixels per metre.
const SCALE: f32 = 2.0;
/// Margin around the track, in m.
const MARGIN: f32 = 15.0;

/// Drawing of a run as SVG, like figure 8.12: the country with trees, rocks and ditches, the way of the runner and that
/// of the robot, and what happened on it.
pub fn picture(run: &Run) -> String {
    let [low, high] = run.track.bounds();
    let size = high - low;
    let (width, height) = (SCALE * (size.x + 2.0 * MARGIN), SCALE * (size.y + 2.0 * MARGIN));
    let place = |p: Point2| (SCALE * (p.x - low.x + MARGIN), SCALE * (high.y - p.y + MARGIN));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\">\n\
         <rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#f4f2e8\"/>\n"
    );
    // Writing to a string cannot fail.
    let mut line = |points: &mut dyn Iterator<Item = Point2>, style: &str| {
        let mut path = String::new();
        for (i, point) in points.enumerate() {
            let (x, y) = place(point);
            let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        }
        let _ = writeln!(svg, "<path d=\"{path}\" fill=\"none\" {style}/>");
    };
    for ditch in run.terrain.ditches() {
        let style = format!("stroke=\"#8a7a5a\" stroke-width=\"{:.1}\"", 2.0 * SCALE * ditch.half_width);
        line(&mut ditch.ends.into_iter(), &style);
    }
    line(&mut run.report.runner.iter().copied(), "stroke=\"#e08030\" stroke-width=\"3\"");
    line(&mut run.report.trajectory.iter().map(|pose| pose.position()), "stroke=\"#1f5fd0\" stroke-width=\"1.2\"");
    let mut disc = |at: Point2, radius: f32, style: &str| {
        let (x, y) = place(at);
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {style}/>");
    };
    for thing in run.terrain.things().iter().filter(|thing| thing.radius_at_ground() > 0.0) {
        let colour = match thing.surface {
            Surface::Rock => "#707070",
            Surface::Trunk => "#5a4020",
            _ => "#60a040",
        };
        disc(thing.at, (SCALE * thing.radius_at_ground()).max(0.8), &format!("fill=\"{colour}\""));
    }
    for contact in &run.report.contacts {
        disc(contact.place, 6.0, "fill=\"none\" stroke=\"#c00000\" stroke-width=\"2\"");
    }
    for loss in run.report.losses.iter().filter(|loss| loss.lasted > 1.0) {
        disc(loss.place, 5.0, "fill=\"none\" stroke=\"#a000c0\" stroke-width=\"2\"");
    }
    svg.push_str("</svg>\n");
    svg
}
