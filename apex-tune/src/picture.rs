use crate::Found;
use plotters::prelude::*;
use std::{error::Error, io};

/// Width and height of a picture, in pixels.
const SIZE: (u32, u32) = (640, 360);

/// Picture of the best fitness over the number of candidates, for each search.
pub(crate) fn convergence(found: &[Found]) -> io::Result<String> {
    let points = || found.iter().flat_map(|f| &f.improvements).filter(|(_, fitness)| fitness.is_finite());
    let last = points().map(|(count, _)| *count).max().unwrap_or(1);
    let (low, high) = range(points().map(|(_, fitness)| *fitness));
    drawn(|area| {
        let mut chart = chart(area).build_cartesian_2d(0..last, low..high)?;
        chart.configure_mesh().x_desc("candidates").y_desc("fitness").light_line_style(TRANSPARENT).draw()?;
        for (number, found) in found.iter().enumerate() {
            let end = found.improvements.last().map(|(_, fitness)| (last, *fitness));
            // Steps: the fitness is constant between two improvements.
            let steps = found.improvements.windows(2).flat_map(|w| [w[0], (w[1].0, w[0].1)]);
            let line = steps.chain(found.improvements.last().copied()).chain(end);
            let style = Palette99::pick(number).stroke_width(2);
            chart.draw_series([PathElement::new(line.collect::<Vec<_>>(), style)])?;
        }
        Ok(())
    })
}

/// Picture of the fitness that is lost with the default of each parameter.
pub(crate) fn importance(names: &[&str], importance: &[f64]) -> io::Result<String> {
    let finite = |x: &f64| if x.is_finite() { *x } else { 0.0 };
    let (low, high) = range(importance.iter().map(finite).chain([0.0]));
    drawn(|area| {
        let mut chart = chart(area).build_cartesian_2d(low..high, 0..names.len())?;
        let name = |row: &usize| names.get(*row).copied().unwrap_or_default().to_owned();
        let mut mesh = chart.configure_mesh();
        mesh.disable_y_mesh().disable_y_axis().x_desc("fitness lost with the default").draw()?;
        for (row, value) in importance.iter().enumerate() {
            let bar = Rectangle::new([(0.0, row), (finite(value), row + 1)], BLUE.mix(0.4).filled());
            chart.draw_series([bar])?;
            chart.draw_series([Text::new(name(&row), (0.0, row + 1), ("sans-serif", 14))])?;
        }
        Ok(())
    })
}

/// Picture of the front of two goals, with the defaults (grey) and the result (red).
pub(crate) fn front(
    names: [&str; 2],
    front: &[(f64, f64)],
    defaults: (f64, f64),
    tuned: (f64, f64),
) -> io::Result<String> {
    let is_finite = |(x, y): &(f64, f64)| x.is_finite() && y.is_finite();
    let all: Vec<(f64, f64)> = front.iter().copied().chain([defaults, tuned]).filter(is_finite).collect();
    let (left, right) = range(all.iter().map(|(x, _)| *x));
    let (low, high) = range(all.iter().map(|(_, y)| *y));
    drawn(|area| {
        let mut chart = chart(area).build_cartesian_2d(left..right, low..high)?;
        chart.configure_mesh().x_desc(names[0]).y_desc(names[1]).light_line_style(TRANSPARENT).draw()?;
        chart.draw_series(front.iter().map(|point| Circle::new(*point, 3, BLUE.filled())))?;
        let marks = [(defaults, BLACK.mix(0.4)), (tuned, RED.mix(1.0))];
        let marks = marks.into_iter().filter(|(point, _)| is_finite(point));
        chart.draw_series(marks.map(|(point, colour)| Circle::new(point, 5, colour.filled())))?;
        Ok(())
    })
}

/// Range of values with a margin; not empty.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
    if low > high {
        return (0.0, 1.0);
    }
    let margin = 0.05 * (high - low).max(1e-9 * high.abs().max(1e-9));
    (low - margin, high + margin)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn chart<'a, 'b>(area: &'a Area<'b>) -> ChartBuilder<'a, 'b, SVGBackend<'b>> {
    let mut chart = ChartBuilder::on(area);
    chart.margin(12).x_label_area_size(40).y_label_area_size(64);
    chart
}

fn drawn(draw: impl FnOnce(&Area<'_>) -> Result<(), Box<dyn Error>>) -> io::Result<String> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        let finish = |area: &Area<'_>| -> Result<(), Box<dyn Error>> {
            area.fill(&WHITE)?;
            draw(area)?;
            Ok(area.present()?)
        };
        finish(&area).map_err(|error| io::Error::other(error.to_string()))?;
    }
    Ok(text)
}
