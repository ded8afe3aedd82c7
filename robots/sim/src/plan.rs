use crate::World;
use apex_nodes::scan::{Point2, Pose2};
use core::{
    f32::consts::{FRAC_PI_2, PI},
    fmt,
};

/// Width of a character of a drawing, in m.
pub const CELL_WIDTH: f32 = 0.25;
/// Height of a character of a drawing, in m: twice its width, as in most editors and terminals.
pub const CELL_HEIGHT: f32 = 0.5;
/// Radius of a post, in m.
const POST: f32 = 0.12;
/// Maximum number of characters per line, and of lines.
const LONGEST: usize = 400;

/// World drawn with characters, each 25 cm wide and 50 cm high. `#` is a wall and `o` a post; blanks and dots are free.
/// One of `>`, `^`, `<` and `v` is the start of the robot and points in its direction.
///
/// The origin is the lower left corner of the drawing; x points to the right and y up.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorPlan {
    /// Walls and posts.
    pub world: World,
    /// Start pose of the robot.
    pub start: Pose2,
    rows: Vec<Vec<char>>,
    columns: usize,
}

/// Error of a drawing that is not a world.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanError {
    /// Unknown character, with its line and column.
    Character(char, usize, usize),
    /// More than one start: line and column of the second one.
    Second(usize, usize),
    /// No start.
    NoStart,
    /// Drawing too large.
    TooLarge,
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Character(character, line, column) => write!(
                f,
                "line {line}, column {column} of the world: `{character}` means nothing; draw with `#` (wall), \
                 `o` (post), blanks, and one of `>^<v` (where the robot begins)"
            ),
            Self::Second(line, column) => {
                write!(f, "line {line}, column {column} of the world: a second place to begin at; leave one of `>^<v`")
            }
            Self::NoStart => write!(f, "the world has no place to begin at: draw one of `>^<v` where the robot stands"),
            Self::TooLarge => write!(f, "the world is too large: it may have {LONGEST} lines and columns"),
        }
    }
}

impl core::error::Error for PlanError {}

impl FloorPlan {
    /// Reads a drawing.
    ///
    /// # Errors
    /// If the drawing has an unknown character, not exactly one start, or is too large.
    pub fn parse(drawing: &str) -> Result<Self, PlanError> {
        let rows: Vec<Vec<char>> = drawing.lines().map(|line| line.trim_end().chars().collect()).collect();
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        if rows.len() > LONGEST || columns > LONGEST {
            return Err(PlanError::TooLarge);
        }
        let mut plan = Self { world: World::default(), start: Pose2::default(), rows, columns };
        plan.start = plan.read()?;
        plan.add_walls();
        Ok(plan)
    }

    /// Number of columns and of lines.
    pub fn size(&self) -> (usize, usize) {
        (self.columns, self.rows.len())
    }

    /// Width and height, in m.
    pub fn extent(&self) -> (f32, f32) {
        (self.columns as f32 * CELL_WIDTH, self.rows.len() as f32 * CELL_HEIGHT)
    }

    /// Character at a line from the top and a column from the left; a blank outside the drawing.
    pub fn at(&self, row: usize, column: usize) -> char {
        self.rows.get(row).and_then(|line| line.get(column)).copied().unwrap_or(' ')
    }

    /// Reads all characters: adds the posts, and returns the start pose.
    fn read(&mut self) -> Result<Pose2, PlanError> {
        let mut start = None;
        for (row, line) in self.rows.iter().enumerate() {
            for (column, character) in line.iter().enumerate() {
                let x = (column as f32 + 0.5) * CELL_WIDTH;
                let y = (self.rows.len() as f32 - row as f32 - 0.5) * CELL_HEIGHT;
                let heading = match character {
                    '#' | ' ' | '.' => continue,
                    'o' => {
                        self.world.disc(Point2::new(x, y), POST);
                        continue;
                    }
                    '>' => 0.0,
                    '^' => FRAC_PI_2,
                    '<' => PI,
                    'v' => -FRAC_PI_2,
                    other => return Err(PlanError::Character(*other, row + 1, column + 1)),
                };
                if start.replace(Pose2::new(x, y, heading)).is_some() {
                    return Err(PlanError::Second(row + 1, column + 1));
                }
            }
        }
        start.ok_or(PlanError::NoStart)
    }

    /// Adds the edges between walls and free places, each as long as possible.
    fn add_walls(&mut self) {
        let (columns, rows) = self.size();
        let x = |column: usize| column as f32 * CELL_WIDTH;
        let y = |row: usize| (rows - row) as f32 * CELL_HEIGHT;
        let mut edges = vec![];
        for row in 1..rows {
            runs(
                columns,
                |column| self.is_wall(row - 1, column) != self.is_wall(row, column),
                |from, to| {
                    edges.push((Point2::new(x(from), y(row)), Point2::new(x(to), y(row))));
                },
            );
        }
        for column in 1..columns {
            runs(
                rows,
                |row| self.is_wall(row, column - 1) != self.is_wall(row, column),
                |from, to| {
                    edges.push((Point2::new(x(column), y(from)), Point2::new(x(column), y(to))));
                },
            );
        }
        edges.into_iter().for_each(|(a, b)| self.world.wall(a, b));
    }

    fn is_wall(&self, row: usize, column: usize) -> bool {
        self.at(row, column) == '#'
    }
}

/// Calls `found` for each longest run of places below `count` for which `holds` is true, with its first place and the
/// one after its last.
fn runs(count: usize, holds: impl Fn(usize) -> bool, mut found: impl FnMut(usize, usize)) {
    let mut begin = None;
    for place in 0..=count {
        let inside = place < count && holds(place);
        match begin {
            None if inside => begin = Some(place),
            Some(from) if !inside => {
                found(from, place);
                begin = None;
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drawing_is_a_world() {
        let plan = FloorPlan::parse("########\n#      #\n# ^  o #\n########\n").expect("a room");
        assert_eq!((plan.size(), plan.extent()), ((8, 4), (2.0, 2.0)));
        assert_eq!(plan.start, Pose2::new(0.625, 0.75, FRAC_PI_2));
        assert_eq!((plan.world.walls().len(), plan.world.discs().len()), (4, 1));
        let right = plan.world.cast(plan.start.position(), Point2::new(1.0, 0.0));
        assert_eq!(right, Some(1.375 - 0.625 - POST), "the post");
        assert_eq!(plan.world.cast(plan.start.position(), Point2::new(0.0, 1.0)), Some(0.75), "the wall above");
    }

    #[test]
    fn what_is_no_world_is_refused() {
        for (drawing, error) in [
            ("", PlanError::NoStart),
            ("###\n# #\n###", PlanError::NoStart),
            ("#>#\n#X#", PlanError::Character('X', 2, 2)),
            ("> <", PlanError::Second(1, 3)),
            (&"#".repeat(LONGEST + 1), PlanError::TooLarge),
            (&"\n".repeat(LONGEST + 1), PlanError::TooLarge),
        ] {
            assert_eq!(FloorPlan::parse(drawing), Err(error));
        }
    }
}
