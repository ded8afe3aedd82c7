use super::{ScanFigure, WriteError};
use crate::scan::{Container, Pose2, Scan, Segments};
use apex_rt::node;
use std::path::Path;

/// Writes drawings of scans with their segments and detected containers as `0001.svg`, `0002.svg`, … into a directory
/// (see [`ScanFigure`]). `truth` is the true pose of the container, if known.
///
/// Fails if a file cannot be written.
#[node]
#[derive(Debug)]
pub struct ScanPicture {
    /// Directory of the drawings. Created if it does not exist.
    #[param]
    directory: &'static str,
    /// Title of the drawings.
    #[param(default = "Container detection")]
    title: &'static str,
    /// Number of scans per drawing.
    #[param(default = 1, range = 1..=1_000_000)]
    every: u32,
    /// Maximum number of drawings.
    #[param(default = 100, range = 0..=1_000_000)]
    limit: u32,
    /// Maximum distance of the drawn points.
    #[param(unit = "m", default = 6.0, range = 0.1..=1000.0)]
    reach: f32,
    /// Wheels of the model: rows of `[x, y, length, width]` in metres, in the frame of the container.
    #[param(unit = "m")]
    boxes: &'static [[f32; 4]],
    seen: u32,
    written: u32,
}

#[node]
impl ScanPicture {
    fn process(
        &mut self,
        scan: &Scan,
        segments: &Segments,
        container: Option<&Container>,
        truth: Option<&Pose2>,
    ) -> Result<(), WriteError> {
        let due = self.seen.is_multiple_of(self.every.max(1));
        self.seen = self.seen.wrapping_add(1);
        if !due || self.written >= self.limit || apex_rt::is_shadow() {
            return Ok(());
        }
        let directory = Path::new(self.directory);
        std::fs::create_dir_all(directory).map_err(|e| WriteError::new(directory, e))?;
        let figure =
            ScanFigure { title: self.title, scan, segments, container, boxes: self.boxes, truth, reach: self.reach };
        figure.write(&directory.join(format!("{:04}.svg", self.written + 1)))?;
        self.written += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    fn directory(name: &str) -> &'static str {
        let path = std::env::temp_dir().join(format!("apex-picture-{}-{name}", std::process::id()));
        path.to_str().expect("a readable path").to_owned().leak()
    }

    fn node(directory: &'static str, every: u32, limit: u32) -> ScanPicture {
        with_wheels(directory, every, limit, &[[0.5, 0.3, 0.1, 0.1]])
    }

    fn with_wheels(directory: &'static str, every: u32, limit: u32, boxes: &'static [[f32; 4]]) -> ScanPicture {
        ScanPicture::construct((directory, "A title", every, limit, 6.0, boxes))
    }

    #[test]
    fn a_container_that_looks_the_same_from_both_ends_has_no_front() {
        const FRONT: [f32; 4] = [0.5, 0.0, 0.1, 0.2];
        const BACK: [f32; 4] = [-0.5, 0.0, 0.1, 0.2];
        let pose = Pose2::new(2.0, 0.0, 0.3);
        let container = Container { pose, error: 0.0, inliers: 9, outliers: 0, wheels: 2, model: 0 };
        let wheels: [(&str, &'static [[f32; 4]]); 2] = [("both-ends", &[FRONT, BACK]), ("one-end", &[FRONT])];
        let is_said = wheels.map(|(name, boxes)| {
            let directory = directory(name);
            let mut node = with_wheels(directory, 1, 1, boxes);
            node.process(&Scan::default(), &Segments::new(), Some(&container), None).expect("a picture");
            let text = std::fs::read_to_string(format!("{directory}/0001.svg")).expect("the picture");
            text.contains("either end may be its front")
        });
        assert_eq!(is_said, [true, false]);
    }

    #[test]
    fn draws_one_of_so_many_up_to_the_limit() {
        let directory = directory("many");
        let mut node = node(directory, 2, 2);
        for _ in 0..9 {
            node.process(&Scan::default(), &Segments::new(), None, None).expect("a picture");
        }
        let mut names: Vec<_> =
            std::fs::read_dir(directory).expect("the directory").flatten().map(|e| e.file_name()).collect();
        names.sort();
        assert_eq!(names, ["0001.svg", "0002.svg"]);
    }

    #[test]
    fn the_picture_shows_what_was_found() {
        let directory = directory("one");
        let mut scan = Scan { angle_min: -0.1, angle_increment: 0.1, ..Scan::default() };
        scan.ranges.extend([2.0, 2.1, f32::NAN]);
        let pose = Pose2::new(2.0, 0.0, 0.3);
        let container = Container { pose, error: 0.0, inliers: 9, outliers: 0, wheels: 3, model: 0 };
        let result = node(directory, 1, 1).process(&scan, &Segments::new(), Some(&container), Some(&pose));
        result.expect("a picture");
        let text = std::fs::read_to_string(format!("{directory}/0001.svg")).expect("the picture");
        for part in ["A title", "x (forward) [m]", "found container", "true pose", "<circle", "<polyline"] {
            assert!(text.contains(part), "no `{part}` in the picture");
        }
    }

    #[test]
    fn an_impossible_place_is_an_error() {
        let file = directory("file");
        std::fs::write(file, "in the way").expect("a temporary file");
        let result = node(file, 1, 1).process(&Scan::default(), &Segments::new(), None, None);
        assert!(result.expect_err("not a directory").to_string().starts_with(file));
    }
}
