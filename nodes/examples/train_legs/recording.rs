use apex_nodes::scan::{Point2, Scan, Segment};
use flate2::read::MultiGzDecoder;
use std::{fs, io::Read};

/// Distance of the middle of a segment from an annotated leg, in m.
const LEG_RADIUS: f32 = 0.15;

/// Scan with labels.
pub struct Labelled {
    pub scan: Scan,
    pub legs: Truth,
}

/// Legs in a scan.
pub enum Truth {
    /// `true` for each beam that hit a leg.
    Beams(Vec<bool>),
    /// Middles of the legs, in the frame of the scanner.
    Positions(Vec<Point2>),
}

impl Labelled {
    /// Returns `true` if most beams of a segment hit a leg, or if an annotated leg is in its middle.
    pub fn is_leg(&self, segment: &Segment) -> bool {
        match &self.legs {
            Truth::Beams(beams) => {
                let measured = segment.beams(beams.len()).filter(|beam| self.scan.range(*beam).is_some());
                let hits = measured.filter(|beam| beams.get(*beam) == Some(&true)).count();
                2 * hits > usize::from(segment.points)
            }
            Truth::Positions(legs) => legs.iter().any(|leg| (*leg - segment.mid_range()).norm() < LEG_RADIUS),
        }
    }
}

/// Reads a recording.
pub fn read(file: &str) -> Result<Vec<Labelled>, String> {
    let bytes = fs::read(file).map_err(|e| format!("{file} cannot be read: {e}"))?;
    let mut text = String::new();
    let read = if bytes.starts_with(&[0x1f, 0x8b]) {
        MultiGzDecoder::new(&bytes[..]).read_to_string(&mut text)
    } else {
        (&bytes[..]).read_to_string(&mut text)
    };
    read.map_err(|e| format!("{file} cannot be read: {e}"))?;
    let scans = if text.starts_with('#') { by_beam(&text) } else { by_position(&text) };
    let scans = scans.map_err(|(line, why)| format!("{file}:{line}: {why}"))?;
    if scans.is_empty() { Err(format!("{file} holds no scan")) } else { Ok(scans) }
}

type Failure = (usize, &'static str);

fn number(word: Option<&str>) -> Option<f32> {
    word?.trim().parse().ok().filter(|x: &f32| x.is_finite())
}

/// Reads lines of `angle,range,label`.
fn by_beam(text: &str) -> Result<Vec<Labelled>, Failure> {
    let mut scans: Vec<Labelled> = Vec::new();
    for (at, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        if line.starts_with('#') {
            scans.push(Labelled { scan: Scan::default(), legs: Truth::Beams(Vec::new()) });
            continue;
        }
        let Some(Labelled { scan, legs: Truth::Beams(labels) }) = scans.last_mut() else {
            return Err((at + 1, "a line `# name` expected"));
        };
        let mut words = line.split(',');
        let beam = (number(words.next()), number(words.next()), number(words.next()));
        let (Some(angle), Some(range), Some(label)) = beam else {
            return Err((at + 1, "`angle,range,label` expected"));
        };
        match scan.ranges.len() {
            0 => scan.angle_min = angle,
            count => scan.angle_increment = (angle - scan.angle_min) / count as f32,
        }
        scan.ranges.push(range).map_err(|_| (at + 1, "too many beams"))?;
        labels.push(label > 0.5);
    }
    Ok(scans)
}

/// Reads lines of `number,first angle,increment,x y;x y;…,ranges…`.
fn by_position(text: &str) -> Result<Vec<Labelled>, Failure> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let scan = |(at, line): (usize, &str)| {
        let mut words = line.split(',').skip(1);
        let (first, step) = (number(words.next()), number(words.next()));
        let legs = words.next().unwrap_or_default().split(';').filter(|leg| !leg.trim().is_empty());
        let leg = |text: &str| {
            let mut words = text.split_whitespace();
            Some(Point2::new(number(words.next())?, number(words.next())?))
        };
        let (Some(angle_min), Some(angle_increment), Some(legs)) = (first, step, legs.map(leg).collect()) else {
            return Err((at + 1, "`number,angle,increment,x y;x y,ranges` expected"));
        };
        let mut scan = Scan { angle_min, angle_increment, ..Scan::default() };
        for word in words {
            let range = number(Some(word)).ok_or((at + 1, "a range is not a number"))?;
            scan.ranges.push(range).map_err(|_| (at + 1, "too many beams"))?;
        }
        Ok(Labelled { scan, legs: Truth::Positions(legs) })
    };
    lines.map(scan).collect()
}
