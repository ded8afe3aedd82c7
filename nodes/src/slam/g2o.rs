use super::{Edge, PoseGraph, pose};
use crate::io::{Lines, ReadError};
use nalgebra::Matrix3;
use std::{collections::BTreeMap, path::Path, str::SplitWhitespace};

impl PoseGraph {
    /// Reads the lines `VERTEX_SE2 id x y θ` and `EDGE_SE2 from to x y θ I₁₁ I₁₂ I₁₃ I₂₂ I₂₃ I₃₃` of a file in the
    /// format of the program g2o, in metres and radians. Comments (`#`) and `FIX` are skipped. Poses are numbered in
    /// the order of their lines, independent of their ids.
    ///
    /// # Errors
    /// If the file cannot be read, or a line has another content.
    pub fn read_g2o(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        let mut lines = Lines::open(path.as_ref())?;
        let (mut graph, mut numbers) = (Self::default(), BTreeMap::new());
        while lines.next()?.is_some() {
            graph.read_line(lines.current(), &mut numbers).map_err(|message| lines.error(message))?;
        }
        Ok(graph)
    }

    fn read_line(&mut self, line: &str, numbers: &mut BTreeMap<u64, usize>) -> Result<(), String> {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("VERTEX_SE2") => {
                let id = id(&mut words)?;
                let [x, y, theta] = values(&mut words)?;
                if numbers.insert(id, self.add_pose(pose(x, y, theta))).is_some() {
                    return Err(format!("there is a vertex {id} already"));
                }
            }
            Some("EDGE_SE2") => {
                let mut end = || {
                    let id = id(&mut words)?;
                    numbers.get(&id).copied().ok_or_else(|| format!("there is no vertex {id} before this line"))
                };
                let (from, to) = (end()?, end()?);
                let [x, y, theta, xx, xy, xt, yy, yt, tt] = values(&mut words)?;
                let information = Matrix3::new(xx, xy, xt, xy, yy, yt, xt, yt, tt);
                let edge = Edge { from, to, measured: pose(x, y, theta), information };
                self.add_edge(edge).map_err(|e| e.to_string())?;
            }
            Some(word) if word.starts_with('#') || word == "FIX" => {}
            word => {
                let word = word.unwrap_or_default();
                return Err(format!("a line begins with `VERTEX_SE2` or `EDGE_SE2`, not with `{word}`"));
            }
        }
        Ok(())
    }
}

fn id(words: &mut SplitWhitespace<'_>) -> Result<u64, String> {
    let word = words.next().ok_or("the id of a vertex is missing")?;
    word.parse().map_err(|_| format!("`{word}` is not the id of a vertex"))
}

/// The numbers up to the end of the line, of which there must be exactly `N`.
fn values<const N: usize>(words: &mut SplitWhitespace<'_>) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| format!("{N} numbers are expected, there are {i}"))?;
        let number: Option<f64> = word.parse().ok().filter(|v: &f64| v.is_finite());
        *value = number.ok_or_else(|| format!("`{word}` is not a finite number"))?;
    }
    match words.next() {
        Some(word) => Err(format!("{N} numbers are expected, `{word}` is one more")),
        None => Ok(values),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VERTICES: &str = "# two poses\nVERTEX_SE2 7 0 0 0\nVERTEX_SE2 3 1 2 0.5\nFIX 7\n";

    fn read(name: &str, text: &str) -> Result<PoseGraph, String> {
        let path = std::env::temp_dir().join(format!("apex-g2o-{}-{name}.g2o", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        let graph = PoseGraph::read_g2o(&path).map_err(|e| format!("{}: {}", e.line.unwrap_or(0), e.message));
        std::fs::remove_file(path).expect("the file");
        graph
    }

    #[test]
    fn ids_need_no_order() {
        let graph = read("good", &format!("{VERTICES}EDGE_SE2 7 3 1 2 0.4 1 2 3 4 5 6\n")).expect("a graph");
        let edge = &graph.edges()[0];
        assert_eq!((edge.from, edge.to, graph.poses().len()), (0, 1, 2));
        assert_eq!(edge.information, Matrix3::new(1.0, 2.0, 3.0, 2.0, 4.0, 5.0, 3.0, 5.0, 6.0));
        assert!((graph.cost() - 0.06).abs() < 1e-9, "{}", graph.cost());
    }

    #[test]
    fn errors_say_the_line_and_what_is_wrong() {
        for (number, (line, message)) in [
            ("EDGE_SE2 7 4 1 2 3 1 0 0 1 0 1", "there is no vertex 4 before this line"),
            ("EDGE_SE2 7 3 1 2 3 1 0 0 1 0", "9 numbers are expected, there are 8"),
            ("VERTEX_SE2 8 1 2 3 4", "3 numbers are expected, `4` is one more"),
            ("VERTEX_SE2 8 1 inf 3", "`inf` is not a finite number"),
            ("VERTEX_SE2 3 1 2 3", "there is a vertex 3 already"),
            ("VERTEX_SE2 -1 1 2 3", "`-1` is not the id of a vertex"),
            ("VERTEX_SE2", "the id of a vertex is missing"),
            ("VERTEX_XY 1 2", "a line begins with `VERTEX_SE2` or `EDGE_SE2`, not with `VERTEX_XY`"),
        ]
        .into_iter()
        .enumerate()
        {
            let text = format!("{VERTICES}{line}\n");
            assert_eq!(read(&format!("bad{number}"), &text), Err(format!("5: {message}")));
        }
    }
}
