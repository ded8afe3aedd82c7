use super::Run;
use crate::world::Kind;
use apex_nodes::{map::Occupancy, scan::Point2};
use apex_sim::experiment::Drawing;

/// Pixels per metre.
const SCALE: f32 = 30.0;
/// Margin around the field, in m.
const MARGIN: f32 = 1.0;

/// Drawing of a run as SVG, like figure 8.5b: the map of the robot, the things that are on the field in outline, the
/// base station and the way of the robot. Objects are dots, and what the robot knows of them circles with the standard
/// deviation of a sighting as their radius, at least 8 pixels.
pub fn picture(run: &Run) -> String {
    let mut drawing = Drawing::new(run.field.bounds(), MARGIN, SCALE, "#d8d4c8");
    draw_map(&mut drawing, run);
    for wall in run.field.world.walls() {
        drawing.path([wall.a, wall.b], "fill=\"none\" stroke=\"#b05020\" stroke-width=\"1\"");
    }
    for rock in run.field.world.discs() {
        drawing.circle(rock.centre, SCALE * rock.radius, "fill=\"none\" stroke=\"#b05020\" stroke-width=\"1\"");
    }
    let way = run.report.trajectory.iter().map(|pose| pose.position());
    drawing.path(way, "fill=\"none\" stroke=\"#1f5fd0\" stroke-width=\"1.5\"");
    drawing.circle(run.field.station.position(), 9.0, "fill=\"none\" stroke=\"#207030\" stroke-width=\"3\"");
    for object in &run.field.objects {
        drawing.circle(object.place, 5.0, &format!("fill=\"{}\"", colour(object.kind)));
    }
    for find in &run.finds.all {
        let radius = (SCALE * find.deviation).max(8.0);
        let style = format!("fill=\"none\" stroke=\"{}\" stroke-width=\"2\"", colour(find.kind));
        drawing.circle(find.place, radius, &style);
    }
    for contact in &run.report.contacts {
        drawing.circle(contact.place, 7.0, "fill=\"none\" stroke=\"#c00000\" stroke-width=\"2\"");
    }
    drawing.finish()
}

const fn colour(kind: Kind) -> &'static str {
    match kind {
        Kind::Cup => "#2050e0",
        Kind::Battery => "#d0a000",
    }
}

/// Draws the known cells of each row, joined where they are the same.
fn draw_map(drawing: &mut Drawing, run: &Run) {
    let (map, raster) = (&run.map, run.map.raster());
    if raster.width == 0 {
        return;
    }
    let frame = run.field.station.transform();
    for (y, row) in map.cells().chunks(raster.width).enumerate() {
        let mut x = 0;
        for cells in row.chunk_by(|a, b| a == b) {
            let colour = match cells[0] {
                Occupancy::Unknown => None,
                Occupancy::Free => Some("#ffffff"),
                Occupancy::Occupied | Occupancy::Low => Some("#303030"),
            };
            let at = |x: usize| raster.corner + Point2::new(x as f32, y as f32 + 0.5).scaled(raster.resolution);
            let ends = [at(x), at(x + cells.len())].map(|end| frame.to_outer(end));
            x += cells.len();
            if let Some(colour) = colour {
                let width = SCALE * raster.resolution + 0.5;
                drawing.path(ends, &format!("stroke=\"{colour}\" stroke-width=\"{width:.1}\""));
            }
        }
    }
}
