use super::{Edge, PoseGraph, RobustKernel, pose};
use crate::{
    io::{Lines, ReadError, shown},
    scan::Point2,
};
use nalgebra::Matrix3;
use std::{collections::BTreeMap, path::Path, str::SplitWhitespace};

/// Excess of a correlation over 1 that is taken for the rounding of the numbers in a file.
const ROUNDING: f64 = 1e-6;

/// Order of the numbers of an information matrix in the line of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    /// I₁₁ I₁₂ I₁₃ I₂₂ I₂₃ I₃₃.
    G2o,
    /// I₁₁ I₁₂ I₂₂ I₃₃ I₁₃ I₂₃.
    Toro,
}

/// Edge of a file, whose ends are ids of vertices.
struct Line {
    number: usize,
    ends: [u64; 2],
    edge: Edge,
}

/// Points of scans, in m, by the number of the pose.
pub(super) type Scans = BTreeMap<usize, Vec<Point2>>;

/// Content of a file.
#[derive(Default)]
struct Content {
    graph: PoseGraph,
    numbers: BTreeMap<u64, usize>,
    edges: Vec<Line>,
    scans: Scans,
}

impl PoseGraph {
    /// Reads a file in the format of the program g2o or TORO, in metres and radians:
    ///
    /// - `VERTEX_SE2 id x y θ` and `EDGE_SE2 from to x y θ I₁₁ I₁₂ I₁₃ I₂₂ I₂₃ I₃₃` (g2o),
    /// - `VERTEX2 id x y θ` and `EDGE2 from to x y θ I₁₁ I₁₂ I₂₂ I₃₃ I₁₃ I₂₃` (TORO).
    ///
    /// Comments (`#`), `FIX` and the scans of a [map](super::Mapper::write) are skipped. Poses are numbered in the
    /// order of their lines, independent of their ids. In a file without vertices they are numbered in the order of
    /// their ids, the first one is at the origin, and the others are
    /// [initialized from a tree](Self::initialize_from_tree).
    ///
    /// # Errors
    /// If the file cannot be read, or a line has another content.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        read(path.as_ref()).map(|(graph, _)| graph)
    }
}

/// Reads a graph, and the scans of its poses.
pub(super) fn read(path: &Path) -> Result<(PoseGraph, Scans), ReadError> {
    let mut lines = Lines::open(path)?;
    let mut content = Content::default();
    while lines.next()?.is_some() {
        content.add(lines.current(), lines.number()).map_err(|message| lines.error(message))?;
    }
    let scans = std::mem::take(&mut content.scans);
    let graph = content.graph().map_err(|(number, message)| lines.error_at(number, message))?;
    Ok((graph, scans))
}

impl Content {
    fn add(&mut self, line: &str, number: usize) -> Result<(), String> {
        let mut words = line.split_whitespace();
        match words.next().unwrap_or_default() {
            "VERTEX_SE2" | "VERTEX2" => self.add_vertex(&mut words),
            "EDGE_SE2" => self.add_edge(&mut words, number, Order::G2o),
            "EDGE2" => self.add_edge(&mut words, number, Order::Toro),
            "SCAN" => self.add_scan(&mut words),
            word if word.starts_with('#') || word == "FIX" => Ok(()),
            word => Err(format!(
                "a line of a pose graph in the plane begins with `VERTEX_SE2` or `EDGE_SE2` (g2o), or with `VERTEX2` or \
                 `EDGE2` (TORO), not with `{}`: remove the line",
                shown(word)
            )),
        }
    }

    fn add_vertex(&mut self, words: &mut SplitWhitespace<'_>) -> Result<(), String> {
        let id = id(words)?;
        let [x, y, theta] = values(words, "x y θ")?;
        match self.numbers.insert(id, self.graph.add_pose(pose(x, y, theta))) {
            Some(_) => Err(format!("there is a vertex {id} already: each vertex has one line and an id of its own")),
            None => Ok(()),
        }
    }

    fn add_edge(&mut self, words: &mut SplitWhitespace<'_>, number: usize, order: Order) -> Result<(), String> {
        let ends = [id(words)?, id(words)?];
        if ends[0] == ends[1] {
            return Err(format!("an edge from vertex {} to itself measures nothing: remove the line", ends[0]));
        }
        let [x, y, theta, numbers @ ..] = values::<9>(words, order.numbers())?;
        let information = order.matrix(numbers);
        if !is_positive(&information) {
            return Err(format!(
                "the information matrix is not positive semidefinite: the numbers of this line are {}",
                order.numbers()
            ));
        }
        let (measured, kernel) = (pose(x, y, theta), RobustKernel::Square);
        self.edges.push(Line { number, ends, edge: Edge { from: 0, to: 0, measured, information, kernel } });
        Ok(())
    }

    fn add_scan(&mut self, words: &mut SplitWhitespace<'_>) -> Result<(), String> {
        let id = id(words)?;
        let pose = *self
            .numbers
            .get(&id)
            .ok_or_else(|| format!("a scan follows the line of its vertex, and vertex {id} has no line above"))?;
        let mut points = Vec::new();
        while let Some(x) = words.next() {
            let y = words.next().ok_or("the last point of the scan has no y: points are pairs of x and y")?;
            let [x, y] = [finite(x)?, finite(y)?].map(|value| value as f32);
            points.push(Point2::new(x, y));
        }
        match self.scans.insert(pose, points) {
            Some(_) => Err(format!("vertex {id} has a scan already")),
            None => Ok(()),
        }
    }

    /// The graph, or the number of a line and the error there.
    fn graph(mut self) -> Result<PoseGraph, (usize, String)> {
        let has_vertices = !self.numbers.is_empty();
        if !has_vertices {
            self.add_missing_vertices();
        }
        for Line { number, ends, edge } in self.edges {
            let pose = |id: u64| self.numbers.get(&id).copied().ok_or_else(|| (number, no_vertex(id)));
            let edge = Edge { from: pose(ends[0])?, to: pose(ends[1])?, ..edge };
            self.graph.add_edge(edge).map_err(|e| (number, e.to_string()))?;
        }
        if !has_vertices {
            self.graph.initialize_from_tree();
        }
        Ok(self.graph)
    }

    fn add_missing_vertices(&mut self) {
        self.numbers = self.edges.iter().flat_map(|line| line.ends).map(|id| (id, 0)).collect();
        for number in self.numbers.values_mut() {
            *number = self.graph.add_pose(pose(0.0, 0.0, 0.0));
        }
    }
}

impl Order {
    fn numbers(self) -> &'static str {
        match self {
            Self::G2o => "x y θ I₁₁ I₁₂ I₁₃ I₂₂ I₂₃ I₃₃",
            Self::Toro => "x y θ I₁₁ I₁₂ I₂₂ I₃₃ I₁₃ I₂₃",
        }
    }

    fn matrix(self, numbers: [f64; 6]) -> Matrix3<f64> {
        let [xx, xy, xt, yy, yt, tt] = match (self, numbers) {
            (Self::G2o, numbers) => numbers,
            (Self::Toro, [xx, xy, yy, tt, xt, yt]) => [xx, xy, xt, yy, yt, tt],
        };
        Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt)
    }
}

fn no_vertex(id: u64) -> String {
    format!(
        "there is no vertex {id}: add its line, or remove the lines of all vertices, which are then placed by the edges"
    )
}

/// Returns `true` for a positive semidefinite matrix: no entry of the diagonal is negative, and the matrix of
/// correlations has no negative minor.
fn is_positive(matrix: &Matrix3<f64>) -> bool {
    let correlation = Matrix3::from_fn(|i, j| {
        let scale = matrix[(i, i)].sqrt() * matrix[(j, j)].sqrt();
        if matrix[(i, j)] == 0.0 { f64::from(u8::from(i == j)) } else { matrix[(i, j)] / scale }
    });
    matrix.diagonal().iter().all(|entry| *entry >= 0.0)
        && correlation.iter().all(|entry| entry.abs() <= 1.0 + ROUNDING)
        && correlation.determinant() >= -ROUNDING
}

fn id(words: &mut SplitWhitespace<'_>) -> Result<u64, String> {
    let word = words.next().ok_or("the id of a vertex is missing, a whole number such as `7`")?;
    word.parse()
        .map_err(|_| format!("`{}` is not the id of a vertex, which is a whole number such as `7`", shown(word)))
}

/// The numbers up to the end of the line, of which there must be exactly `N`.
fn values<const N: usize>(words: &mut SplitWhitespace<'_>, names: &str) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| format!("{N} numbers are expected ({names}), there are {i}"))?;
        *value = finite(word)?;
    }
    match words.next() {
        Some(word) => Err(format!("{N} numbers are expected ({names}), `{}` is one more", shown(word))),
        None => Ok(values),
    }
}

fn finite(word: &str) -> Result<f64, String> {
    let number: Option<f64> = word.parse().ok().filter(|v: &f64| v.is_finite());
    number.ok_or_else(|| format!("`{}` is not a finite number", shown(word)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const VERTICES: &str = "# two poses\nVERTEX_SE2 7 0 0 0\nVERTEX_SE2 3 1 2 0.5\nFIX 7\n";

    fn read(name: &str, text: &str) -> Result<PoseGraph, String> {
        let path = std::env::temp_dir().join(format!("apex-graph-{}-{name}.g2o", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        let graph = PoseGraph::read(&path).map_err(|e| format!("{}: {}", e.line.unwrap_or(0), e.message));
        std::fs::remove_file(path).expect("the file");
        graph
    }

    #[test]
    fn ids_need_no_order() {
        let graph = read("good", &format!("EDGE_SE2 7 3 1 2 0.4 9 2 3 8 1 6\n{VERTICES}")).expect("a graph");
        let edge = &graph.edges()[0];
        assert_eq!((edge.from, edge.to, graph.poses().len()), (0, 1, 2));
        assert_eq!(edge.information, Matrix3::new(9.0, 2.0, 3.0, 2.0, 8.0, 1.0, 3.0, 1.0, 6.0));
        assert!((graph.cost() - 0.06).abs() < 1e-9, "{}", graph.cost());
    }

    #[test]
    fn both_formats_give_the_same_graph() {
        let g2o = read("same1", &format!("{VERTICES}EDGE_SE2 7 3 1 2 0.4 9 2 3 8 1 6\n"));
        let toro = format!("{VERTICES}EDGE2 7 3 1 2 0.4 9 2 8 6 3 1\n").replace("_SE2", "2");
        assert_eq!(g2o, read("same2", &toro));
    }

    #[test]
    fn vertices_that_are_missing_are_placed_by_the_edges() {
        let text = "EDGE2 30 20 1 0 1.5707963267948966 1 0 1 1 0 0\nEDGE2 30 40 2 0 0 1 0 1 1 0 0\n";
        let graph = read("bare", text).expect("a graph");
        let places: Vec<[f64; 2]> =
            graph.poses().iter().map(|p| [p.translation.x, p.translation.y].map(|v| (v * 1e9).round() / 1e9)).collect();
        // Pose 20 is at the origin and turned by a quarter against pose 30.
        assert_eq!(places, [[0.0, 0.0], [0.0, 1.0], [0.0, -1.0]]);
    }

    #[test]
    fn errors_say_the_line_and_what_is_wrong() {
        for (number, (line, message)) in [
            ("EDGE_SE2 7 4 1 2 3 1 0 0 1 0 1", "there is no vertex 4: add its line, or remove"),
            ("EDGE_SE2 7 3 1 2 3 1 0 0 1 0", "9 numbers are expected (x y θ I₁₁ I₁₂ I₁₃ I₂₂ I₂₃ I₃₃), there are 8"),
            ("EDGE2 7 7 1 2 3 1 0 0 1 0 1", "an edge from vertex 7 to itself measures nothing: remove the line"),
            (
                "EDGE_SE2 7 3 1 2 3 100 0 100 500 0 0",
                "the information matrix is not positive semidefinite: the numbers",
            ),
            ("EDGE2 7 3 1 2 3 1 2 1 1 0 0", "the information matrix is not positive semidefinite: the numbers"),
            ("VERTEX_SE2 8 1 2 3 4", "3 numbers are expected (x y θ), `4` is one more"),
            ("VERTEX_SE2 8 1 inf 3", "`inf` is not a finite number"),
            ("VERTEX_SE2 3 1 2 3", "there is a vertex 3 already: each vertex has one line"),
            ("VERTEX2 -1 1 2 3", "`-1` is not the id of a vertex, which is a whole number"),
            ("VERTEX_SE2", "the id of a vertex is missing, a whole number"),
            ("SCAN 5 1 2", "a scan follows the line of its vertex, and vertex 5 has no line above"),
            ("SCAN 3 1 2 0.5", "the last point of the scan has no y: points are pairs of x and y"),
            ("SCAN 3 1 nan", "`nan` is not a finite number"),
            ("VERTEX_XY 1 2", "a line of a pose graph in the plane begins with `VERTEX_SE2` or `EDGE_SE2` (g2o), or"),
        ]
        .into_iter()
        .enumerate()
        {
            let text = format!("{VERTICES}{line}\n# the end\n");
            let error = read(&format!("bad{number}"), &text).expect_err(line);
            assert!(error.starts_with(&format!("5: {message}")), "{error}");
        }
    }
}
