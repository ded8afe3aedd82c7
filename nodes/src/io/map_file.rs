use super::{
    ReadError,
    pixels::{Pixels, is_transparent, read_pixels},
};
use crate::{
    map::{Grid, Occupancy, Raster, check_level},
    scan::Point2,
};
use apex_rt::{Out, node};
use core::fmt;
use std::{
    collections::BTreeMap,
    format, fs,
    io::Write as _,
    path::{Path, PathBuf},
};

/// Grey values of the pixels that are written, as map servers of ROS have them.
const FREE: u8 = 254;
const UNKNOWN: u8 = 205;
const OCCUPIED: u8 = 0;

/// Meaning of the pixels of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    /// Free, occupied or unknown, by the two thresholds.
    Trinary,
    /// As before, with probabilities between the thresholds.
    Scale,
    /// The grey value is the probability in %; from 101 on it is unknown.
    Raw,
}

/// Description of a map, as map servers of ROS read it from a file in YAML.
#[derive(Debug, PartialEq)]
struct Description {
    image: String,
    resolution: f32,
    origin: [f32; 3],
    negate: bool,
    occupied: f32,
    free: f32,
    mode: Mode,
}

/// Reads a grid map as the map servers of ROS store it: a description (`map.yaml`) with an image beside it.
///
/// The image is a `.pgm`, or with the feature `image` a PNG. `negate`, the thresholds, and the modes `trinary`, `scale`
/// and `raw` are those of the description; transparent pixels are unknown. Cells have no probabilities: up to 19 % they
/// are free, from 65 % on occupied, and between unknown. Lengths are in m, and the map is along the axes: one whose
/// origin is turned is refused.
///
/// # Errors
/// If a file cannot be read, or the map is turned or has too many cells.
pub fn read_map_file(path: impl AsRef<Path>) -> Result<Grid<Occupancy>, ReadError> {
    let path = path.as_ref();
    let error = |message: String| ReadError::open(path, message);
    let text = fs::read_to_string(path).map_err(|e| error(e.to_string()))?;
    let description = Description::read(&text).map_err(error)?;
    let [x, y, yaw] = description.origin;
    check_level(yaw).map_err(error)?;
    let image = path.with_file_name("").join(&description.image);
    let pixels = read_pixels(&image).map_err(|message| ReadError::open(&image, message))?;
    let Pixels { width, height, .. } = pixels;
    let raster = Raster { corner: Point2::new(x, y), resolution: description.resolution, width, height };
    pixels.map(raster, |white| description.cell(white)).map_err(error)
}

impl Description {
    fn read(text: &str) -> Result<Self, String> {
        let fields = fields(text);
        let one = |name: &str| fields.get(name).map(|values| values.join(" "));
        let number = |name: &str, default: Option<f32>| match one(name) {
            Some(text) => {
                let number = text.parse().ok().filter(|number: &f32| number.is_finite());
                number.ok_or_else(|| format!("`{name}: {text}` is not a number"))
            }
            None => default.ok_or_else(|| format!("the field `{name}` is missing")),
        };
        let resolution = number("resolution", None)?;
        if resolution <= 0.0 {
            return Err(format!("a resolution of {resolution} m is not positive"));
        }
        let origin = fields.get("origin").ok_or("the field `origin` is missing")?;
        let origin = origin.iter().map(|text| text.parse().ok().filter(|number: &f32| number.is_finite()));
        let origin = origin.collect::<Option<Vec<f32>>>().and_then(|origin| origin.try_into().ok());
        let mode = match one("mode").as_deref() {
            None | Some("trinary") => Mode::Trinary,
            Some("scale") => Mode::Scale,
            Some("raw") => Mode::Raw,
            Some(other) => return Err(format!("the mode is `{other}`, not `trinary`, `scale` or `raw`")),
        };
        let (occupied, free) = (number("occupied_thresh", Some(0.65))?, number("free_thresh", Some(0.196))?);
        if free >= occupied {
            return Err(format!("`free_thresh: {free}` is not below `occupied_thresh: {occupied}`"));
        }
        Ok(Self {
            image: one("image").ok_or("the field `image` is missing")?,
            resolution,
            origin: origin.ok_or("`origin` is not a list of three numbers: x, y and yaw")?,
            negate: negate(one("negate").as_deref().unwrap_or("0"))?,
            occupied,
            free,
            mode,
        })
    }

    /// Cell of a pixel with this share of white.
    fn cell(&self, white: f32) -> Occupancy {
        if is_transparent(white) {
            return Occupancy::Unknown;
        }
        let occupied = if self.negate { white } else { 1.0 - white };
        let percent = match self.mode {
            Mode::Raw => Some((white * 255.0).round()).filter(|percent| *percent <= 100.0),
            _ if occupied > self.occupied => Some(100.0),
            _ if occupied < self.free => Some(0.0),
            Mode::Trinary => None,
            Mode::Scale => Some(1.0 + 98.0 * (occupied - self.free) / (self.occupied - self.free)),
        };
        percent.map_or(Occupancy::Unknown, Occupancy::of_percent)
    }
}

/// Value of `negate`: a number, or a truth value of YAML.
fn negate(text: &str) -> Result<bool, String> {
    match text.to_lowercase().as_str() {
        "1" | "true" | "yes" | "on" => Ok(true),
        "0" | "false" | "no" | "off" => Ok(false),
        _ => Err(format!("`negate: {text}` is not 0, 1, `false` or `true`")),
    }
}

/// Values of the fields of a description, of which one is a list: `origin: [0, 0, 0]`, or a line with `-` for each.
fn fields(text: &str) -> BTreeMap<&str, Vec<&str>> {
    let (mut fields, mut name) = (BTreeMap::<&str, Vec<&str>>::new(), "");
    for line in text.lines() {
        // A `#` within a word is part of it.
        let end = if line.starts_with('#') { Some(0) } else { line.find(" #") };
        let line = &line[..end.unwrap_or(line.len())];
        let (item, values) = match line.trim_start().strip_prefix("- ") {
            Some(item) => (true, item),
            None => match line.split_once(':') {
                Some((key, values)) => {
                    name = key.trim();
                    (false, values)
                }
                None => continue,
            },
        };
        let values = values.trim().trim_start_matches('[').trim_end_matches(']');
        let values =
            values.split(',').map(|value| value.trim().trim_matches(['"', '\''])).filter(|value| !value.is_empty());
        let found = fields.entry(name).or_default();
        if !item {
            found.clear();
        }
        found.extend(values);
    }
    fields
}

/// Writes a grid map as the map servers of ROS read it: the description `path` (`map.yaml`), and beside it an image of
/// the same name, `map.pgm`. Files of these names are replaced.
///
/// # Errors
/// If a file cannot be written.
pub fn write_map_file(path: impl AsRef<Path>, map: &Grid<Occupancy>) -> std::io::Result<()> {
    let (path, raster) = (path.as_ref(), map.raster());
    let image = path.with_extension("pgm");
    let name = image.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut bytes = format!("P5\n{} {}\n255\n", raster.width, raster.height).into_bytes();
    // The first row of an image is the upper one.
    for row in map.cells().chunks(raster.width.max(1)).rev() {
        bytes.extend(row.iter().map(|cell| match cell {
            Occupancy::Free => FREE,
            Occupancy::Unknown => UNKNOWN,
            Occupancy::Occupied | Occupancy::Low => OCCUPIED,
        }));
    }
    let Raster { corner, resolution, .. } = raster;
    let text = format!(
        "image: {name}\nmode: trinary\nresolution: {resolution}\norigin: [{}, {}, 0]\nnegate: 0\n\
         occupied_thresh: 0.65\nfree_thresh: 0.196\n",
        corner.x, corner.y
    );
    replace(&image, &bytes)?;
    replace(path, text.as_bytes())
}

/// Writes a file beside the old one, and then replaces it: readers see one or the other.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut new = path.as_os_str().to_owned();
    new.push(".new");
    let new = PathBuf::from(new);
    let mut file = fs::File::create(&new)?;
    file.write_all(bytes)?;
    file.sync_all()?;
    fs::rename(new, path)
}

/// Grid map of a map server of ROS (see [`read_map_file`]): a source, which sends it in each firing.
///
/// Fails once if there is no valid map, and then sends ⊥.
#[node]
#[derive(Debug, Clone)]
pub struct MapFile {
    /// Description of the map (`map.yaml`).
    #[param]
    file: &'static str,
    read: Option<Grid<Occupancy>>,
    failed: bool,
}

#[node]
impl MapFile {
    fn process(&mut self, map: &mut Out<Grid<Occupancy>>) -> Result<(), ReadError> {
        if self.failed {
            return Ok(());
        }
        let read = match self.read.take() {
            Some(read) => read,
            None => read_map_file(self.file).inspect_err(|_| self.failed = true)?,
        };
        map.get_mut().clone_from(&read);
        self.read = Some(read);
        Ok(())
    }
}

/// Error of a map that cannot be written.
#[derive(Debug)]
pub struct SaveMapError {
    file: &'static str,
    error: std::io::Error,
}

impl fmt::Display for SaveMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write `{}`: {}", self.file, self.error)
    }
}

impl core::error::Error for SaveMapError {}

/// Writes each map to a file that the map servers of ROS read (see [`write_map_file`]). A later map replaces the one
/// before, so slow the maps down in front of it, for example with `Throttle`.
#[node]
#[derive(Debug, Clone)]
pub struct SaveMap {
    /// Description of the map (`map.yaml`); the image has the same name and ends in `.pgm`.
    #[param]
    file: &'static str,
}

#[node]
impl SaveMap {
    fn process(&mut self, map: &Grid<Occupancy>) -> Result<(), SaveMapError> {
        // A shadow repeats the run of another process, which has written the map.
        if apex_rt::is_shadow() {
            return Ok(());
        }
        write_map_file(self.file, map).map_err(|error| SaveMapError { file: self.file, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Occupancy::{Free, Occupied, Unknown};
    use apex_rt::Construct;

    /// Folder with a description and an image of a row of pixels, from the left: white, light grey, grey, black.
    fn folder(name: &str, yaml: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("apex-map-file-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).expect("a temporary folder");
        fs::write(folder.join("map.pgm"), b"P5 5 1 255 \xfe\xcd\x80\x3c\x00").expect("room");
        fs::write(folder.join("map.yaml"), yaml).expect("room");
        folder
    }

    fn read(name: &str, yaml: &str) -> Result<Grid<Occupancy>, String> {
        let folder = folder(name, yaml);
        let map = read_map_file(folder.join("map.yaml")).map_err(|error| error.message);
        fs::remove_dir_all(folder).expect("it is there");
        map
    }

    const PLAIN: &str = "image: map.pgm\nresolution: 0.05 # m\norigin: [-1.5, 2, 0.0]\n";

    #[test]
    fn cells_follow_the_thresholds_and_the_mode() {
        let with = |name, more: &str| read(name, &format!("{PLAIN}{more}")).expect("a map").cells().to_vec();
        assert_eq!(with("plain", ""), [Free, Unknown, Unknown, Occupied, Occupied]);
        // Nav2 writes 0.25, by which the unknown 205 is free.
        assert_eq!(with("free", "free_thresh: 0.25\n"), [Free, Free, Unknown, Occupied, Occupied]);
        for yes in ["1", "true", "True", "TRUE", "yes"] {
            assert_eq!(
                with("negate", &format!("negate: {yes}\n")),
                [Occupied, Occupied, Unknown, Unknown, Free],
                "{yes}"
            );
        }
        assert_eq!(with("plain-too", "negate: no\n"), [Free, Unknown, Unknown, Occupied, Occupied]);
        assert_eq!(with("occupied", "occupied_thresh: 0.8\n"), [Free, Unknown, Unknown, Unknown, Occupied]);
        // 205 is 1 % between the thresholds, and 128 is 66 %.
        assert_eq!(with("scale", "mode: scale\n"), [Free, Free, Occupied, Occupied, Occupied]);
        // The grey values 254, 205 and 128 are no percentages; 60 is between.
        assert_eq!(with("raw", "mode: raw\n"), [Unknown, Unknown, Unknown, Unknown, Free]);
        let map = read("list", "image: 'map.pgm'\nresolution: 0.1\norigin:\n- 1\n- -2.5\n- 0\nextra: {a: 1}\n");
        let map = map.expect("a map");
        assert_eq!((map.raster().corner, map.raster().resolution), (Point2::new(1.0, -2.5), 0.1));
    }

    #[test]
    fn what_is_no_map_is_refused_with_a_reason() {
        for (name, yaml, reason) in [
            ("turn", PLAIN.replace("0.0]", "1.5708]"), "its origin is turned by 90.0°"),
            ("mode", format!("{PLAIN}mode: grey\n"), "the mode is `grey`, not `trinary`, `scale` or `raw`"),
            ("negate", format!("{PLAIN}negate: 0.5\n"), "`negate: 0.5` is not 0, 1, `false` or `true`"),
            ("no-image", PLAIN.replace("image", "picture"), "the field `image` is missing"),
            ("no-origin", PLAIN.replace("origin", "place"), "the field `origin` is missing"),
            ("short", PLAIN.replace(", 0.0]", "]"), "`origin` is not a list of three numbers"),
            ("resolution", PLAIN.replace("0.05", "-1"), "a resolution of -1 m is not positive"),
            ("number", PLAIN.replace("0.05", "fine"), "`resolution: fine` is not a number"),
            ("order", format!("{PLAIN}free_thresh: 0.7\n"), "`free_thresh: 0.7` is not below `occupied_thresh: 0.65`"),
            ("absent", PLAIN.replace("map.pgm", "other.pgm"), "No such file"),
        ] {
            let error = read(name, &yaml).expect_err(name);
            assert!(error.contains(reason), "{name}: {error}");
        }
    }

    #[test]
    fn maps_are_written_and_read_by_nodes() {
        let folder = folder("nodes", "");
        let file: &'static str = folder.join("saved.yaml").to_str().expect("text").to_owned().leak();
        let mut map =
            Grid::new(Raster { corner: Point2::new(-1.25, 0.1), resolution: 0.05, width: 3, height: 2 }, Unknown)
                .expect("small");
        map.cells_mut().copy_from_slice(&[Free, Occupied, Unknown, Occupied, Free, Free]);
        SaveMap::construct((file,)).process(&map).expect("it is written");
        SaveMap::construct((file,)).process(&map).expect("it is replaced");
        let mut out = Out::new();
        MapFile::construct((file,)).process(&mut out).expect("a map");
        assert_eq!(out.get(), Some(&map));
        fs::remove_dir_all(folder).expect("it is there");
        assert!(SaveMap::construct((file,)).process(&map).is_err_and(|e| e.to_string().starts_with("cannot write")));
        let mut gone = MapFile::construct((file,));
        assert!(gone.process(&mut Out::new()).is_err());
        let mut out = Out::new();
        assert!(gone.process(&mut out).is_ok() && out.get().is_none());
    }
}
