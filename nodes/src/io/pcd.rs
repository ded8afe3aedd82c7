use super::{ReadError, lzf};
use crate::cloud::{CloudPoint, MAX_POINTS, PointCloud};
use apex_rt::Time;
use std::{borrow::Cow, fs, path::Path, str::FromStr};

/// Cloud of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedCloud {
    /// Points, in the frame of the file. A cloud that is not organised has a single row.
    pub cloud: PointCloud,
    /// Content of the field `label` for each point, if the file has one.
    pub labels: Option<Vec<u32>>,
}

impl RecordedCloud {
    /// Returns `true` if the points are in the order of the pixels of a camera.
    pub fn is_organised(&self) -> bool {
        self.cloud.size().1 > 1
    }
}

/// Reads a point cloud from a file of the Point Cloud Library (PCD 0.7: `DATA ascii`, `binary` or `binary_compressed`).
///
/// The fields `x`, `y` and `z` are needed, `intensity` and `label` are read, others are skipped. Without `intensity`
/// all intensities are 0.
///
/// # Errors
/// If the file cannot be read, has no points, is cut off, or if a field that is read is missing or is not a number.
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
    format: Format,
    lines: usize,
}

/// Encoding of the points.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
enum Format {
    /// A line for each point.
    #[default]
    Text,
    /// All fields of a point after those of the one before.
    Points,
    /// Each field for all points, compressed.
    Fields,
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
                self.format = match words.first() {
                    Some(&"ascii") => Format::Text,
                    Some(&"binary") => Format::Points,
                    Some(&"binary_compressed") => Format::Fields,
                    other => {
                        let format = other.unwrap_or(&"");
                        let known = "`ascii`, `binary` or `binary_compressed`";
                        return Err(format!("data format `{format}` is not supported; save it as {known}"));
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
        let place = |name: &str| self.place(name).map_err(|message| (None, message));
        let needed = |name: &str| place(name)?.ok_or((None, format!("the cloud has no field `{name}`")));
        let coordinates = [needed("x")?, needed("y")?, needed("z")?];
        let (intensity, label) = (place("intensity")?, place("label")?);
        let data = self.data(data).map_err(|message| (None, message))?;
        let mut cloud = PointCloud::default();
        cloud.reset(Time::ZERO, (self.width, self.height));
        let mut labels = label.as_ref().map(|_| Vec::with_capacity(cloud.points().len()));
        let mut records = Records { header: self, data: &data, taken: 0, line: self.lines };
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

    /// Data of all points. They must be there before memory is reserved for the points.
    fn data<'a>(&self, data: &'a [u8]) -> Result<Cow<'a, [u8]>, String> {
        let points = self.width * self.height;
        let cut = |found: usize| format!("the file is cut off: it ends after {found} of {points} points");
        match self.format {
            // Three numbers and their ends.
            Format::Text if data.len() < 6 * points - 1 => {
                let lines = data.split(|byte| *byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
                Err(cut(lines.count()))
            }
            Format::Text => Ok(Cow::Borrowed(data)),
            Format::Points => match points.checked_mul(self.size()) {
                Some(size) if data.len() >= size => Ok(Cow::Borrowed(data)),
                _ => Err(cut(data.len() / self.size())),
            },
            Format::Fields => self.unpacked(data, points).map(Cow::Owned),
        }
    }

    /// Decompressed data. Its sizes stand before it.
    fn unpacked(&self, data: &[u8], points: usize) -> Result<Vec<u8>, String> {
        const CUT: &str = "the compressed points are cut off or damaged";
        let (packed, rest) = data.split_first_chunk().ok_or(CUT)?;
        let (size, rest) = rest.split_first_chunk().ok_or(CUT)?;
        let [packed, size] = [*packed, *size].map(|bytes| u32::from_le_bytes(bytes) as usize);
        if points.checked_mul(self.size()) != Some(size) {
            return Err(format!("{points} points of {} bytes do not have {size} bytes", self.size()));
        }
        rest.get(..packed).and_then(|packed| lzf::unpack(packed, size)).ok_or_else(|| CUT.to_owned())
    }

    /// Size of a binary point.
    fn size(&self) -> usize {
        self.fields.iter().map(|field| field.count * field.size).sum()
    }

    /// Place of a field, or `None` if there is none.
    fn place(&self, name: &str) -> Result<Option<Place<'_>>, String> {
        let Some(at) = self.fields.iter().position(|field| field.name == name && field.count > 0) else {
            return Ok(None);
        };
        let (field, before) = (&self.fields[at], &self.fields[..at]);
        if self.format != Format::Text && binary(field.kind, &[0; 8][..field.size]).is_none() {
            return Err(format!("field `{name}`: no number of type {} has {} bytes", field.kind, field.size));
        }
        let value = before.iter().map(|field| field.count).sum();
        let byte = before.iter().map(|field| field.count * field.size).sum();
        Ok(Some(Place { field, value, byte }))
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
    Point(&'a [u8]),
    /// Number of the point, number of all points, and the data of all.
    Fields(usize, usize, &'a [u8]),
    Text(usize, Vec<&'a str>),
}

impl<'a> Records<'a> {
    fn next(&mut self) -> Result<Record<'a>, Wrong> {
        let taken = self.taken;
        let points = self.header.width * self.header.height;
        let cut = || (None, format!("the file is cut off: it ends after {taken} of {points} points"));
        self.taken += 1;
        match self.header.format {
            Format::Fields => return Ok(Record::Fields(taken, points, self.data)),
            Format::Points => {
                let (point, rest) = self.data.split_at_checked(self.header.size()).ok_or_else(cut)?;
                self.data = rest;
                return Ok(Record::Point(point));
            }
            Format::Text => {}
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
            Self::Point(_) | Self::Fields(..) => None,
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
            Self::Point(bytes) => place.number(bytes, place.byte),
            Self::Fields(point, points, bytes) => {
                place.number(bytes, points * place.byte + point * place.field.count * place.field.size)
            }
        }
    }
}

impl Place<'_> {
    /// Number of the field that begins at a byte.
    fn number(&self, bytes: &[u8], at: usize) -> Result<f64, String> {
        let number = bytes.get(at..at + self.field.size).and_then(|bytes| binary(self.field.kind, bytes));
        number.ok_or_else(|| format!("field `{}` is missing", self.field.name))
    }
}

fn binary(kind: char, bytes: &[u8]) -> Option<f64> {
    Some(match (kind, bytes) {
        ('F', &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        ('F', &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
        ('U', &[a]) => f64::from(a),
        ('U', &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
        ('U', &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
        ('U', &[a, b, c, d, e, f, g, h]) => u64::from_le_bytes([a, b, c, d, e, f, g, h]) as f64,
        ('I', &[a, b, c, d, e, f, g, h]) => i64::from_le_bytes([a, b, c, d, e, f, g, h]) as f64,
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

    /// A file with each field for all points, compressed.
    fn compressed() -> Vec<u8> {
        let (binary, points) = (packed(), 4);
        let (head, data) = binary.split_at(binary.len() - 20 * points);
        let fields: Vec<u8> =
            (0..5).flat_map(|field| data.chunks(20).flat_map(move |p| p[4 * field..][..4].to_vec())).collect();
        let mut file = String::from_utf8_lossy(head).replace("DATA binary", "DATA binary_compressed").into_bytes();
        let packed = lzf::tests::pack(&fields);
        file.extend([packed.len(), fields.len()].into_iter().flat_map(|size| (size as u32).to_le_bytes()));
        file.extend(packed);
        file
    }

    #[test]
    fn all_encodings_have_the_same_content() {
        for (name, content) in [("a.pcd", text()), ("b.pcd", packed()), ("j.pcd", compressed())] {
            let read = read_cloud(file(name, &content)).expect("a cloud");
            assert_eq!((read.cloud.size(), read.labels), ((2, 2), Some(vec![0, 0, 21, 1])));
            let measured: Vec<bool> = read.cloud.points().iter().map(CloudPoint::is_measured).collect();
            assert_eq!(measured, [true, false, true, false]);
            assert_eq!(read.cloud.points()[2], CloudPoint { x: 1.5, y: 2.0, z: -3.0, intensity: 8.0 });
        }
    }

    #[test]
    fn files_that_are_cut_off_are_errors() {
        for (name, whole) in [("c.pcd", text()), ("d.pcd", packed()), ("k.pcd", compressed())] {
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
            ("WIDTH 2", "WIDTH 9999999999", None, "9999999999 x 2 points are more than"),
            ("WIDTH 2", "WIDTH -2", Some(7), "`-2` is not a whole number"),
            ("POINTS 4", "POINTS 5", None, "5 points are announced for 2 x 2 pixels"),
            ("FIELDS x y", "FIELDS x q", None, "the cloud has no field `y`"),
            ("SIZE 4 4", "SIZE 4 3", None, "field `y`: no number of type F has 3 bytes"),
            ("COUNT 1 1", "COUNT 1", Some(6), "4 values for 5 fields"),
            ("SIZE 4 4", "SIZE 4 0", None, "field `y`: no number of type F has 0 bytes"),
            ("DATA binary", "DATA zip", Some(11), "data format `zip` is not supported; save it as `ascii`"),
            ("DATA binary", "DATA binary_compressed", None, "4 points of 20 bytes do not have 1073741824 bytes"),
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
    fn a_cloud_that_is_not_organised_is_a_row() {
        for (name, content) in [("l.pcd", text()), ("m.pcd", packed()), ("n.pcd", compressed())] {
            let at = content.windows(16).position(|part| part == b"WIDTH 2\nHEIGHT 2").expect("a size");
            let content = [&content[..at], b"WIDTH 4\nHEIGHT 1", &content[at + 16..]].concat();
            let read = read_cloud(file(name, &content)).expect("a cloud");
            assert_eq!((read.cloud.size(), read.is_organised(), read.cloud.points()[2].z), ((4, 1), false, -3.0));
        }
        assert!(read_cloud(file("o.pcd", &packed())).expect("a cloud").is_organised());
    }

    #[test]
    fn a_header_reserves_no_memory() {
        let header = HEADER.replace("WIDTH 2\nHEIGHT 2", "WIDTH 4096\nHEIGHT 4096").replace("POINTS 4\n", "");
        for (format, message) in [
            ("ascii", "the file is cut off: it ends after 2 of 16777216 points"),
            ("binary", "the file is cut off: it ends after 0 of 16777216 points"),
        ] {
            let content = format!("{header}DATA {format}\n1 2 3\n4 5 6\n");
            assert_eq!(read_cloud(file("p.pcd", content.as_bytes())).expect_err("cut off").message, message);
        }
        let mut content = format!("{header}DATA binary_compressed\n").into_bytes();
        content.extend([100_u32, 20 << 24].into_iter().flat_map(u32::to_le_bytes));
        content.extend([0; 50]);
        let error = read_cloud(file("q.pcd", &content)).expect_err("cut off");
        assert_eq!(error.message, "the compressed points are cut off or damaged");
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
