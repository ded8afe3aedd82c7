//! Picture of the ratios: a row for each graph, a dot for each participant, on a logarithmic axis.

use super::row::Row;
use std::fmt::Write as _;

const WIDTH: f64 = 860.0;
/// Start and end of the axis.
const LEFT: f64 = 90.0;
const RIGHT: f64 = WIDTH - 20.0;
const ROW: f64 = 24.0;
/// Number of names per line above the rows.
const NAMES: usize = 7;
const NAME: f64 = 118.0;

/// Distinguishable colours, also for people with colour blindness. The first one is that of Apex.
const COLOURS: [&str; 14] = [
    "#d62728", "#ff9896", "#1f77b4", "#17becf", "#9467bd", "#2ca02c", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22",
    "#aec7e8", "#ffbb78", "#98df8a", "#c5b0d5",
];

/// The picture as SVG.
pub fn svg(rows: &[Row]) -> String {
    let names = names(rows);
    let top = 30.0 + 18.0 * names.len().div_ceil(NAMES) as f64;
    let bottom = top + ROW * rows.len() as f64;
    let axis = Axis::of(rows);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"{WIDTH}\" height=\"{height}\" fill=\"white\"/>\n",
        height = bottom + 44.0
    );
    for (i, name) in names.iter().enumerate() {
        let (x, y) = (20.0 + NAME * (i % NAMES) as f64, 18.0 + 18.0 * (i / NAMES) as f64);
        let _ = writeln!(svg, "{}<text x=\"{}\" y=\"{}\">{name}</text>", dot(x, y, i), x + 9.0, y + 4.0);
    }
    axis.draw(&mut svg, top, bottom);
    for (i, row) in rows.iter().enumerate() {
        let y = top + ROW * (i as f64 + 0.5);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>", LEFT - 10.0, y + 4.0, row.graph);
        // The first names in the list are drawn last, above the others.
        let right = row.others.iter().filter(|other| other.equal);
        let mut dots: Vec<_> = right.filter_map(|o| Some((index(&names, &o.name)?, o.ratio))).collect();
        dots.sort_by_key(|(index, _)| std::cmp::Reverse(*index));
        for (index, ratio) in dots {
            let _ = writeln!(svg, "{}", dot(axis.x(ratio), y, index));
        }
    }
    svg + "</svg>\n"
}

/// All names: first those of Apex, then the others in the order of their occurrence.
fn names(rows: &[Row]) -> Vec<&str> {
    let mut names: Vec<&str> = vec!["apex"];
    let all = || rows.iter().flat_map(|row| &row.others);
    let apex = all().filter(|other| other.name.starts_with("apex") && !other.is_apex());
    for other in apex.chain(all()) {
        if index(&names, &other.name).is_none() {
            names.push(&other.name);
        }
    }
    names
}

fn index(names: &[&str], name: &str) -> Option<usize> {
    names.iter().position(|n| *n == name)
}

fn dot(x: f64, y: f64, index: usize) -> String {
    let (radius, colour) = (if index == 0 { 6.0 } else { 4.0 }, COLOURS[index % COLOURS.len()]);
    format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\" stroke=\"white\"/>")
}

/// Whole powers of ten from the lowest to the highest ratio.
struct Axis {
    low: i32,
    high: i32,
}

impl Axis {
    fn of(rows: &[Row]) -> Self {
        let powers = || rows.iter().flat_map(|row| &row.others).map(|other| other.ratio.log10());
        let low = powers().fold(0.0, f64::min).floor() as i32;
        Self { low, high: (powers().fold(0.0, f64::max).ceil() as i32).max(low + 1) }
    }

    fn x(&self, ratio: f64) -> f64 {
        LEFT + (ratio.log10() - f64::from(self.low)) / f64::from(self.high - self.low) * (RIGHT - LEFT)
    }

    /// Draws a line for each power of ten; that of the hand-written program is thicker.
    fn draw(&self, svg: &mut String, top: f64, bottom: f64) {
        for power in self.low..=self.high {
            let x = self.x(10f64.powi(power));
            let (colour, width) = if power == 0 { ("black", 2) } else { ("#ccc", 1) };
            let label = if power == 0 { "by hand".to_owned() } else { format!("{}", 10f64.powi(power)) };
            let _ = writeln!(
                svg,
                "<line x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{bottom}\" stroke=\"{colour}\" \
                 stroke-width=\"{width}\"/><text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                bottom + 16.0
            );
        }
        let middle = (LEFT + RIGHT) / 2.0;
        let _ = writeln!(
            svg,
            "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">time per tick, in times of hand-written Rust</text>",
            bottom + 36.0
        );
    }
}
