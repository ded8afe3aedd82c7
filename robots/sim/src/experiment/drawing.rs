use apex_nodes::scan::Point2;
use std::fmt::Write as _;

/// Drawing of an area of the plane as SVG, seen from above.
#[derive(Debug, Clone)]
pub struct Drawing {
    svg: String,
    /// Corners of the area, and the margin around it, in m.
    low: Point2,
    high: Point2,
    margin: f32,
    /// Pixels per metre.
    scale: f32,
}

impl Drawing {
    /// Creates the drawing of the area between two corners, in m, with a margin of `margin` m around it. One metre is
    /// `scale` pixels long.
    pub fn new([low, high]: [Point2; 2], margin: f32, scale: f32, background: &str) -> Self {
        let size = high - low;
        let (width, height) = (scale * (size.x + 2.0 * margin), scale * (size.y + 2.0 * margin));
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\">\n\
             <rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"{background}\"/>\n"
        );
        Self { svg, low, high, margin, scale }
    }

    fn place(&self, point: Point2) -> (f32, f32) {
        let Self { low, high, margin, scale, .. } = self;
        (scale * (point.x - low.x + margin), scale * (high.y - point.y + margin))
    }

    /// Draws a path through points. `style` are attributes, such as `fill="none" stroke="black"`.
    pub fn path(&mut self, points: impl IntoIterator<Item = Point2>, style: &str) {
        let mut path = String::new();
        for (i, point) in points.into_iter().enumerate() {
            let (x, y) = self.place(point);
            // Writing to a string cannot fail.
            let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { 'M' } else { 'L' });
        }
        let _ = writeln!(self.svg, "<path d=\"{path}\" {style}/>");
    }

    /// Draws a circle with a radius in pixels.
    pub fn circle(&mut self, centre: Point2, radius: f32, style: &str) {
        let (x, y) = self.place(centre);
        let _ = writeln!(self.svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {style}/>");
    }

    /// Returns the finished drawing.
    pub fn finish(self) -> String {
        self.svg + "</svg>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn y_points_upward() {
        let mut drawing = Drawing::new([Point2::new(-1.0, 0.0), Point2::new(3.0, 2.0)], 1.0, 10.0, "white");
        drawing.path([Point2::new(-1.0, 2.0), Point2::new(3.0, 0.0)], "stroke=\"red\"");
        drawing.circle(Point2::new(0.0, 0.0), 4.0, "fill=\"blue\"");
        let svg = drawing.finish();
        assert!(svg.contains("viewBox=\"0 0 60 40\"") && svg.ends_with("</svg>\n"), "{svg}");
        assert!(svg.contains("<path d=\"M10.0 10.0L50.0 30.0\" stroke=\"red\"/>"), "{svg}");
        assert!(svg.contains("<circle cx=\"20.0\" cy=\"30.0\" r=\"4.0\" fill=\"blue\"/>"), "{svg}");
    }
}
