use super::{
    RunReport,
    canvas::{BLACK, Canvas, Colour, LARGE, SMALL, Spot, WHITE, text_width},
    clock, seconds,
};
use apex_nodes::{
    map::{Occupancy, Sign},
    scan::{Point2, Pose2},
};
use image::{Rgb, RgbImage};
use std::f32::consts::TAU;

/// Columns and rows of the picture.
const SIDE: u32 = 1200;
/// Pixels per metre, with room for the numbers of the stations around the border.
const SCALE: f32 = 90.0;

const UNKNOWN: Colour = Rgb([226, 229, 233]);
const WALL: Colour = Rgb([90, 175, 255]);
const ISLAND: Colour = Rgb([200, 40, 200]);
const STATION: Colour = Rgb([20, 140, 60]);
const SIGN: Colour = Rgb([215, 95, 0]);
/// Colour of a sign with few sightings.
const DOUBTFUL: Colour = Rgb([235, 190, 150]);
const DELIVERY: Colour = Rgb([200, 20, 40]);
/// Colours of the path, from the start to the end.
const TIMES: [Colour; 4] = [Rgb([70, 60, 190]), Rgb([0, 150, 190]), Rgb([110, 165, 40]), Rgb([240, 165, 0])];

/// Minimum number of sightings of a certain sign. One with fewer may be something else.
const SURE: u32 = 3;
/// Number of standard deviations that contain 95 % of a Gaussian in the plane.
const DEVIATIONS: f32 = 2.45;

impl RunReport {
    /// Draws the robot's map and its detections over the true arena. The origin of the arena is in the middle; x points
    /// to the right.
    pub(super) fn draw_map(&self) -> RgbImage {
        let mut canvas = Canvas::new(SIDE, SIDE, UNKNOWN);
        self.draw_cells(&mut canvas);
        self.draw_truth(&mut canvas);
        self.draw_way(&mut canvas);
        self.draw_found(&mut canvas);
        for place in self.report.deliveries.iter().filter_map(|delivery| self.place(delivery.at)) {
            delivery(&mut canvas, pixel(place));
        }
        self.draw_heading(&mut canvas);
        draw_legend(&mut canvas);
        self.draw_times(&mut canvas);
        draw_scale(&mut canvas);
        canvas.finish()
    }

    fn draw_cells(&self, canvas: &mut Canvas) {
        let Some(map) = &self.map else { return };
        canvas.paint(|spot| match map.at(self.start.to_inner(place(spot))) {
            None | Some(Occupancy::Unknown) => UNKNOWN,
            Some(Occupancy::Free) => WHITE,
            Some(Occupancy::Occupied | Occupancy::Low) => BLACK,
        });
    }

    fn draw_truth(&self, canvas: &mut Canvas) {
        for wall in self.arena.world.walls() {
            canvas.line(&[wall.a, wall.b].map(pixel), 2.0, WALL);
        }
        for station in &self.arena.filling {
            canvas.disc(pixel(station.pose.position()), 5.0, WALL);
        }
        for (station, number) in self.arena.delivery.iter().zip(1..) {
            let behind = station.pose.to_outer(Point2::new(-0.3, 0.0));
            canvas.disc(pixel(station.pose.position()), 5.0, WALL);
            canvas.label(pixel(behind), LARGE, &format!("{number}"), WALL);
        }
    }

    /// Draws the path of the robot, coloured by time.
    fn draw_way(&self, canvas: &mut Canvas) {
        let end = self.end();
        for ends in self.report.trajectory.windows(2) {
            let colour = colour_of(seconds(ends[0].0) / end.max(f32::MIN_POSITIVE));
            canvas.line(&[ends[0].1, ends[1].1].map(|pose| pixel(pose.position())), 2.5, colour);
        }
        let ends = [("start", Some(&self.start)), ("end", self.report.trajectory.last().map(|(_, pose)| pose))];
        for (name, pose) in ends.into_iter().filter_map(|(name, pose)| Some((name, pose?))) {
            let corners = [(0.3, 0.0), (-0.15, 0.15), (-0.15, -0.15), (0.3, 0.0)];
            canvas.line(&corners.map(|(x, y)| pixel(pose.to_outer(Point2::new(x, y)))), 3.0, BLACK);
            canvas.label(pixel(pose.to_outer(Point2::new(-0.45, 0.0))), SMALL, name, BLACK);
        }
    }

    /// Draws the detections of the robot, transformed from its own frame to that of the arena.
    fn draw_found(&self, canvas: &mut Canvas) {
        if let Some(octagon) = &self.octagon {
            let corner = |i| Point2::polar(octagon.apothem / (TAU / 16.0).cos(), octagon.theta + TAU / 16.0 * i as f32);
            let corners = (0..9).map(|i| self.pixel_of(octagon.centre + corner(2 * i + 1)));
            canvas.line(&corners.collect::<Vec<_>>(), 3.0, ISLAND);
        }
        for found in &self.stations {
            station(canvas, self.pixel_of(found.pose.position()), found.free);
        }
        for sign in &self.signs {
            let colour = if sign.count < SURE { DOUBTFUL } else { SIGN };
            let ellipse: Vec<Spot> = ellipse(sign).map(|place| self.pixel_of(place)).collect();
            canvas.line(&ellipse, 2.0, colour);
            let ahead = sign.pose().to_outer(Point2::new(0.25, 0.0));
            canvas.line(&[self.pixel_of(sign.mean), self.pixel_of(ahead)], 2.0, colour);
            canvas.disc(self.pixel_of(sign.mean), 4.0, colour);
            let before = sign.pose().to_outer(Point2::new(0.4, 0.0));
            canvas.label(self.pixel_of(before), LARGE, &sign.class.to_string(), colour);
        }
    }

    /// Pixel of a place in the map of the robot.
    fn pixel_of(&self, place: Point2) -> Spot {
        pixel(self.start.to_outer(place))
    }

    fn draw_heading(&self, canvas: &mut Canvas) {
        canvas.text([16.0, 24.0], LARGE, &format!("Seed {}", self.seed), BLACK);
        let points = format!("{} points in {} min", self.report.points(), clock(self.end()));
        canvas.text([16.0, 50.0], SMALL, &points, BLACK);
    }

    /// Draws the legend for the colours of the path.
    fn draw_times(&self, canvas: &mut Canvas) {
        const LENGTH: f32 = 160.0;
        let (left, y) = (16.0, SIDE as f32 - 40.0);
        let parts = LENGTH as usize;
        for i in 0..parts {
            let x = left + i as f32;
            canvas.block([x, y - 8.0], [x + 1.0, y + 8.0], colour_of(i as f32 / LENGTH));
        }
        canvas.text([left, y - 22.0], SMALL, "way of the robot", BLACK);
        canvas.text([left, y + 20.0], SMALL, "0:00", BLACK);
        let end = clock(self.end());
        canvas.text([left + LENGTH - text_width(&end, SMALL), y + 20.0], SMALL, &end, BLACK);
    }
}

/// The middle of the arena is in the middle of the picture.
const MIDDLE: f32 = 0.5 * SIDE as f32;

/// Pixel of a place in the arena.
fn pixel(place: Point2) -> Spot {
    [MIDDLE + SCALE * place.x, MIDDLE - SCALE * place.y]
}

/// Place in the arena of a pixel.
fn place(spot: Spot) -> Point2 {
    Point2::new(spot[0] - MIDDLE, MIDDLE - spot[1]).scaled(1.0 / SCALE)
}

/// Colour of a time, given as a fraction of the run.
fn colour_of(part: f32) -> Colour {
    let at = part.clamp(0.0, 1.0) * (TIMES.len() - 1) as f32;
    let first = (at as usize).min(TIMES.len() - 2);
    let ([a, b], share) = ([TIMES[first], TIMES[first + 1]], at - first as f32);
    let mixed = |i: usize| f32::from(a.0[i]) + share * (f32::from(b.0[i]) - f32::from(a.0[i]));
    Rgb([0, 1, 2].map(|i| mixed(i) as u8))
}

/// Ellipse that contains a sign with a probability of 95 %, in the frame of the map.
fn ellipse(sign: &Sign) -> impl Iterator<Item = Point2> {
    const PARTS: u8 = 48;
    let [xx, yy, xy] = sign.covariance();
    let (mean, half, radius) = (0.5 * (xx + yy), 0.5 * (xx - yy), (0.5 * (xx - yy)).hypot(xy));
    let axes = [mean + radius, mean - radius].map(|variance| DEVIATIONS * variance.max(0.0).sqrt());
    let frame = Pose2::new(sign.mean.x, sign.mean.y, 0.5 * xy.atan2(half));
    (0..=PARTS).map(move |i| {
        let (sin, cos) = (TAU * f32::from(i) / f32::from(PARTS)).sin_cos();
        frame.to_outer(Point2::new(axes[0] * cos, axes[1] * sin))
    })
}

fn delivery(canvas: &mut Canvas, spot: Spot) {
    canvas.disc(spot, 8.0, WHITE);
    canvas.disc(spot, 6.5, DELIVERY);
}

/// Draws a filling station; one in use is hollow.
fn station(canvas: &mut Canvas, spot: Spot, free: bool) {
    canvas.disc(spot, 9.0, STATION);
    if !free {
        canvas.disc(spot, 6.0, WHITE);
    }
}

/// Draws the legend of the symbols in the upper right corner.
fn draw_legend(canvas: &mut Canvas) {
    type Symbol = fn(&mut Canvas, Spot);
    let rows: [(&str, Symbol); 7] = [
        ("walls, as they are", |canvas, at| bar(canvas, at, WALL)),
        ("island, as found", |canvas, at| bar(canvas, at, ISLAND)),
        ("filling station", |canvas, at| station(canvas, at, true)),
        ("one in use", |canvas, at| station(canvas, at, false)),
        ("sign, 95 %", |canvas, at| bar(canvas, at, SIGN)),
        ("sign, hardly seen", |canvas, at| bar(canvas, at, DOUBTFUL)),
        ("delivery", delivery),
    ];
    for (i, (name, symbol)) in rows.into_iter().enumerate() {
        let y = 24.0 + 24.0 * i as f32;
        symbol(canvas, [SIDE as f32 - 190.0, y]);
        canvas.text([SIDE as f32 - 172.0, y], SMALL, name, BLACK);
    }
}

/// Draws a short line of the legend.
fn bar(canvas: &mut Canvas, [x, y]: Spot, colour: Colour) {
    canvas.line(&[[x - 9.0, y], [x + 9.0, y]], 3.0, colour);
}

/// Draws a scale of one metre in the lower right corner.
fn draw_scale(canvas: &mut Canvas) {
    let (right, y) = (SIDE as f32 - 16.0, SIDE as f32 - 20.0);
    canvas.line(&[[right - SCALE, y], [right, y]], 3.0, BLACK);
    canvas.text([right - 0.5 * (SCALE + text_width("1 m", SMALL)), y - 16.0], SMALL, "1 m", BLACK);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{experiments::run_report::tests::run_report, world::contest::Report};

    /// Colour at a place of the arena.
    fn at(picture: &RgbImage, place: Point2) -> Colour {
        let [x, y] = pixel(place).map(|x| x as u32);
        picture[(x, y)]
    }

    #[test]
    fn the_map_shows_what_was_found_where_it_is() {
        let run_report = run_report();
        let picture = run_report.draw_map();
        assert_eq!(picture.dimensions(), (SIDE, SIDE));
        let outer = |place: Point2| run_report.start.to_outer(place);
        let [free, used] = [0, 1].map(|i| outer(run_report.stations[i].pose.position()));
        assert_eq!((at(&picture, free), at(&picture, used)), (STATION, WHITE));
        assert_eq!(at(&picture, outer(run_report.signs[0].mean)), SIGN);
        assert_eq!(at(&picture, outer(run_report.signs[1].mean)), DOUBTFUL);
        let delivered = run_report.place(run_report.report.deliveries[0].at).expect("it was somewhere");
        assert_eq!(at(&picture, delivered), DELIVERY);
        let octagon = run_report.octagon.expect("it was found");
        assert_eq!(at(&picture, outer(octagon.side_pose(1).position())), ISLAND);
        let wall = run_report.arena.world.walls()[0];
        assert_eq!(at(&picture, (wall.a + wall.b).scaled(0.5)), WALL);
    }

    #[test]
    fn ellipses_follow_the_covariance() {
        let mut sign = Sign::new(1, &Pose2::new(1.0, 2.0, 0.0));
        for (x, y) in [(1.2, 2.2), (0.8, 1.8), (1.1, 2.1), (0.9, 1.9)] {
            sign.add(&Pose2::new(x, y, 0.0));
        }
        // The sign was seen along a line of 45°.
        let deviation = DEVIATIONS * sign.covariance()[0].sqrt();
        assert!(ellipse(&sign).all(|p| ((p.x - 1.0) - (p.y - 2.0)).abs() < 1e-3));
        let farthest = ellipse(&sign).map(|p| (p.x - 1.0).abs()).fold(0.0, f32::max);
        assert!((farthest - deviation).abs() < 1e-3, "{farthest} is {deviation}");
    }

    #[test]
    fn a_robot_that_knows_nothing_has_a_picture_too() {
        let mut run_report = run_report();
        (run_report.map, run_report.octagon) = (None, None);
        run_report.stations.clear();
        run_report.signs.clear();
        run_report.report = Report::default();
        run_report.phases.clear();
        let picture = run_report.draw_map();
        assert_eq!(at(&picture, Point2::new(3.0, 3.0)), UNKNOWN);
    }
}
