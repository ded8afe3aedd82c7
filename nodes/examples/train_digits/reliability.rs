//! Reliability of a classifier: how often it is right when it says that it is sure.

use std::fmt::{self, Write};

/// Number of ranges of confidence.
const BINS: usize = 10;

/// Classifications by their confidence.
#[derive(Debug, Clone, Default)]
pub struct Reliability {
    /// Number, number of right ones, and sum of the confidences, for each range.
    bins: [(u32, u32, f32); BINS],
}

impl Reliability {
    /// Adds a classification.
    pub fn add(&mut self, confidence: f32, is_right: bool) {
        let (count, right, sum) = &mut self.bins[((confidence * BINS as f32) as usize).min(BINS - 1)];
        *count += 1;
        *right += u32::from(is_right);
        *sum += confidence;
    }

    /// Mean confidence and share of right ones of each range with classifications, and their number.
    fn points(&self) -> impl Iterator<Item = (f32, f32, u32)> {
        let seen = self.bins.iter().filter(|(count, _, _)| *count > 0);
        seen.map(|(count, right, sum)| (sum / *count as f32, *right as f32 / *count as f32, *count))
    }

    /// Expected calibration error: mean difference between confidence and share of right ones (Guo et al. 2017).
    pub fn error(&self) -> f32 {
        let all: u32 = self.points().map(|(_, _, count)| count).sum();
        self.points().map(|(sure, right, count)| (sure - right).abs() * count as f32).sum::<f32>() / all.max(1) as f32
    }
}

impl fmt::Display for Reliability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:>10} {:>8} {:>8}", "confidence", "right", "number")?;
        for (sure, right, count) in self.points() {
            writeln!(f, "{:>9.1}% {:>7.1}% {count:>8}", 100.0 * sure, 100.0 * right)?;
        }
        write!(f, "calibration error {:.1} %", 100.0 * self.error())
    }
}

/// Reliability diagram as SVG: the share of right classifications over the confidence, on the diagonal if the
/// confidences are probabilities.
pub fn diagram(curves: &[(&str, &str, &Reliability)]) -> String {
    /// Side of the square of the diagram, and its distance from the edge.
    const SIDE: f32 = 300.0;
    const EDGE: f32 = 50.0;
    let at = |x: f32, y: f32| (EDGE + SIDE * x, EDGE + SIDE * (1.0 - y));
    let size = SIDE + 2.0 * EDGE;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{size}\" height=\"{size}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n\
         <rect x=\"{EDGE}\" y=\"{EDGE}\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"#888\"/>\n"
    );
    let ((a, b), (c, d)) = (at(0.0, 0.0), at(1.0, 1.0));
    let middle = EDGE + 0.5 * SIDE;
    // Writing to a `String` cannot fail.
    let _ = writeln!(svg, "<path d=\"M{a} {b}L{c} {d}\" stroke=\"#888\" stroke-dasharray=\"4\"/>");
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">confidence</text>", size - 14.0);
    let _ = writeln!(svg, "<text transform=\"translate(16 {middle})rotate(-90)\" text-anchor=\"middle\">right</text>");
    for (x, y) in [0.0_f32, 0.5, 1.0].into_iter().flat_map(|tick| [(tick, 0.0), (0.0, tick)]) {
        let (u, v) = at(x, y);
        let (text, u, v) = if y == 0.0 { (x, u, v + 16.0) } else { (y, u - 16.0, v + 4.0) };
        let _ = writeln!(svg, "<text x=\"{u}\" y=\"{v}\" text-anchor=\"middle\">{text}</text>");
    }
    for (row, (name, colour, curve)) in curves.iter().enumerate() {
        let points: Vec<String> =
            curve.points().map(|(x, y, _)| at(x, y)).map(|(u, v)| format!("{u:.1},{v:.1}")).collect();
        let _ = writeln!(
            svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
            points.join(" ")
        );
        let (x, y) = (EDGE + 10.0, EDGE + 20.0 + 16.0 * row as f32);
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" fill=\"{colour}\">{name}</text>");
    }
    svg + "</svg>\n"
}
