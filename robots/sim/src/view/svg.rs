//! The picture as SVG.

use super::picture::Picture;
use crate::plan::{CELL_HEIGHT, CELL_WIDTH};
use apex_nodes::scan::Point2;
use std::fmt::Write as _;

/// Pixels per metre.
const SCALE: f32 = 48.0;
/// Height of the caption below the map, in pixels.
const CAPTION: f32 = 34.0;
/// Radius of the drawn robot, in m.
const ROBOT: f32 = 0.2;

/// Content of the file.
pub fn draw(picture: &Picture) -> String {
    let (width, height) = picture.plan.extent();
    let (width, height) = (width * SCALE, height * SCALE);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{:.0}\" font-family=\"sans-serif\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#f6f5f1\"/>\n",
        height + CAPTION
    );
    let at = |point: Point2| format!("{:.1},{:.1}", point.x * SCALE, height - point.y * SCALE);
    let seen: Vec<String> = [picture.pose.position()].iter().chain(&picture.hits).map(|p| at(*p)).collect();
    let _ = writeln!(text, "<polygon points=\"{}\" fill=\"#ffd54a\" fill-opacity=\"0.28\"/>", seen.join(" "));
    walls(picture, &mut text);
    let home = at(picture.plan.start.position());
    let (x, y) = home.split_once(',').unwrap_or_default();
    let _ = writeln!(
        text,
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"14\" fill=\"none\" stroke=\"#2e9e5b\" \
         stroke-width=\"3\" stroke-dasharray=\"6 4\"/>"
    );
    let trail: Vec<String> = picture.trail.iter().map(|p| at(*p)).collect();
    let _ = writeln!(
        text,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#2878b5\" \
         stroke-width=\"3\" stroke-opacity=\"0.75\" stroke-linejoin=\"round\"/>",
        trail.join(" ")
    );
    let hits: String = picture.hits.iter().map(|p| format!("M{}h0", at(*p))).collect();
    let _ = writeln!(text, "<path d=\"{hits}\" stroke=\"#d43d2a\" stroke-width=\"4\" stroke-linecap=\"round\"/>");
    robot(picture, height, &mut text);
    let note = format!("{:.1} s  {}", picture.now.as_secs_f64(), escaped(&picture.note));
    let _ = writeln!(text, "<text x=\"12\" y=\"{:.0}\" font-size=\"18\" fill=\"#333\">{note}</text>", height + 23.0);
    text + "</svg>\n"
}

/// Walls as boxes, one for each run in a line of the drawing, and posts.
fn walls(picture: &Picture, text: &mut String) {
    let (columns, rows) = picture.plan.size();
    let (w, h) = (CELL_WIDTH * SCALE, CELL_HEIGHT * SCALE);
    for row in 0..rows {
        let is_wall = |column: usize| picture.plan.at(row, column) == '#';
        let (mut column, y) = (0, row as f32 * h);
        while column < columns {
            let count = (column..columns).take_while(|column| is_wall(*column)).count();
            if count > 0 {
                let (x, wide) = (column as f32 * w, count as f32 * w);
                // Slightly higher, so that no seam shows between lines.
                let _ = writeln!(
                    text,
                    "<rect x=\"{x}\" y=\"{y}\" width=\"{wide}\" height=\"{}\" fill=\"#454b57\"/>",
                    h + 0.5
                );
            }
            column += count.max(1);
        }
    }
    for post in picture.plan.world.discs() {
        let (x, y, r) = (post.centre.x * SCALE, rows as f32 * h - post.centre.y * SCALE, post.radius * SCALE);
        let _ = writeln!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r:.1}\" fill=\"#454b57\"/>");
    }
}

/// Robot: a disc with a wedge that points ahead.
fn robot(picture: &Picture, height: f32, text: &mut String) {
    let (x, y) = (picture.pose.x * SCALE, height - picture.pose.y * SCALE);
    let (r, turn) = (ROBOT * SCALE, -picture.pose.theta.to_degrees());
    let _ = writeln!(
        text,
        "<g transform=\"translate({x:.1} {y:.1}) rotate({turn:.1})\">\
         <circle r=\"{r}\" fill=\"#f28c28\" stroke=\"#5b3410\" stroke-width=\"1.5\"/>\
         <path d=\"M{:.1} 0L{:.1} {:.1}V{:.1}z\" fill=\"#5b3410\"/></g>",
        0.85 * r,
        -0.35 * r,
        -0.55 * r,
        0.55 * r
    );
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{super::picture::tests::picture, *};

    #[test]
    fn all_that_there_is_to_see_is_drawn() {
        let text = draw(&picture());
        assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"), "{text}");
        assert!(text.contains("translate(54.0 60.0) rotate(-0.0)"), "the robot is at (1.125, 0.75): {text}");
        assert!(text.contains("1.2 s  drives &lt;on&gt;</text>"), "{text}");
        assert_eq!(text.matches("<rect").count(), 1 + 2 + 2 * 2, "the floor, two whole lines, the ends of two");
        assert!(text.contains("M108.0,48.0h0M86.4,60.0h0"), "{text}");
    }
}
