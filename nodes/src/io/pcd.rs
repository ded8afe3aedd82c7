use super::ReadError;
use crate::cloud::{CloudPoint, MAX_POINTS, PointCloud};
use apex_rt::Time;
use std::{fs, path::Path, str::FromStr};

/// Structured cloud of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedCloud {
    /// Points, in the frame of the file.
    pub cloud: PointCloud,
    /// Content of the field `label` for each point, if the file has one.
    pub labels: Option<Vec<u32>>,
}

/// Reads an organised point cloud from a file of the Point Cloud Library (PCD 0.7, `DATA ascii` or `DATA binary`).
///
/// The fields `x`, `y` and `z` are needed, `intensity` and `label` are read, others are skipped. Without `intensity`
/// all intensities are 0.
///
/// # Errors
/// If the file cannot be read, has no points or is not organised (a height of 1), is compressed or cut off, or if a
/// field that is read is missing or is not a number.
pub fn read_cloud(path: impl AsRef<Path>) -> Result<RecordedCloud, ReadError> {
    let path = path.as_ref();
    let bytes = fs::read(path).map_err(|e| ReadError::open(path, e))?;
    let error = |(line, message): (Option<usize>, String)| ReadError { path: path.into(), line, message };
    let (header, data) = Header::parse(&bytes).map_err(error)?;
    header.cloud(data).map_err(error)
}

/// Line, if there is one, and message of an error.
type Wrong = (Option<usize>, String);

/// Header of a file.
#[derive(Debug, Default)]
struct Header {
    fields: Vec<Field>,
    width: usize,
    height: usize,
    points: Option<usize>,
    is_binary: bool,
    lines: usize,
}

/// Field of a point.
#[derive(Debug, Clone, Default)]
struct Field {
    name: String,
    size: usize,
    kind: char,
    count: usize,
}

/// Place of a field: the number of its value in a line of text, and its first byte in a binary point.
struct Place<'a> {
    field: &'a Field,
    value: usize,
    byte: usize,
}

impl Header {
    /// Reads the header. Returns it with the bytes after it.
    fn parse(bytes: &[u8]) -> Result<(Self, &[u8]), Wrong> {
        let (mut header, mut rest) = (Self::default(), bytes);
        loop {
            let Some(end) = rest.iter().position(|byte| *byte == b'\n') else {
                return Err((None, "the header of a PCD file has no line `DATA`".to_owned()));
            };
            let (line, after) = (&rest[..end], &rest[end + 1..]);
            (rest, header.lines) = (after, header.lines + 1);
            let is_last = str::from_utf8(line)
                .map_err(|_| "not a PCD file: its header is not text".to_owned())
                .and_then(|line| header.take(line.trim()))
                .map_err(|message| (Some(header.lines), message))?;
            if is_last {
                header.check().map_err(|message| (None, message))?;
                return Ok((header, rest));
            }
        }
    }

    /// Takes a line of the header. Returns `true` if it is the last one.
    fn take(&mut self, line: &str) -> Result<bool, String> {
        let mut words = line.split_whitespace();
        let name = words.next().unwrap_or("#");
        let words: Vec<&str> = words.collect();
        match name {
            "FIELDS" => {
                let field = |name: &&str| Field { name: (*name).to_owned(), size: 4, kind: 'F', count: 1 };
                self.fields = words.iter().map(field).collect();
            }
            "SIZE" => self.each(&words, |field, word| number(word).map(|size| field.size = size))?,
            "COUNT" => self.each(&words, |field, word| number(word).map(|count| field.count = count))?,
            "TYPE" => self.each(&words, |field, word| {
                field.kind = word.chars().next().unwrap_or_default();
                Ok(())
            })?,
            "WIDTH" => self.width = number(words.first().unwrap_or(&""))?,
            "HEIGHT" => self.height = number(words.first().unwrap_or(&""))?,
            "POINTS" => self.points = Some(number(words.first().unwrap_or(&""))?),
            "DATA" => {
                self.is_binary = match words.first() {
                    Some(&"ascii") => false,
                    Some(&"binary") => true,
                    other => {
                        let format = other.unwrap_or(&"");
                        return Err(format!("data format `{format}` is not supported; save it as `ascii` or `binary`"));
                    }
                };
                return Ok(true);
            }
            // Comments, VERSION, VIEWPOINT.
            _ => {}
        }
        Ok(false)
    }

    fn each(&mut self, words: &[&str], set: impl Fn(&mut Field, &str) -> Result<(), String>) -> Result<(), String> {
        if words.len() != self.fields.len() {
            return Err(format!("{} values for {} fields", words.len(), self.fields.len()));
        }
        self.fields.iter_mut().zip(words).try_for_each(|(field, word)| set(field, word))
    }

    fn check(&self) -> Result<(), String> {
        let count = self.width.checked_mul(self.height).filter(|count| *count <= MAX_POINTS);
        let Some(count) = count else {
            return Err(format!("{} x {} points are more than {MAX_POINTS}", self.width, self.height));
        };
        if count == 0 {
            return Err("the cloud has no points".to_owned());
        }
        if self.height == 1 {
            return Err(
                "the cloud is not organised: its height is 1, but the rows of a depth image are needed".to_owned()
            );
        }
        if let Some(points) = self.points.filter(|points| *points != count) {
            return Err(format!("{points} points are announced for {} x {} pixels", self.width, self.height));
        }
        let fields = self.fields.iter();
        if fields.clone().any(|field| field.size > 8 || field.count > 4096) {
            return Err("a field is larger than any number".to_owned());
        }
        Ok(())
    }

    fn cloud(&self, data: &[u8]) -> Result<RecordedCloud, Wrong> {
        let place = |name: &str| self.place(name);
        let needed = |name: &str| place(name).ok_or((None, format!("the cloud has no field `{name}`")));
        let coordinates = [needed("x")?, needed("y")?, needed("z")?];
        let (intensity, label) = (place("intensity"), place("label"));
        let mut cloud = PointCloud::default();
        cloud.reset(Time::ZERO, (self.width, self.height));
        let mut labels = label.as_ref().map(|_| Vec::with_capacity(cloud.points().len()));
        let mut records = Records { header: self, data, taken: 0, line: self.lines };
        for point in cloud.points_mut() {
            let record = records.next()?;
            let value = |place: &Place<'_>| record.number(place).map_err(|message| (record.line(), message));
            let [x, y, z] =
                [value(&coordinates[0])?, value(&coordinates[1])?, value(&coordinates[2])?].map(|c| c as f32);
            let light = intensity.as_ref().map_or(Ok(0.0), value)? as f32;
            let read = CloudPoint { x, y, z, intensity: light };
            if read.is_measured() {
                *point = read;
            }
            if let (Some(labels), Some(place)) = (&mut labels, &label) {
                labels.push(value(place)? as u32);
            }
        }
        Ok(RecordedCloud { cloud, labels })
    }

    fn place(&self, name: &str) -> Option<Place<'_>> {
        let at = self.fields.iter().position(|field| field.name == name && field.count > 0)?;
        let before = &self.fields[..at];
        let value = before.iter().map(|field| field.count).sum();
        let byte = before.iter().map(|field| field.count * field.size).sum();
        Some(Place { field: &self.fields[at], value, byte })
    }
}

/// Points of a file, one after the other.
struct Records<'a> {
    header: &'a Header,
    data: &'a [u8],
    taken: usize,
    line: usize,
}

/// Values of a point.
enum Record<'a> {
    Binary(&'a [u8]),
    Text(usize, Vec<&'a str>),
}

impl<'a> Records<'a> {
    fn next(&mut self) -> Result<Record<'a>, Wrong> {
        let taken = self.taken;
        let cut = || {
            let count = self.header.width * self.header.height;
            (None, format!("the file is cut off: it ends after {taken} of {count} points"))
        };
        self.taken += 1;
        if self.header.is_binary {
            let size = self.header.fields.iter().map(|field| field.count * field.size).sum();
            let (record, rest) = self.data.split_at_checked(size).ok_or_else(cut)?;
            self.data = rest;
            return Ok(Record::Binary(record));
        }
        loop {
            if self.data.is_empty() {
                return Err(cut());
            }
            let end = self.data.iter().position(|byte| *byte == b'\n').unwrap_or(self.data.len());
            let line = str::from_utf8(&self.data[..end]).unwrap_or("?").trim();
            self.data = self.data.get(end + 1..).unwrap_or_default();
            self.line += 1;
            if !line.is_empty() {
                return Ok(Record::Text(self.line, line.split_whitespace().collect()));
            }
        }
    }
}

impl Record<'_> {
    fn line(&self) -> Option<usize> {
        match self {
            Self::Binary(_) => None,
            Self::Text(line, _) => Some(*line),
        }
    }

    fn number(&self, place: &Place<'_>) -> Result<f64, String> {
        let name = &place.field.name;
        match self {
            Self::Text(_, words) => {
                let word = words.get(place.value).ok_or_else(|| format!("`{name}` is missing"))?;
                word.parse().map_err(|_| format!("{name}: `{word}` is not a number"))
            }
            Self::Binary(bytes) => {
                let bytes = bytes.get(place.byte..place.byte + place.field.size).unwrap_or_default();
                binary(place.field.kind, bytes).ok_or_else(|| {
                    format!("field `{name}`: no number of type {} has {} bytes", place.field.kind, bytes.len())
                })
            }
        }
    }
}

fn binary(kind: char, bytes: &[u8]) -> Option<f64> {
    Some(match (kind, bytes) {
        ('F', &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        ('F', &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        ('U', &[a]) => f64::from(a),
        ('U', &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
        ('U', &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
        ('I', &[a]) => f64::from(a as i8),
        ('I', &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
        ('I', &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
        _ => return None,
    })
}

fn number(word: &str) -> Result<usize, String> {
    usize::from_str(word).map_err(|_| format!("`{word}` is not a whole number"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    const HEADER: &str = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity label\nSIZE 4 4 4 4 4\nTYPE F F F F U\n\
                          COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\n";

    fn file(name: &str, content: &[u8]) -> PathBuf {
        let path = std::env::temp_dir().join(format!("apex-pcd-{}-{name}", std::process::id()));
        fs::write(&path, content).expect("a temporary file");
        path
    }

    fn text() -> Vec<u8> {
        format!("{HEADER}DATA ascii\n1 2 3 9 0\nnan nan nan 0 0\n\n1.5 2 -3 8 21\n1 inf 3 0 1").into_bytes()
    }

    fn packed() -> Vec<u8> {
        let mut bytes = format!("{HEADER}DATA binary\n").into_bytes();
        for (x, y, z, light, label) in [
            (1.0, 2.0, 3.0, 9.0, 0),
            (f32::NAN, f32::NAN, f32::NAN, 0.0, 0),
            (1.5, 2.0, -3.0, 8.0, 21),
            (1.0, f32::INFINITY, 3.0, 0.0, 1),
        ] {
            [x, y, z, light].into_iter().for_each(|number: f32| bytes.extend(number.to_le_bytes()));
            bytes.extend(u32::to_le_bytes(label));
        }
        bytes
    }

    #[test]
    fn text_and_binary_files_have_the_same_content() {
        for (name, content) in [("a.pcd", text()), ("b.pcd", packed())] {
            let read = read_cloud(file(name, &content)).expect("a cloud");
            assert_eq!((read.cloud.size(), read.labels), ((2, 2), Some(vec![0, 0, 21, 1])));
            let measured: Vec<bool> = read.cloud.points().iter().map(CloudPoint::is_measured).collect();
            assert_eq!(measured, [true, false, true, false]);
            assert_eq!(read.cloud.points()[2], CloudPoint { x: 1.5, y: 2.0, z: -3.0, intensity: 8.0 });
        }
    }

    #[test]
    fn files_that_are_cut_off_are_errors() {
        for (name, whole) in [("c.pcd", text()), ("d.pcd", packed())] {
            // The last value of the text is a label that still is one without its end.
            for len in 0..whole.len() - 4 {
                let error = read_cloud(file(name, &whole[..len])).expect_err("a part");
                assert!(!error.message.is_empty());
            }
        }
        let whole = packed();
        let error = read_cloud(file("e.pcd", &whole[..whole.len() - 1])).expect_err("a part");
        assert_eq!(error.message, "the file is cut off: it ends after 3 of 4 points");
    }

    #[test]
    fn wrong_headers_are_errors_with_their_place() {
        let cases = [
            ("WIDTH 2", "WIDTH 0", None, "the cloud has no points"),
            ("WIDTH 2\nHEIGHT 2", "WIDTH 4\nHEIGHT 1", None, "the cloud is not organised: its height is 1"),
            ("WIDTH 2", "WIDTH 9999999999", None, "9999999999 x 2 points are more than"),
            ("WIDTH 2", "WIDTH -2", Some(7), "`-2` is not a whole number"),
            ("POINTS 4", "POINTS 5", None, "5 points are announced for 2 x 2 pixels"),
            ("FIELDS x y", "FIELDS x q", None, "the cloud has no field `y`"),
            ("SIZE 4 4", "SIZE 4 3", None, "field `y`: no number of type F has 3 bytes"),
            ("COUNT 1 1", "COUNT 1", Some(6), "4 values for 5 fields"),
            ("DATA binary", "DATA binary_compressed", Some(11), "data format `binary_compressed` is not supported"),
        ];
        let whole = packed();
        let end = whole.windows(12).position(|w| w == b"DATA binary\n").expect("a header") + 12;
        for (old, new, line, message) in cases {
            let header = str::from_utf8(&whole[..end]).expect("text").replace(old, new);
            let content = [header.as_bytes(), &whole[end..]].concat();
            let error = read_cloud(file("f.pcd", &content)).expect_err(new);
            assert!(error.line == line && error.message.starts_with(message), "{new}: {error:?}");
        }
        assert!(read_cloud("/nowhere/at/all.pcd").is_err());
        let error = read_cloud(file("g.pcd", &[0xff; 50])).expect_err("noise");
        assert_eq!(error.message, "the header of a PCD file has no line `DATA`");
    }

    #[test]
    fn a_single_column_is_a_cloud() {
        let content = format!("{HEADER}DATA ascii\n1 2 3 9 0\n1 2 3 9 0\n")
            .replace("WIDTH 2", "WIDTH 1")
            .replace("POINTS 4", "POINTS 2");
        assert_eq!(read_cloud(file("h.pcd", content.as_bytes())).expect("a cloud").cloud.size(), (1, 2));
        let wrong = content.replace("3 9 0\n1", "3 nine 0\n1");
        let error = read_cloud(file("i.pcd", wrong.as_bytes())).expect_err("a word");
        assert_eq!((error.line, error.message.as_str()), (Some(12), "intensity: `nine` is not a number"));
    }
}
