//! Curves as SVG, such as errors by distance.

use apex_sim::experiment::write_file;
use plotters::{coord::Shift, drawing::DrawingAreaErrorKind, prelude::*};
use std::{io, path::Path};

/// Width and height of a panel, in pixels.
const SIZE: (u32, u32) = (480, 340);
/// Part of the height that is left free above the highest point, for the legend.
const HEADROOM: f32 = 0.35;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<io::Error>>;

/// Axes with curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Names of the values to the right and upward, with units.
    pub axes: [String; 2],
    /// The upward axis shows powers of ten, from 1 on.
    pub is_logarithmic: bool,
    /// Value upward that is marked by a line across.
    pub mark: Option<f32>,
    /// Curves, in the order of their names in the legend.
    pub curves: Vec<Curve>,
}

/// Curve with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name.
    pub name: String,
    /// Points in their order. Those that are not finite are left out.
    pub points: Vec<[f32; 2]>,
}

/// Writes panels side by side as SVG. Creates the folder of the file.
///
/// # Errors
/// If the file cannot be written.
pub fn write(panels: &[Panel], path: &Path) -> Result<(), String> {
    let svg = draw(panels).map_err(|e| format!("cannot draw {}: {e}", path.display()))?;
    write_file(path, &svg)
}

fn draw(panels: &[Panel]) -> io::Result<String> {
    let (mut text, count) = (String::new(), panels.len());
    let draw_all = |text: &mut String| -> Drawn {
        let area = SVGBackend::with_string(text, (SIZE.0 * count.max(1) as u32, SIZE.1)).into_drawing_area();
        area.fill(&WHITE)?;
        let parts = area.split_evenly((1, count.max(1)));
        panels.iter().zip(&parts).try_for_each(|(panel, part)| panel.draw(part))?;
        area.present()
    };
    draw_all(&mut text).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(text + "\n")
}

impl Panel {
    fn draw(&self, area: &Area<'_>) -> Drawn {
        let points = self.curves.iter().flat_map(|curve| curve.finite());
        let [left, right, top] = points.fold([f32::INFINITY, f32::NEG_INFINITY, 0.0], |[left, right, top], [x, y]| {
            [left.min(x), right.max(x), top.max(self.upward(y))]
        });
        let top = top.max(self.mark.map_or(0.0, |mark| self.upward(mark))).max(1e-3);
        let (left, right) = if left < right { (left, right) } else { (0.0, 1.0) };
        let mut chart = ChartBuilder::on(area)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(56)
            .build_cartesian_2d(left..right, 0.0..(1.0 + HEADROOM) * top)?;
        let label = |y: &f32| if self.is_logarithmic { format!("{}", libm::exp10f(*y)) } else { format!("{y:.1}") };
        chart
            .configure_mesh()
            .x_desc(&self.axes[0])
            .y_desc(&self.axes[1])
            .y_label_formatter(&label)
            .y_labels(if self.is_logarithmic { top as usize + 1 } else { 6 })
            .light_line_style(TRANSPARENT)
            .draw()?;
        if let Some(mark) = self.mark.map(|mark| self.upward(mark)) {
            chart.draw_series([PathElement::new(vec![(left, mark), (right, mark)], BLACK.mix(0.6))])?;
        }
        for (number, curve) in self.curves.iter().enumerate() {
            let style = Palette99::pick(number).stroke_width(2);
            let line: Vec<(f32, f32)> = curve.finite().map(|[x, y]| (x, self.upward(y))).collect();
            chart
                .draw_series([PathElement::new(line, style)])?
                .label(&curve.name)
                .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 16, y)], style));
        }
        chart.configure_series_labels().position(SeriesLabelPosition::UpperRight).background_style(WHITE).draw()
    }

    fn upward(&self, y: f32) -> f32 {
        if self.is_logarithmic { libm::log10f(y.max(1.0)) } else { y }
    }
}

impl Curve {
    fn finite(&self) -> impl Iterator<Item = [f32; 2]> {
        self.points.iter().copied().filter(|point| point.iter().all(|value| value.is_finite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(points: Vec<[f32; 2]>, is_logarithmic: bool) -> Panel {
        let curve = Curve { name: "cups".to_owned(), points };
        let axes = ["distance (m)".to_owned(), "points".to_owned()];
        Panel { axes, is_logarithmic, mark: Some(10.0), curves: vec![curve] }
    }

    #[test]
    fn every_panel_has_its_curves_and_names() {
        let points = vec![[1.0, 900.0], [2.0, f32::NAN], [3.0, 0.0]];
        let svg = draw(&[panel(points.clone(), false), panel(points, true)]).expect("a drawing");
        for text in ["cups", "distance (m)", "points"] {
            assert_eq!(svg.lines().filter(|line| line.trim() == text).count(), 2, "{text}");
        }
        assert!(!svg.contains("NaN") && svg.contains("100"));
    }

    #[test]
    fn without_points_there_are_axes() {
        assert!(draw(&[panel(vec![], true)]).expect("a drawing").contains("distance (m)"));
        assert!(draw(&[]).expect("a drawing").starts_with("<svg"));
    }
}
