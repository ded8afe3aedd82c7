use apex_nodes::{
    io::{CsvReader, LogEntry, LogGeometry, ReadError},
    scan::Container,
};
use apex_rt::node;
use std::{
    collections::BTreeMap,
    fmt,
    fs::{self, File},
    io::{self, BufWriter, Write as _},
    path::{Path, PathBuf},
};

/// Geometry of the scanner of the recorded tables, which they do not contain: 761 beams over 190°, beam 0 at the
/// right.
pub const RECORDED_SCANNER: LogGeometry = LogGeometry {
    angle_min: (-95.0_f32).to_radians(),
    angle_increment: (190.0_f32 / 761.0).to_radians(),
    range_min: 0.05,
    range_max: 20.0,
};

/// Writes the detections in recorded scans into a table, and compares them with labels if available.
#[node]
#[derive(Debug, Default)]
pub struct Report {
    /// Boxes that contain the centre, by number of the scan: smallest x and y, largest x and y, in m.
    labels: BTreeMap<u64, [f64; 4]>,
    table: Option<BufWriter<File>>,
    path: PathBuf,
    scans: u64,
    labelled: u64,
    found: u64,
    elsewhere: u64,
}

#[node]
impl Report {
    fn process(&mut self, entry: &LogEntry, container: Option<&Container>) -> Result<(), io::Error> {
        self.scans += 1;
        let label = self.labels.get(&entry.id);
        self.labelled += u64::from(label.is_some());
        let Some(Container { pose, error, inliers, outliers, .. }) = container else { return Ok(()) };
        let (x, y) = (f64::from(pose.x), f64::from(pose.y));
        let inside = label.is_some_and(|b| (b[0]..=b[2]).contains(&x) && (b[1]..=b[3]).contains(&y));
        self.found += u64::from(inside);
        self.elsewhere += u64::from(!inside);
        match &mut self.table {
            Some(table) => {
                writeln!(table, "{},{x:.4},{y:.4},{:.4},{error:.6},{inliers},{outliers}", entry.id, pose.theta)
            }
            None => Ok(()),
        }
    }
}

impl Report {
    /// Creates a report in `path`, with the optional labels in `labels`: rows of number, smallest x and y, largest x
    /// and y in m, after a header line.
    ///
    /// # Errors
    /// If the table cannot be created or the labels cannot be read.
    pub fn new(path: &Path, labels: Option<&Path>) -> Result<Self, String> {
        let made = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| File::create(path));
        let mut table = BufWriter::new(made.map_err(|e| format!("cannot write {}: {e}", path.display()))?);
        writeln!(table, "id,x_m,y_m,theta_rad,error_m2,inliers,outliers").map_err(|e| e.to_string())?;
        let labels = labels.map(read_labels).transpose().map_err(|e| e.to_string())?.unwrap_or_default();
        Ok(Self { labels, table: Some(table), path: path.to_owned(), ..Self::default() })
    }

    /// Number of scans with a label, number of those with a detection inside the label, and number of detections
    /// elsewhere.
    pub fn counts(&self) -> (u64, u64, u64) {
        (self.labelled, self.found, self.elsewhere)
    }
}

pub(crate) fn read_labels(path: &Path) -> Result<BTreeMap<u64, [f64; 4]>, ReadError> {
    let mut reader = CsvReader::open(path, true)?;
    let (mut labels, mut row) = (BTreeMap::new(), Vec::new());
    while reader.read(&mut row)? {
        if let [id, x_min, y_min, x_max, y_max, ..] = row[..] {
            labels.insert(id as u64, [x_min, y_min, x_max, y_max]);
        }
    }
    Ok(labels)
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} scans, {} detections ({})", self.scans, self.found + self.elsewhere, self.path.display())?;
        if self.labels.is_empty() {
            return Ok(());
        }
        write!(
            f,
            "\n{} of {} labelled containers found inside their box, {} found elsewhere",
            self.found, self.labelled, self.elsewhere
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::scan::Pose2;

    #[test]
    fn counts_what_lies_in_its_box_and_what_does_not() {
        let mut report = Report { labels: BTreeMap::from([(1, [0.0, 0.0, 2.0, 2.0])]), ..Report::default() };
        let container =
            |x| Container { pose: Pose2::new(x, 1.0, 0.0), error: 0.0, inliers: 5, outliers: 0, wheels: 3, model: 0 };
        for (id, found) in [(1, Some(container(1.0))), (1, Some(container(3.0))), (1, None), (2, Some(container(1.0)))]
        {
            let entry = LogEntry { id, ..LogEntry::default() };
            report.process(&entry, found.as_ref()).expect("no table to write");
        }
        assert_eq!(report.counts(), (3, 1, 2));
    }
}
