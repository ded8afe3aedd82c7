use super::{
    LogEntry, ReadError,
    carmen::{ScanLine, fill, parse},
    lines::{Ending, Lines},
};
use crate::scan::Scan;
use apex_rt::{Ctx, Event, Out, node};
use core::f32::consts::PI;
use std::path::Path;

/// Geometry of a scanner, which a table of ranges does not contain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogGeometry {
    /// Direction of beam 0, in rad. Not used for CARMEN logs.
    pub angle_min: f32,
    /// Angle between consecutive beams, in rad. Not used for CARMEN logs.
    pub angle_increment: f32,
    /// Minimum range that counts as measured, in m.
    pub range_min: f32,
    /// Maximum range that counts as measured, in m.
    pub range_max: f32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    /// Rows of number, source number, ranges.
    Table,
    /// Lines of several kinds, those with scans among them.
    Carmen(ScanLine),
}

impl Format {
    /// Determines the format from the ending of the file name, and from the lines of a CARMEN log.
    ///
    /// # Errors
    /// If the ending is unknown, or the file has no scan or cannot be opened.
    fn of(path: &Path) -> Result<Self, ReadError> {
        match Ending::of(path).name.as_str() {
            "csv" => match Lines::open(path)?.next() {
                Ok(None) => Err(ReadError::open(path, "the table is empty")),
                // The reader of the table reports the errors of the file.
                _ => Ok(Self::Table),
            },
            "log" | "clf" => ScanLine::of(path).map(Self::Carmen),
            _ => Err(ReadError::open(path, "a scan log ends in .csv, .log or .clf (and .gz)")),
        }
    }
}

/// Reads laser scans from a table of ranges (`.csv`: number, source number, ranges in m) or from a CARMEN log (`.log`,
/// `.clf`), optionally compressed (`.gz`).
///
/// From a CARMEN log, it takes the lines `FLASER` or `ROBOTLASER1`, whichever comes first, and without them
/// `RAWLASER1`. Other lines are skipped. `ROBOTLASER1` and `RAWLASER1` have the directions of the beams; a range that
/// reaches the maximum range of the line is infinite: nothing is within range.
#[derive(Debug)]
pub struct ScanLogReader {
    lines: Lines,
    format: Format,
    geometry: LogGeometry,
    next_id: u64,
}

impl ScanLogReader {
    /// Opens a log.
    ///
    /// # Errors
    /// If the ending of its name is unknown, or the file has no scan or cannot be opened.
    pub fn open(path: impl AsRef<Path>, geometry: LogGeometry) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let format = Format::of(path)?;
        Ok(Self { lines: Lines::open(path)?, format, geometry, next_id: 0 })
    }

    /// Reads the next scan into `scan`, which keeps its stamp unless the log contains one. Returns `None` at the end.
    ///
    /// # Errors
    /// If a line is not a scan, or the file cannot be read further. The next call continues after the error.
    pub fn read(&mut self, scan: &mut Scan) -> Result<Option<LogEntry>, ReadError> {
        while let Some(line) = self.lines.next()? {
            if matches!(self.format, Format::Carmen(kind) if !kind.is(line)) {
                continue;
            }
            scan.range_min = self.geometry.range_min;
            scan.range_max = self.geometry.range_max;
            let entry = match self.format {
                Format::Table => self.table_row(scan),
                Format::Carmen(kind) => kind.read(line, scan).map(|entry| LogEntry { id: self.next_id, ..entry }),
            };
            let entry = entry.map_err(|message| self.lines.error(message))?;
            self.next_id += 1;
            scan.stamp = entry.time.unwrap_or(scan.stamp);
            return Ok(Some(entry));
        }
        Ok(None)
    }

    fn table_row(&self, scan: &mut Scan) -> Result<LogEntry, String> {
        let mut cells = self.lines.current().split(',');
        let id = parse(cells.next(), "number")?;
        let _source: u64 = parse(cells.next(), "source number")?;
        scan.angle_min = self.geometry.angle_min;
        scan.angle_increment = self.geometry.angle_increment;
        fill(scan, cells)?;
        Ok(LogEntry { id, ..LogEntry::default() })
    }
}

/// Sends the scans of a log, one per firing (for the formats see [`ScanLogReader`]). After the last scan it triggers
/// `done` and sends ⊥.
///
/// Fails on a line that is not a scan, and continues with the next line. Scans of a table are stamped with the time of
/// the firing.
#[node]
#[derive(Debug)]
pub struct ScanLog {
    /// Path of the file. Its extension determines the format.
    #[param]
    path: String,
    /// Direction of beam 0. CARMEN logs have their own.
    #[param(unit = "rad", default = -0.5 * PI, range = -6.4..=6.4)]
    angle_min: f32,
    /// Angle between consecutive beams. CARMEN logs have their own.
    #[param(unit = "rad", default = PI / 360.0, range = -0.5..=0.5)]
    angle_increment: f32,
    /// Minimum range that counts as measured.
    #[param(unit = "m", default = 0.02, range = 0.0..=100.0)]
    range_min: f32,
    /// Maximum range that counts as measured.
    #[param(unit = "m", default = 80.0, range = 0.0..=1000.0)]
    range_max: f32,
    reader: Option<ScanLogReader>,
    finished: bool,
}

#[node]
impl ScanLog {
    /// Creates a node with an open log, so that errors are found before the program runs.
    ///
    /// # Errors
    /// The errors of [`ScanLogReader::open`].
    pub fn open(path: impl AsRef<Path>, geometry: LogGeometry) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let reader = Some(ScanLogReader::open(path, geometry)?);
        let path = path.to_string_lossy().into_owned();
        let LogGeometry { angle_min, angle_increment, range_min, range_max } = geometry;
        Ok(Self { path, angle_min, angle_increment, range_min, range_max, reader, finished: false })
    }

    fn process(
        &mut self,
        ctx: &Ctx,
        scan: &mut Out<Scan>,
        entry: &mut Out<LogEntry>,
        done: Event<()>,
    ) -> Result<(), ReadError> {
        if self.finished {
            return Ok(());
        }
        if self.reader.is_none() {
            // If opening fails, the node stays finished; a successful `open` returns a node with `finished: false`.
            self.finished = true;
            *self = Self::open(&self.path, self.geometry())?;
        }
        let Some(reader) = &mut self.reader else { return Ok(()) };
        let token = scan.get_mut();
        token.stamp = ctx.now();
        match reader.read(token) {
            Ok(Some(read)) => entry.set(read),
            Ok(None) => {
                scan.clear();
                self.finished = true;
                done.emit(());
            }
            Err(error) => {
                scan.clear();
                return Err(error);
            }
        }
        Ok(())
    }

    /// Returns `true` if all scans have been sent, or if the log could not be opened.
    pub fn finished(&self) -> bool {
        self.finished
    }

    fn geometry(&self) -> LogGeometry {
        LogGeometry {
            angle_min: self.angle_min,
            angle_increment: self.angle_increment,
            range_min: self.range_min,
            range_max: self.range_max,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::Pose2;
    use apex_rt::Time;
    use std::io::Write;

    const GEOMETRY: LogGeometry =
        LogGeometry { angle_min: -1.0, angle_increment: 0.5, range_min: 0.1, range_max: 10.0 };

    fn path(name: &str) -> &'static str {
        let path = std::env::temp_dir().join(format!("apex-log-{}-{name}", std::process::id()));
        path.to_str().expect("a readable path").to_owned().leak()
    }

    fn file(name: &str, text: &[u8]) -> &'static str {
        let path = path(name);
        std::fs::write(path, text).expect("a temporary file");
        path
    }

    #[test]
    fn packed_tables_are_read_like_plain_ones() {
        let text = b"7,1,1.5,0.0,2.5\n8,3,1.0,nan,inf\n";
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packer.write_all(text).expect("memory");
        let packed = file("packed.csv.gz", &packer.finish().expect("memory"));
        for path in [file("plain.csv", text), packed] {
            let mut reader = ScanLogReader::open(path, GEOMETRY).expect("the file");
            let mut scan = Scan::default();
            assert_eq!(reader.read(&mut scan).expect("row 1").map(|e| e.id), Some(7));
            assert_eq!((scan.range(0), scan.range(1), scan.range(2)), (Some(1.5), None, Some(2.5)));
            assert_eq!((scan.angle_min, scan.angle(2)), (-1.0, 0.0));
            assert_eq!(reader.read(&mut scan).expect("row 2").map(|e| e.id), Some(8));
            assert_eq!(scan.points().count(), 1);
            assert_eq!(reader.read(&mut scan), Ok(None));
        }
    }

    #[test]
    fn flaser_lines_have_pose_and_time() {
        let text = "# a comment\nPARAM laser yes\nODOM 0 0 0 0 0 0 1.0 host 1.0\n\
                    FLASER 3 1.0 2.0 81.9 0.5 -0.5 0.25 9 9 9 12.5 host 12.6\nFLASER 2 1.0 2.0 1 1 1 9 9 9 13.0 host 13.1\n";
        let mut reader = ScanLogReader::open(file("carmen.log", text.as_bytes()), GEOMETRY).expect("the file");
        let mut scan = Scan::default();
        let entry = reader.read(&mut scan).expect("a scan").expect("a scan");
        assert_eq!(entry.pose, Some(Pose2::new(0.5, -0.5, 0.25)));
        assert_eq!(entry.odometry, Some(Pose2::new(9.0, 9.0, 9.0)));
        assert_eq!((entry.id, scan.stamp), (0, Time::from_millis(12_500)));
        assert!((scan.angle(0) + 0.5 * PI).abs() < 1e-6 && (scan.angle(2) - 0.5 * PI).abs() < 1e-6);
        assert_eq!((scan.range(1), scan.range(2)), (Some(2.0), None));
        assert_eq!(reader.read(&mut scan).expect("a scan").map(|e| e.id), Some(1));
        assert_eq!(reader.read(&mut scan), Ok(None));
    }

    /// A log with a scan of five beams in each of its lines.
    fn current(kinds: &[&str]) -> String {
        let mut text = "# CARMEN Logfile\nPARAM laser_type LMS200 0 0 0\nODOM 0 0 0 0 0 0 1.0 host 1.0\n".to_owned();
        for (i, kind) in kinds.iter().enumerate() {
            let poses = if *kind == "ROBOTLASER1" { " 1 2 0.5 3 4 0.25 0.1 0 0.3 0.3 1e6" } else { "" };
            text += &format!("{kind} 0 -1 2 0.5 81.91 0.01 0 5 1.5 2 81.91 99 nan 2 7 8{poses} {i}.5 host 1.1\n");
        }
        text
    }

    fn scans(name: &str, text: &str) -> Vec<(LogEntry, Scan)> {
        let mut reader = ScanLogReader::open(file(name, text.as_bytes()), GEOMETRY).expect("the file");
        let mut scan = Scan::default();
        let mut scans = Vec::new();
        while let Some(entry) = reader.read(&mut scan).expect("a scan") {
            scans.push((entry, scan.clone()));
        }
        scans
    }

    #[test]
    fn lines_of_the_current_format_have_their_geometry() {
        let both = scans("robot.log", &current(&["ROBOTLASER1", "ROBOTLASER1"]));
        let (entry, scan) = &both[1];
        assert_eq!((both.len(), entry.id, entry.time), (2, 1, Some(Time::from_millis(1500))));
        assert_eq!(entry.pose, Some(Pose2::new(1.0, 2.0, 0.5)));
        assert_eq!(entry.odometry, Some(Pose2::new(3.0, 4.0, 0.25)));
        assert_eq!((scan.angle_min, scan.angle(4), scan.range_max), (-1.0, 1.0, 10.0));
        assert_eq!((scan.range(0), scan.range(1), scan.ranges.len()), (Some(1.5), Some(2.0), 5));
        assert_eq!((scan.sight(2), scan.sight(3)), (f32::INFINITY, f32::INFINITY));
        assert!(scan.sight(4).is_nan());
        let raw = scans("raw.log", &current(&["RAWLASER1", "RAWLASER1", "RAWLASER1"]));
        assert_eq!((raw.len(), raw[2].0.time, raw[2].0.pose), (3, Some(Time::from_millis(2500)), None));
        assert_eq!(raw[2].1.angle(4), 1.0);
    }

    #[test]
    fn a_scan_that_is_twice_in_a_log_is_read_once() {
        let twice = scans("twice.log", &current(&["RAWLASER1", "ROBOTLASER1", "RAWLASER1", "ROBOTLASER1"]));
        assert_eq!(twice.len(), 2);
        assert!(twice.iter().all(|(entry, _)| entry.pose.is_some()));
    }

    #[test]
    fn a_log_without_a_scan_is_an_error_that_names_its_lines() {
        let many: String = (0..1000).map(|i| format!("WORD{i} 1\n")).collect();
        let garbage = "x".repeat(1000);
        for (name, text, message) in [
            ("empty.log", "", "the log is empty"),
            ("comment.log", "# CARMEN Logfile\n", "the log is empty"),
            ("empty.csv", "\n\n", "the table is empty"),
            ("odometry.log", "PARAM a\nODOM 1\nODOM 2\n", "it has 2 `ODOM`, 1 `PARAM`"),
            ("many.log", &many, "1 `WORD9`"),
            ("garbage.log", &garbage, "xxx…`"),
        ] {
            let error = ScanLog::open(file(name, text.as_bytes()), GEOMETRY).expect_err(name).message;
            assert!(error.ends_with(message) && error.len() < 400, "{name}: {error}");
        }
    }

    #[test]
    fn a_letter_of_another_encoding_does_not_end_a_log() {
        let text = "FLASER 1 1 1 1 1 1 1 1 1 h 1\nPARAM Ger\u{e4}t\nFLASER 1 1 1 1 1 1 1 1 2 h 1\n";
        let latin: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
        let mut reader = ScanLogReader::open(file("latin.log", &latin), GEOMETRY).expect("the file");
        let mut scan = Scan::default();
        let ids = [(); 3].map(|()| reader.read(&mut scan).expect("no error").map(|entry| entry.id));
        assert_eq!(ids, [Some(0), Some(1), None]);
    }

    #[test]
    fn wrong_lines_are_errors_with_their_place() {
        let many = format!("1,1{}", ",1.0".repeat(crate::scan::MAX_BEAMS + 1));
        let cases = [
            ("a.csv", "x,1,1.0", "number: `x` is no valid number"),
            ("b.csv", "1", "source number is missing"),
            ("c.csv", "1,1,1.0,?", "beam 1: `?` is no range"),
            ("d.csv", many.as_str(), "more than 65535 beams"),
            ("e.log", "FLASER", "number of beams is missing"),
            ("f.log", "FLASER -1", "number of beams: `-1` is no valid number"),
            ("g.log", "FLASER 5 1 2", "5 beams announced, 2 found"),
            ("h.log", "FLASER 18446744073709551615 1 2", "18446744073709551615 beams announced, 2 found"),
            ("i.log", "FLASER 1 1.0 2 3", "theta is missing"),
            ("j.log", "FLASER 1 1.0 2 3 4 5 6 7", "time is missing"),
            ("k.log", "FLASER 1 1.0 2 3 4 5 6", "theta is missing"),
            ("l.log", "ROBOTLASER1 0 0 3.14 0.1 81.9 0.01 0 9 1.0", "9 beams announced, 1 found"),
            ("m.log", "RAWLASER1 0 0 3.14 0.1 81.9 0.01 0 1 1.0 4294967295 1", "a remission is missing"),
            ("n.log", "ROBOTLASER1 0 0 3 0.1 81.9 0.01 0 1 1.0 0 1 2 3 4 5 6 7 8 9 1 1", "time is missing"),
            ("o.log", "RAWLASER1 0 x", "start angle: `x` is no valid number"),
        ];
        for (name, line, message) in cases {
            let path = file(name, format!("\n{line}\n").as_bytes());
            let mut reader = ScanLogReader::open(path, GEOMETRY).expect("the file");
            let error = reader.read(&mut Scan::default()).expect_err(name);
            assert_eq!((error.line, error.message.as_str()), (Some(2), message));
            assert_eq!(error.to_string(), format!("{path}:2: {message}"));
            assert_eq!(reader.read(&mut Scan::default()), Ok(None));
        }
    }

    #[test]
    fn broken_files_end_with_an_error() {
        let mut scan = Scan::default();
        for path in [file("noise.csv.gz", b"not packed at all"), file("binary.csv", &[0xff; 100])] {
            let mut reader = ScanLogReader::open(path, GEOMETRY).expect("the file");
            assert!(reader.read(&mut scan).is_err());
            assert_eq!(reader.read(&mut scan), Ok(None));
        }
        let mut endless = ScanLogReader::open(file("long.csv", &vec![b'1'; 3 << 20]), GEOMETRY).expect("the file");
        assert!(endless.read(&mut scan).expect_err("no line end").message.contains("longer than"));
        assert_eq!(endless.read(&mut scan), Ok(None));
    }

    #[test]
    fn the_ending_tells_the_format() {
        let error = ScanLogReader::open("scans.txt", GEOMETRY).expect_err("unknown");
        assert_eq!(error.to_string(), "scans.txt: a scan log ends in .csv, .log or .clf (and .gz)");
        assert!(ScanLogReader::open(file("EXCEL.CSV", b"1,1,1.0\n"), GEOMETRY).is_ok());
        assert!(ScanLogReader::open(file("OLD.LOG", b"FLASER\n"), GEOMETRY).is_ok());
        assert!(ScanLog::open("/nowhere/at-all.csv", GEOMETRY).is_err());
    }

    #[test]
    fn the_node_skips_bad_lines_and_ends_in_bottom() {
        let mut node = ScanLog::open(file("node.csv", b"1,1,1.0\nbad\n3,1,2.0\n"), GEOMETRY).expect("the file");
        let (mut scan, mut entry) = (Out::new(), Out::new());
        let mut sent = Vec::new();
        while !node.finished() {
            scan.clear();
            entry.clear();
            let mut done = None;
            let ctx = Ctx::new(Time::from_secs(5));
            let result = node.process(&ctx, &mut scan, &mut entry, apex_rt::event(&mut done));
            sent.push((result.is_ok(), entry.get().map(|e: &LogEntry| e.id), done.is_some()));
            assert_eq!(scan.get().is_some(), entry.get().is_some());
        }
        assert_eq!(sent, [(true, Some(1), false), (false, None, false), (true, Some(3), false), (true, None, true)]);
        let mut done = None;
        assert_eq!(node.process(&Ctx::new(Time::ZERO), &mut scan, &mut entry, apex_rt::event(&mut done)), Ok(()));
        assert!(done.is_none(), "the end comes once");
    }

    #[test]
    fn a_node_made_by_a_graph_opens_its_log_itself() {
        use apex_rt::Construct;
        let (mut scan, mut entry) = (Out::new(), Out::new());
        let ctx = Ctx::new(Time::from_secs(5));
        let mut node = ScanLog::construct((file("graph.csv", b"1,1,1.0\n").to_owned(), 0.0, 0.1, 0.1, 10.0));
        node.process(&ctx, &mut scan, &mut entry, Event::unconnected()).expect("a scan");
        assert_eq!(scan.get().expect("a scan").stamp, Time::from_secs(5));
        let mut missing = ScanLog::construct((path("missing.csv").to_owned(), 0.0, 0.1, 0.1, 10.0));
        assert!(missing.process(&ctx, &mut scan, &mut entry, Event::unconnected()).is_err());
        assert!(missing.finished());
    }
}
