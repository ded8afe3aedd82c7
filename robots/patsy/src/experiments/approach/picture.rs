use super::{Approach, Controller, End, drive::CONTAINER};
use crate::WHEEL_BOXES;
use std::fmt::Write as _;

/// Pixels per metre.
const SCALE: f32 = 60.0;
/// Size of one panel, in pixels.
const PANEL: (f32, f32) = (470.0, 560.0);

/// Drawing of all approaches as SVG: one panel for each controller, with an arrow at each start pose. It is blue if
/// every approach from there ended beneath the container, and pale otherwise.
pub fn picture(approaches: &[Approach]) -> String {
    let (width, height) = (PANEL.0 * Controller::ALL.len() as f32, PANEL.1);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"16\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (i, controller) in Controller::ALL.into_iter().enumerate() {
        let of: Vec<&Approach> = approaches.iter().filter(|a| a.controller == controller).collect();
        let beneath = of.iter().filter(|a| a.end == End::Beneath).count();
        let percent = 100.0 * beneath as f64 / of.len().max(1) as f64;
        // Writing to a string cannot fail.
        let _ = writeln!(
            svg,
            "<g transform=\"translate({},0)\">\n<text x=\"16\" y=\"28\">{controller}: {percent:.1} % of {}</text>",
            PANEL.0 * i as f32,
            of.len()
        );
        draw_container(&mut svg);
        // Failures first, so that no arrow of them hides a success.
        for is_beneath in [false, true] {
            of.iter().filter(|a| (a.end == End::Beneath) == is_beneath).for_each(|a| draw_start(&mut svg, a));
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

fn place(x: f32, y: f32) -> (f32, f32) {
    (SCALE * (x + 2.4), 0.5 * PANEL.1 - SCALE * y + 10.0)
}

fn draw_start(svg: &mut String, approach: &Approach) {
    let colour = if approach.end == End::Beneath { "#1f5fd0" } else { "#d8d8d8" };
    let start = approach.start;
    let ((x, y), (sin, cos)) = (place(start.x, start.y), libm::sincosf(start.theta));
    let tip = (x + 20.0 * cos, y - 20.0 * sin);
    let _ = writeln!(
        svg,
        "<path d=\"M{x:.1} {y:.1}L{:.1} {:.1}\" stroke=\"{colour}\" stroke-width=\"2\"/>\
         <circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\" fill=\"{colour}\"/>",
        tip.0, tip.1
    );
}

fn draw_container(svg: &mut String) {
    let mut block = |x: f32, y: f32, length: f32, width: f32, style: &str| {
        let (left, top) = place(CONTAINER.x + x - 0.5 * length, CONTAINER.y + y + 0.5 * width);
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" {style}/>",
            SCALE * length,
            SCALE * width
        );
    };
    block(0.0, 0.0, crate::LENGTH, crate::WIDTH, "fill=\"none\" stroke=\"black\" stroke-width=\"2\"");
    for [x, y, ..] in WHEEL_BOXES {
        block(*x, *y, crate::WHEEL_LENGTH, crate::WHEEL_WIDTH, "fill=\"black\"");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::scan::Pose2;

    #[test]
    fn both_panels_show_their_approaches() {
        let approach = |controller, end| Approach { controller, start: Pose2::default(), end, time: 1.0, offset: 0.0 };
        let svg = picture(&[approach(Controller::Reactive, End::Missed), approach(Controller::Planned, End::Beneath)]);
        assert!(svg.contains("reactive: 0.0 % of 1") && svg.contains("planned: 100.0 % of 1"));
        assert_eq!((svg.matches("#d8d8d8").count(), svg.matches("#1f5fd0").count()), (2, 2));
        assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
    }
}
