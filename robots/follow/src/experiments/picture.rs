use super::Run;
use apex_sim::{experiment::Drawing, outdoor::Surface};

/// Pixels per metre.
const SCALE: f32 = 2.0;
/// Margin around the track, in m.
const MARGIN: f32 = 15.0;

/// Drawing of a run as SVG, like figure 8.12: the country with trees, rocks and ditches, the way of the runner and that
/// of the robot, and what happened on it.
pub fn picture(run: &Run) -> String {
    let mut drawing = Drawing::new(run.track.bounds(), MARGIN, SCALE, "#f4f2e8");
    for ditch in run.terrain.ditches() {
        let width = 2.0 * SCALE * ditch.half_width;
        drawing.path(ditch.ends, &format!("fill=\"none\" stroke=\"#8a7a5a\" stroke-width=\"{width:.1}\""));
    }
    let report = &run.report;
    drawing.path(report.runner.iter().copied(), "fill=\"none\" stroke=\"#e08030\" stroke-width=\"3\"");
    let way = report.trajectory.iter().map(|(_, pose)| pose.position());
    drawing.path(way, "fill=\"none\" stroke=\"#1f5fd0\" stroke-width=\"1.2\"");
    for thing in run.terrain.things().iter().filter(|thing| thing.radius_at_ground() > 0.0) {
        let colour = match thing.surface {
            Surface::Rock => "#707070",
            Surface::Trunk => "#5a4020",
            _ => "#60a040",
        };
        drawing.circle(thing.at, (SCALE * thing.radius_at_ground()).max(0.8), &format!("fill=\"{colour}\""));
    }
    for contact in &report.contacts {
        drawing.circle(contact.place, 6.0, "fill=\"none\" stroke=\"#c00000\" stroke-width=\"2\"");
    }
    for loss in report.losses.iter().filter(|loss| loss.lasted > 1.0) {
        drawing.circle(loss.place, 5.0, "fill=\"none\" stroke=\"#a000c0\" stroke-width=\"2\"");
    }
    drawing.finish()
}
