use super::{clock, seconds, shortened};
use crate::world::Arena;
use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;
use std::{
    io::{IsTerminal as _, Write as _},
    time::{Duration, Instant},
};

/// Columns and rows of the arena. A character is about twice as high as wide.
const COLUMNS: usize = 38;
const ROWS: usize = 19;
/// Half of the visible side of the arena, in m.
const REACH: f32 = 6.5;
/// Maximum number of characters beside the arena.
const BESIDE: usize = 38;
/// Minimum time between two views.
const PACE: Duration = Duration::from_millis(100);

/// Snapshot of a run.
#[derive(Debug, Clone)]
pub struct Snapshot<'a> {
    /// Time of the run.
    pub now: Time,
    /// Arena of the run.
    pub arena: &'a Arena,
    /// True pose of the robot.
    pub pose: Pose2,
    /// Positions of the other robots.
    pub rivals: Vec<Point2>,
    /// Points for correct deliveries.
    pub points: u32,
    /// Penalties.
    pub penalties: u32,
    /// Active phases.
    pub active: Vec<String>,
    /// Number of the cube in the hopper.
    pub hopper: Option<u32>,
}

/// Shows the progress of a run on standard error: on a terminal as a map that is redrawn in place, otherwise as a line
/// per minute if lines are requested.
#[derive(Debug)]
pub struct LiveView {
    output: Output,
    drawn: Option<Instant>,
    /// Minute of the next line.
    minute: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Output {
    Map,
    Lines,
    Nothing,
}

impl LiveView {
    /// Creates a view for the type of standard error. `lines` requests lines if it is not a terminal.
    pub fn new(lines: bool) -> Self {
        let output = match std::io::stderr().is_terminal() {
            true => Output::Map,
            false if lines => Output::Lines,
            false => Output::Nothing,
        };
        Self { output, drawn: None, minute: 0 }
    }

    /// Shows the snapshot at `now`, if a view is due.
    pub fn show<'a>(&mut self, now: Time, snapshot: impl FnOnce() -> Snapshot<'a>) {
        if let Some(text) = self.text(now, Instant::now(), snapshot) {
            let mut terminal = std::io::stderr();
            // Failing to show the view is not a reason to stop.
            let _ = terminal.write_all(text.as_bytes()).and_then(|()| terminal.flush());
        }
    }

    /// Text to write now, if any.
    fn text<'a>(&mut self, now: Time, wall: Instant, snapshot: impl FnOnce() -> Snapshot<'a>) -> Option<String> {
        match self.output {
            Output::Map => {
                if self.drawn.is_some_and(|drawn| wall.duration_since(drawn) < PACE) {
                    return None;
                }
                // Over the previous drawing; the rest of each line is erased.
                let up = self.drawn.replace(wall).map_or_else(String::new, |_| format!("\x1b[{ROWS}A"));
                let lines: Vec<String> = snapshot().lines().iter().map(|line| format!("{line}\x1b[K\n")).collect();
                Some(up + &lines.concat())
            }
            Output::Lines => {
                let minute = seconds(now) as u32 / 60;
                if minute < self.minute {
                    return None;
                }
                self.minute = minute + 1;
                Some(format!("{}\n", snapshot().line()))
            }
            Output::Nothing => None,
        }
    }
}

impl Snapshot<'_> {
    /// Lines of the arena, with the state of the run beside them.
    fn lines(&self) -> Vec<String> {
        let beside = self.beside();
        let mut beside = beside.iter().map(|text| shortened(text, BESIDE));
        let rows = self.chart();
        rows.iter().map(|row| format!("{row}  {}", beside.next().unwrap_or_default()).trim_end().to_owned()).collect()
    }

    /// State of the run in one line.
    fn line(&self) -> String {
        format!("{}: points {}, penalties {}", clock(seconds(self.now)), self.points, self.penalties)
    }

    fn beside(&self) -> Vec<String> {
        let hopper = self.hopper.map_or_else(|| "empty".to_owned(), |number| format!("a cube for {number}"));
        let mut lines = vec![
            format!("time       {}", clock(seconds(self.now))),
            format!("points     {}", self.points),
            format!("penalties  {}", self.penalties),
            format!("hopper     {hopper}"),
            String::new(),
        ];
        lines.extend(self.active.iter().cloned());
        lines
    }

    /// Chart of the arena: walls as `#`, filling stations as `+`, delivery stations by their numbers, the robot as `A`,
    /// and the others as `B` and so on. Later characters replace earlier ones.
    fn chart(&self) -> Vec<String> {
        let mut chart = Chart([[' '; COLUMNS]; ROWS]);
        for wall in self.arena.world.walls() {
            let parts = 1 + (8.0 * (wall.b - wall.a).norm()) as u32;
            let points = (0..=parts).map(|i| wall.a + (wall.b - wall.a).scaled(i as f32 / parts as f32));
            points.for_each(|point| chart.put(point, '#'));
        }
        self.arena.filling.iter().for_each(|station| chart.put(station.pose.position(), '+'));
        for (station, number) in self.arena.delivery.iter().zip('1'..) {
            chart.put(station.pose.position(), number);
        }
        self.rivals.iter().zip('B'..='Z').for_each(|(place, letter)| chart.put(*place, letter));
        chart.put(self.pose.position(), 'A');
        chart.0.iter().map(|row| row.iter().collect()).collect()
    }
}

/// Arena in characters.
struct Chart([[char; COLUMNS]; ROWS]);

impl Chart {
    /// Puts a character at a place, or nothing if the place is outside.
    fn put(&mut self, place: Point2, character: char) {
        let column = (0.5 + 0.5 * place.x / REACH) * COLUMNS as f32;
        let row = (0.5 - 0.5 * place.y / REACH) * ROWS as f32;
        // False for NaN.
        if column >= 0.0 && row >= 0.0 && column < COLUMNS as f32 && row < ROWS as f32 {
            self.0[row as usize][column as usize] = character;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn snapshot(arena: &Arena) -> Snapshot<'_> {
        Snapshot {
            now: Time::from_secs(83),
            arena,
            pose: Pose2::new(3.0, 0.0, 0.0),
            rivals: vec![Point2::new(-3.0, 3.0), Point2::new(f32::NAN, 0.0), Point2::new(99.0, 0.0)],
            points: 7,
            penalties: 1,
            active: vec!["fetch".to_owned(), "fetch / position".to_owned()],
            hopper: Some(3),
        }
    }

    fn view(output: Output) -> LiveView {
        LiveView { output, drawn: None, minute: 0 }
    }

    #[test]
    fn the_view_shows_the_arena_and_the_score() {
        let arena = Arena::new(3);
        let lines = snapshot(&arena).lines();
        assert_eq!(lines.len(), ROWS);
        assert!(lines.iter().all(|line| line.chars().count() < 80));
        let text = lines.join("\n");
        for part in ["time       1:23", "points     7", "penalties  1", "hopper     a cube for 3", "  fetch / position"]
        {
            assert!(text.contains(part), "no `{part}` in:\n{text}");
        }
        let chart = snapshot(&arena).chart();
        assert_eq!(chart[9].chars().nth(27), Some('A'), "{text}");
        assert_eq!(chart[5].chars().nth(10), Some('B'), "{text}");
        let count = |character| chart.iter().flat_map(|row| row.chars()).filter(|c| *c == character).count();
        assert_eq!(['1', '2', '3', '4', '+', 'C'].map(count), [1, 1, 1, 1, 4, 0], "{text}");
    }

    #[test]
    fn a_view_is_drawn_over_the_last_one_and_not_too_often() {
        let (arena, start) = (Arena::new(1), Instant::now());
        let mut view = view(Output::Map);
        let mut at = |ms| view.text(Time::ZERO, start + Duration::from_millis(ms), || snapshot(&arena));
        let (first, early, second) = (at(0), at(99), at(100));
        let first = first.expect("the first one");
        assert_eq!((first.matches('\n').count(), first.matches('A').count(), early), (ROWS, 1, None));
        assert_eq!(second, Some(format!("\x1b[{ROWS}A{first}")));
    }

    #[test]
    fn lines_come_once_a_minute_and_only_if_asked() {
        let (arena, wall) = (Arena::new(1), Instant::now());
        let count = |output| {
            let mut view = view(output);
            (0..300).filter_map(|s| view.text(Time::from_secs(s), wall, || snapshot(&arena))).count()
        };
        assert_eq!((count(Output::Lines), count(Output::Nothing)), (5, 0));
        assert_eq!(snapshot(&arena).line(), "1:23: points 7, penalties 1");
    }
}
