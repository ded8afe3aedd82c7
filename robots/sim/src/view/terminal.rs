//! The picture in characters: the drawing itself, with Braille dots for finer details.

use super::picture::Picture;
use crate::plan::{CELL_HEIGHT, CELL_WIDTH};
use apex_nodes::scan::Point2;
use core::f32::consts::FRAC_PI_4;
use std::fmt::Write as _;

const RESET: &str = "\x1b[0m";
const WALL: &str = "\x1b[90m";
const HIT: &str = "\x1b[91m";
const TRAIL: &str = "\x1b[36m";
const ROBOT: &str = "\x1b[1;93m";
const HOME: &str = "\x1b[92m";
/// Symbols of the robot, by eighths of a turn from the x axis on.
const ARROWS: [char; 8] = ['→', '↗', '↑', '↖', '←', '↙', '↓', '↘'];
/// Dots of a Braille character, by row and column.
const DOTS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];

/// Characters and colours of one picture, with the caption below.
pub fn draw(picture: &Picture) -> String {
    let (columns, rows) = picture.plan.size();
    let (trail, hits) = (dots(picture, &picture.trail), dots(picture, &picture.hits));
    let robot = cell(picture, picture.pose.position());
    let mut text = String::new();
    for row in 0..rows {
        let mut colour = "";
        for column in 0..columns {
            let at = row * columns + column;
            let (wanted, character) = match picture.plan.at(row, column) {
                _ if robot == Some((row, column)) => (ROBOT, arrow(picture.pose.theta)),
                '#' if hits[at] > 0 => (HIT, '█'),
                '#' => (WALL, '█'),
                'o' if hits[at] > 0 => (HIT, '●'),
                'o' => (WALL, '●'),
                '>' | '<' | '^' | 'v' => (HOME, '⌂'),
                _ if hits[at] > 0 => (HIT, braille(hits[at])),
                _ if trail[at] > 0 => (TRAIL, braille(trail[at])),
                _ => (RESET, ' '),
            };
            if wanted != colour {
                text += wanted;
                colour = wanted;
            }
            text.push(character);
        }
        text += RESET;
        text += "\x1b[K\n";
    }
    let _ = writeln!(text, "{}\x1b[K", caption(picture));
    text
}

/// Time and last note.
pub fn caption(picture: &Picture) -> String {
    let note: String = picture.note.chars().filter(|c| !c.is_control()).take(60).collect();
    format!("{:6.1} s  {note}", picture.now.as_secs_f64())
}

/// Braille dots of each character, from the points in it.
fn dots(picture: &Picture, points: &[Point2]) -> Vec<u8> {
    let (columns, rows) = picture.plan.size();
    let mut dots = vec![0; columns * rows];
    for point in points {
        // A scan point may be slightly inside its object, or in front of it.
        if let Some((row, column)) = cell(picture, *point) {
            let (x, y) = place(picture, *point);
            let [across, down] = [x.fract() * 2.0, y.fract() * 4.0].map(|part| part as usize);
            dots[row * columns + column] |= DOTS[down.min(3)][across.min(1)];
        }
    }
    dots
}

/// Position of a point in characters, from the left and from the top.
fn place(picture: &Picture, point: Point2) -> (f32, f32) {
    let (_, height) = picture.plan.extent();
    (point.x / CELL_WIDTH, (height - point.y) / CELL_HEIGHT)
}

/// Row and column of the character at a point, or `None` outside the drawing.
fn cell(picture: &Picture, point: Point2) -> Option<(usize, usize)> {
    let ((x, y), (columns, rows)) = (place(picture, point), picture.plan.size());
    let inside = x >= 0.0 && y >= 0.0 && x < columns as f32 && y < rows as f32;
    inside.then_some((y as usize, x as usize))
}

fn braille(dots: u8) -> char {
    char::from_u32(0x2800 + u32::from(dots)).unwrap_or(' ')
}

fn arrow(theta: f32) -> char {
    let eighths = libm::roundf(theta / FRAC_PI_4).rem_euclid(8.0);
    ARROWS[eighths as usize % 8]
}

#[cfg(test)]
mod tests {
    use super::{super::picture::tests::picture, *};

    /// Text without its colours.
    fn plain(text: &str) -> String {
        let mut parts = text.split('\x1b');
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |text, part| text + part.split_once(['m', 'K']).map_or("", |(_, rest)| rest))
    }

    #[test]
    fn the_picture_is_the_drawing_with_the_robot_in_it() {
        let expected = "\
██████████
█        █
█ ⌂⠤→  ● █
██████████
   1.2 s  drives <on>
";
        let drawn = draw(&picture());
        assert_eq!(plain(&drawn), expected);
        assert!(drawn.contains("\x1b[91m●"), "the scanner has hit the post: {drawn:?}");
    }

    #[test]
    fn arrows_point_where_the_robot_looks() {
        let turns = [0.0, 0.8, 1.6, 3.1, -3.1, -1.6, -0.3, 6.2, f32::NAN];
        assert_eq!(turns.map(arrow).iter().collect::<String>(), "→↗↑←←↓→→→");
    }
}
