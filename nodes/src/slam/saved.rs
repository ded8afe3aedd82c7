use super::{Edge, Mapper, Settings, heading, read::read, scan_graph::ScanGraph};
use crate::io::{ReadError, replace};
use std::{
    io::{self, Write},
    path::Path,
};

impl Mapper {
    /// Writes the map to a file: the graph in the format of g2o (see [`PoseGraph::read`](super::PoseGraph::read)), and
    /// after it the points of each scan in the frame of the robot, in m: `SCAN id x y x y …`. Scans that a lost robot
    /// has kept are not part of the map.
    ///
    /// # Errors
    /// If the file cannot be written. An old one is left as it was.
    pub fn write(&self, path: impl AsRef<Path>) -> io::Result<()> {
        let mapped = self.mapped();
        let mut text = Vec::new();
        for (k, pose) in self.graph().poses().iter().enumerate().take(mapped) {
            writeln!(text, "VERTEX_SE2 {k} {} {} {}", pose.translation.x, pose.translation.y, heading(pose))?;
        }
        for Edge { from, to, measured, information: i, .. } in self.graph().edges() {
            if (*from).max(*to) < mapped {
                let (x, y, theta) = (measured.translation.x, measured.translation.y, heading(measured));
                write!(text, "EDGE_SE2 {from} {to} {x} {y} {theta} ")?;
                writeln!(text, "{} {} {} {} {} {}", i.m11, i.m12, i.m13, i.m22, i.m23, i.m33)?;
            }
        }
        for (k, points) in self.scans().iter().enumerate().take(mapped) {
            write!(text, "SCAN {k}")?;
            points.iter().try_for_each(|p| write!(text, " {} {}", p.x, p.y))?;
            writeln!(text)?;
        }
        replace(path.as_ref(), &text)
    }

    /// Reads a map that was [written](Self::write). The robot is lost: nothing says where on the map it is.
    ///
    /// # Errors
    /// If the file cannot be read, has no pose, or has a pose without a scan.
    pub fn read(path: impl AsRef<Path>, settings: Settings) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let (graph, mut scans) = read(path)?;
        let mut map = ScanGraph::new(settings);
        for (k, pose) in graph.poses().iter().enumerate() {
            let points = scans.remove(&k).ok_or_else(|| {
                ReadError::open(path, format!("the scan of vertex {k} is missing: a map has one for each vertex"))
            })?;
            map.push(*pose, points);
        }
        if map.scans.is_empty() {
            return Err(ReadError::open(path, "a map has at least one vertex and its scan"));
        }
        map.connect_all(&graph);
        Ok(Self::resume(map))
    }
}
