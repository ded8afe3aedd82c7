use apex_nodes::cloud::Label;
use apex_sim::{
    experiment::write_file,
    tof::{TofFrame, Truth},
};
use core::fmt::Write as _;
use std::path::Path;

/// Picture of a frame: its intensities, its truth, and the labels of the detection.
pub struct SceneFigure<'a> {
    /// Frame of the camera.
    pub frame: &'a TofFrame,
    /// Labels, column by column.
    pub labels: &'a [Label],
}

/// Side of a pixel in the picture.
const SCALE: usize = 3;
const GAP: usize = 12;
const TOP: usize = 26;
const BOTTOM: usize = 34;
const MISSING: &str = "#f4f4f4";
const FLOOR: &str = "#b9d7b0";
const LEGEND: [(&str, &str); 7] = [
    (FLOOR, "floor"),
    (SMALL, "small obstacle"),
    (OBJECT, "object"),
    (OVERHANGING, "overhanging"),
    (ARTEFACT, "artefact"),
    (UNKNOWN, "unlabelled, unknown"),
    (MISSING, "not measured"),
];
const SMALL: &str = "#d62728";
const OBJECT: &str = "#ff7f0e";
const OVERHANGING: &str = "#9467bd";
const ARTEFACT: &str = "#17becf";
const UNKNOWN: &str = "#8c8c8c";

impl SceneFigure<'_> {
    /// Writes the picture as SVG.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        write_file(path, &self.svg())
    }

    fn svg(&self) -> String {
        let (width, height) = self.frame.cloud.size();
        let panel = SCALE * width + GAP;
        let (whole, tall) = (3 * panel + GAP, TOP + SCALE * height + BOTTOM);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {whole} {tall}\" font-family=\"sans-serif\" \
             font-size=\"15\" shape-rendering=\"crispEdges\">\n<rect width=\"{whole}\" height=\"{tall}\" fill=\"#fff\"/>\n"
        );
        let panels: [(&str, &dyn Fn(usize) -> String); 3] = [
            ("intensity", &|i| self.light(i)),
            ("truth", &|i| self.truth(i).to_owned()),
            ("detected", &|i| self.label(i).to_owned()),
        ];
        for (number, (title, color)) in panels.into_iter().enumerate() {
            let left = GAP + number * panel;
            // Writing to a `String` cannot fail.
            let _ = writeln!(svg, "<text x=\"{left}\" y=\"18\">{title}</text>");
            let _ = writeln!(svg, "<g transform=\"translate({left} {TOP}) scale({SCALE})\">");
            for row in 0..height {
                write_row(&mut svg, row, width, |column| color(row * width + column));
            }
            svg.push_str("</g>\n");
        }
        legend(&mut svg, TOP + SCALE * height + 22);
        svg.push_str("</svg>\n");
        svg
    }

    fn light(&self, i: usize) -> String {
        let point = self.frame.cloud.points()[i];
        if !point.is_measured() {
            return MISSING.to_owned();
        }
        // Few levels, so that pixels of a row join.
        let level = (libm::log2f(1.0 + point.intensity) * 1.2) as u32;
        let gray = (level * 20).min(240);
        format!("#{gray:02x}{gray:02x}{gray:02x}")
    }

    fn truth(&self, i: usize) -> &'static str {
        match self.frame.truth[i] {
            _ if !self.frame.cloud.points()[i].is_measured() => MISSING,
            Truth::Unlabelled => UNKNOWN,
            Truth::Floor => FLOOR,
            Truth::Small => SMALL,
            Truth::Object => OBJECT,
            Truth::Overhanging => OVERHANGING,
            Truth::Artefact => ARTEFACT,
        }
    }

    fn label(&self, i: usize) -> &'static str {
        let (width, height) = self.frame.cloud.size();
        match self.labels.get(i % width * height + i / width).copied().unwrap_or_default() {
            Label::Missing => MISSING,
            Label::Artefact => ARTEFACT,
            Label::Unknown | Label::Below => UNKNOWN,
            Label::Overhanging => OVERHANGING,
            Label::Floor => FLOOR,
            Label::Obstacle => SMALL,
        }
    }
}

/// Writes the pixels of a row; pixels of one colour that follow each other are one rectangle.
fn write_row(svg: &mut String, row: usize, width: usize, color: impl Fn(usize) -> String) {
    let mut first = 0;
    while first < width {
        let fill = color(first);
        let count = (first..width).take_while(|column| color(*column) == fill).count();
        let _ = writeln!(svg, "<path d=\"M{first} {row}h{count}v1h-{count}z\" fill=\"{fill}\"/>");
        first += count;
    }
}

fn legend(svg: &mut String, y: usize) {
    let mut x = GAP;
    for (color, name) in LEGEND {
        let _ = writeln!(
            svg,
            "<rect x=\"{x}\" y=\"{}\" width=\"14\" height=\"14\" fill=\"{color}\" stroke=\"#999\"/>",
            y - 12
        );
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{y}\">{name}</text>", x + 20);
        x += 48 + 8 * name.len();
    }
    let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\">(detected obstacles near the floor are red)</text>");
}
