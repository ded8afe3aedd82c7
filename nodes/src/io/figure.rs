use crate::scan::{Container, Point2, Pose2, Scan, Segments};
use plotters::{chart::ChartContext, coord::types::RangedCoordf32, drawing::DrawingAreaErrorKind, prelude::*};
use std::{
    f32::consts::PI,
    fmt,
    ops::Range,
    path::{Path, PathBuf},
};

/// Error of a file that cannot be written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WriteError {
    /// Path of the file.
    pub path: PathBuf,
    /// Description of the error.
    pub message: String,
}

impl WriteError {
    pub(super) fn new(path: &Path, message: impl fmt::Display) -> Self {
        Self { path: path.into(), message: message.to_string() }
    }
}

impl fmt::Display for WriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.message)
    }
}

impl std::error::Error for WriteError {}

/// Drawing of a scan: points, segments, wheel boxes and poses, seen from above, in the frame of the scanner.
#[derive(Debug, Clone, Copy)]
pub struct ScanFigure<'a> {
    /// Title of the drawing.
    pub title: &'a str,
    /// Scan. Its points are drawn in grey.
    pub scan: &'a Scan,
    /// Segments. Their points are drawn in colours.
    pub segments: &'a Segments,
    /// Detected container.
    pub container: Option<&'a Container>,
    /// Wheel boxes of the model, drawn at the pose of `container` (see
    /// [`ContainerSearch`](crate::scan::ContainerSearch)).
    pub boxes: &'a [[f32; 4]],
    /// True pose of the container, if known.
    pub truth: Option<&'a Pose2>,
    /// Maximum distance of the drawn points, in m.
    pub reach: f32,
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf32, RangedCoordf32>>;
type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

const WIDTH: u32 = 960;
const HEIGHT: u32 = 720;
const POINT: RGBColor = RGBColor(150, 150, 150);
const FOUND: RGBColor = RGBColor(200, 30, 30);
const TRUTH: RGBColor = RGBColor(20, 130, 60);
/// Colours of segments, used in turn.
const SEGMENTS: [RGBColor; 6] = [
    RGBColor(31, 119, 180),
    RGBColor(255, 127, 14),
    RGBColor(148, 103, 189),
    RGBColor(23, 160, 170),
    RGBColor(140, 86, 75),
    RGBColor(227, 119, 194),
];
/// Length of the arrow at a pose, in m.
const ARROW: f32 = 0.6;

impl ScanFigure<'_> {
    /// Writes the drawing as SVG.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        let area = SVGBackend::new(path, (WIDTH, HEIGHT)).into_drawing_area();
        self.draw(&area).map_err(|e| WriteError::new(path, e))
    }

    fn draw(&self, area: &Area<'_>) -> Drawn {
        area.fill(&WHITE)?;
        let (x, y) = self.view();
        let mut chart = ChartBuilder::on(area)
            .caption(self.title, ("sans-serif", 22))
            .margin(12)
            .x_label_area_size(44)
            .y_label_area_size(56)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .x_desc("x (forward) [m]")
            .y_desc("y (left) [m]")
            .axis_desc_style(("sans-serif", 16))
            .label_style(("sans-serif", 14))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(230, 230, 230))
            .draw()?;
        self.draw_points(&mut chart)?;
        self.draw_segments(&mut chart)?;
        self.draw_container(&mut chart)?;
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .label_font(("sans-serif", 15))
            .background_style(WHITE.mix(0.85))
            .border_style(POINT)
            .draw()?;
        area.present()
    }

    fn draw_points(&self, chart: &mut Chart<'_, '_>) -> Drawn {
        let points = self.visible().map(|(_, p)| Circle::new((p.x, p.y), 2, POINT.filled()));
        chart.draw_series(points)?.label("scan").legend(|at| dot(at, POINT));
        let scanner = TriangleMarker::new((0.0, 0.0), 7, BLACK.filled());
        chart
            .draw_series([scanner])?
            .label("scanner")
            .legend(|(x, y)| TriangleMarker::new((x + 9, y), 6, BLACK.filled()));
        Ok(())
    }

    fn draw_segments(&self, chart: &mut Chart<'_, '_>) -> Drawn {
        let colour = |beam: usize| {
            let index = self.segments.iter().position(|segment| segment.contains(beam));
            index.map(|i| SEGMENTS[i % SEGMENTS.len()])
        };
        let points =
            self.visible().filter_map(|(beam, p)| colour(beam).map(|c| Circle::new((p.x, p.y), 3, c.filled())));
        chart.draw_series(points)?.label("segments").legend(|at| dot(at, SEGMENTS[0]));
        Ok(())
    }

    fn draw_container(&self, chart: &mut Chart<'_, '_>) -> Drawn {
        if let Some(truth) = self.truth {
            chart.draw_series([arrow(truth, TRUTH.stroke_width(4))])?.label("true pose").legend(|at| line(at, TRUTH));
        }
        if let Some(container) = self.container {
            let outlines = self.boxes.iter().map(|b| outline(&container.pose, b));
            chart.draw_series(outlines)?;
            let is_symmetric = is_symmetric(self.boxes);
            let (ends, label) = match is_symmetric {
                // The front end is unknown.
                true => {
                    (vec![container.pose, turned(&container.pose)], "found container (either end may be its front)")
                }
                false => (vec![container.pose], "found container"),
            };
            let arrows = ends.iter().map(|end| arrow(end, FOUND.stroke_width(2)));
            chart.draw_series(arrows)?.label(label).legend(|at| line(at, FOUND));
        }
        Ok(())
    }

    /// Points within the maximum distance, with the indices of their beams.
    fn visible(&self) -> impl Iterator<Item = (usize, Point2)> + '_ {
        self.scan.points().filter(|(_, p)| p.norm() <= self.reach)
    }

    /// Ranges of both axes: all drawn points with a margin, on the same scale in x and y.
    fn view(&self) -> (Range<f32>, Range<f32>) {
        let poses = self.truth.into_iter().chain(self.container.map(|c| &c.pose)).map(Pose2::position);
        let all = self.visible().map(|(_, p)| p).chain(poses).filter(|p| p.x.is_finite() && p.y.is_finite());
        let (mut min, mut max) = (Point2::default(), Point2::default());
        for p in all {
            min = Point2::new(min.x.min(p.x), min.y.min(p.y));
            max = Point2::new(max.x.max(p.x), max.y.max(p.y));
        }
        let aspect = WIDTH as f32 / HEIGHT as f32;
        let half = 0.55 * (max.y - min.y).max((max.x - min.x) / aspect).max(1.0);
        let centre = (min + max).scaled(0.5);
        (centre.x - half * aspect..centre.x + half * aspect, centre.y - half..centre.y + half)
    }
}

fn dot((x, y): (i32, i32), colour: RGBColor) -> Circle<(i32, i32), i32> {
    Circle::new((x + 9, y), 3, colour.filled())
}

fn line((x, y): (i32, i32), colour: RGBColor) -> PathElement<(i32, i32)> {
    PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(3))
}

/// Returns `true` if the wheels of a container coincide with themselves after a rotation by 180°.
fn is_symmetric(boxes: &[[f32; 4]]) -> bool {
    let is_same = |a: &[f32; 4], b: &[f32; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
    !boxes.is_empty()
        && boxes.iter().all(|[x, y, length, width]| {
            let turned = [-x, -y, *length, *width];
            boxes.iter().any(|other| is_same(&turned, other))
        })
}

/// Pose rotated by 180°.
fn turned(pose: &Pose2) -> Pose2 {
    Pose2 { theta: pose.theta + PI, ..*pose }
}

/// Arrow from the position of a pose along its heading.
fn arrow(pose: &Pose2, style: ShapeStyle) -> PathElement<(f32, f32)> {
    let head = 0.2 * ARROW;
    let path = [(0.0, 0.0), (ARROW, 0.0), (ARROW - head, 0.6 * head), (ARROW, 0.0), (ARROW - head, -0.6 * head)];
    PathElement::new(path.map(|(x, y)| outer(pose, x, y)), style)
}

/// Outline of a wheel box of a container at `pose`.
fn outline(pose: &Pose2, &[x, y, length, width]: &[f32; 4]) -> PathElement<(f32, f32)> {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)];
    PathElement::new(corners.map(|(a, b)| outer(pose, x + a * length, y + b * width)), FOUND.stroke_width(2))
}

fn outer(pose: &Pose2, x: f32, y: f32) -> (f32, f32) {
    let p = pose.to_outer(Point2::new(x, y));
    (p.x, p.y)
}
