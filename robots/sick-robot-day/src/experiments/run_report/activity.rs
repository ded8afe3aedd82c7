use super::{
    Phase, RunReport,
    canvas::{BLACK, Canvas, Colour, SMALL, Spot, WHITE, text_width},
    clock, seconds, shortened,
};
use crate::world::contest::Delivery;
use image::{Rgb, RgbImage};

const WIDTH: u32 = 1200;
/// Height of a row, and of the margins above and below all rows, in pixels.
const ROW: f32 = 26.0;
const MARGIN: f32 = 16.0;
/// Maximum number of characters of a name.
const NAME: usize = 48;
/// Maximum number of labelled minutes.
const LABELS: u32 = 16;

const GRID: Colour = Rgb([215, 219, 224]);
const DELIVERY: Colour = Rgb([200, 20, 40]);
/// Colours of phases. Nested phases have the colour of the outer one.
const PHASES: [Colour; 6] = [
    Rgb([50, 115, 190]),
    Rgb([225, 130, 30]),
    Rgb([60, 150, 80]),
    Rgb([135, 95, 180]),
    Rgb([0, 150, 160]),
    Rgb([145, 100, 75]),
];

/// Layout of times and phases in the picture.
struct Layout {
    /// Start of the time axis, in pixels.
    left: f32,
    /// Pixels per second.
    scale: f32,
    rows: usize,
}

impl Layout {
    fn of(run_report: &RunReport, names: &[&str]) -> Self {
        let longest = names.iter().map(|name| text_width(&shortened(name, NAME), SMALL)).fold(0.0, f32::max);
        let left = 2.0 * MARGIN + longest.max(text_width("deliveries", SMALL));
        let scale = (WIDTH as f32 - left - 2.0 * MARGIN) / run_report.end().max(1.0);
        Self { left, scale, rows: names.len() }
    }

    fn x(&self, seconds: f32) -> f32 {
        self.left + self.scale * seconds
    }

    /// Vertical middle of a row, in pixels; row 0 is that of the deliveries.
    fn y(&self, row: usize) -> f32 {
        MARGIN + ROW * (row as f32 + 0.5)
    }

    /// Vertical position of the time axis, in pixels.
    fn bottom(&self) -> f32 {
        MARGIN + ROW * (self.rows as f32 + 1.0)
    }

    fn height(&self) -> u32 {
        (self.bottom() + ROW + MARGIN) as u32
    }
}

impl RunReport {
    /// Diagram of the active phases and the deliveries: a row for each phase, time to the right.
    pub(super) fn draw_activity(&self) -> RgbImage {
        let names = self.phase_names();
        let layout = Layout::of(self, &names);
        let mut canvas = Canvas::new(WIDTH, layout.height(), WHITE);
        draw_minutes(&mut canvas, &layout, self.end());
        for (row, name) in (1..).zip(&names) {
            canvas.text([MARGIN, layout.y(row)], SMALL, &shortened(name, NAME), BLACK);
            for phase in self.phases.iter().filter(|phase| phase.name == *name) {
                draw_phase(&mut canvas, &layout, row, phase, colour_of(name, &names));
            }
        }
        canvas.text([MARGIN, layout.y(0)], SMALL, "deliveries", BLACK);
        for Delivery { at, station, .. } in &self.report.deliveries {
            draw_delivery(&mut canvas, &layout, seconds(*at), *station);
        }
        canvas.finish()
    }
}

fn draw_minutes(canvas: &mut Canvas, layout: &Layout, end: f32) {
    let minutes = end as u32 / 60;
    let each = minutes / LABELS + 1;
    for minute in 0..=minutes {
        let x = layout.x(60.0 * minute as f32);
        canvas.line(&[[x, MARGIN], [x, layout.bottom() + 4.0]], 1.0, GRID);
        if minute.is_multiple_of(each) {
            let name = clock(60.0 * minute as f32);
            canvas.text([x - 0.5 * text_width(&name, SMALL), layout.bottom() + 14.0], SMALL, &name, BLACK);
        }
    }
    let axis: [Spot; 2] = [0.0, end].map(|time| [layout.x(time), layout.bottom()]);
    canvas.line(&axis, 1.0, BLACK);
}

fn draw_phase(canvas: &mut Canvas, layout: &Layout, row: usize, phase: &Phase, colour: Colour) {
    let [from, until] = [phase.from, phase.until].map(|time| layout.x(seconds(time)));
    let y = layout.y(row);
    // Short phases remain visible.
    canvas.block([from, y - 8.0], [until.max(from + 1.5), y + 8.0], colour);
}

/// Draws a delivery: the number of its station, over a line through all phases.
fn draw_delivery(canvas: &mut Canvas, layout: &Layout, time: f32, station: u32) {
    let (x, y) = (layout.x(time), layout.y(0));
    canvas.line(&[[x, y], [x, layout.bottom()]], 1.0, DELIVERY);
    canvas.disc([x, y], 10.0, DELIVERY);
    let number = station.to_string();
    canvas.text([x - 0.5 * text_width(&number, SMALL), y], SMALL, &number, WHITE);
}

/// Colour of a phase: that of the outermost phase around it.
fn colour_of(name: &str, names: &[&str]) -> Colour {
    let mut outermost = vec![];
    for name in names.iter().map(|name| outer(name)) {
        if !outermost.contains(&name) {
            outermost.push(name);
        }
    }
    let index = outermost.iter().position(|&other| other == outer(name)).unwrap_or(0);
    PHASES[index % PHASES.len()]
}

fn outer(name: &str) -> &str {
    name.split(" / ").next().unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{experiments::run_report::tests::run_report, world::contest::Report};
    use apex_rt::Time;

    #[test]
    fn phases_are_bars_where_they_were_active() {
        let run_report = run_report();
        let (picture, names) = (run_report.draw_activity(), run_report.phase_names());
        let layout = Layout::of(&run_report, &names);
        assert_eq!(picture.dimensions(), (WIDTH, layout.height()));
        for (row, name) in (1..).zip(&names) {
            for second in [5, 25, 40, 70, 95, 115] {
                let time = Time::from_secs(second);
                let active = run_report.phases.iter().any(|p| p.name == *name && p.from <= time && time < p.until);
                let pixel = picture[(layout.x(second as f32) as u32, layout.y(row) as u32)];
                assert_eq!(pixel, if active { colour_of(name, &names) } else { WHITE }, "{name} at {second} s");
            }
        }
        let time = run_report.report.deliveries[0].at;
        let (x, y) = (layout.x(seconds(time)) as u32, layout.y(0) as u32);
        assert_eq!(picture[(x, y - 8)], DELIVERY);
    }

    #[test]
    fn phases_within_one_have_its_colour() {
        let names = ["explore", "fetch", "fetch / position"];
        let [explore, fetch, position] = names.map(|name| colour_of(name, &names));
        assert!(explore != fetch && fetch == position);
    }

    #[test]
    fn a_long_run_and_an_empty_one_have_pictures() {
        let mut run_report = run_report();
        run_report.phases.push(Phase { name: "wait".repeat(50), from: Time::ZERO, until: Time::from_secs(100 * 3600) });
        assert_eq!(run_report.draw_activity().width(), WIDTH);
        (run_report.phases, run_report.report) = (vec![], Report::default());
        assert_eq!(run_report.draw_activity().width(), WIDTH);
    }
}
