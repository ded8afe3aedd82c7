use apex_nodes::scan::Point2;
use apex_rt::Time;
use std::{collections::BTreeMap, fs};

/// Time between annotated frames.
const STEP_MS: i64 = 400;

/// Longest gap between annotations that is filled with empty frames, in frames.
const MAX_GAP: i64 = 1000;

/// Annotated persons at one time.
pub struct Frame {
    pub time: Time,
    /// Numbers and positions.
    pub persons: Vec<(u32, Point2)>,
}

/// Reads annotations. Frames between the annotated ones are without persons.
pub fn read(file: &str) -> Result<Vec<Frame>, String> {
    let text = fs::read_to_string(file).map_err(|e| format!("{file} cannot be read: {e}"))?;
    let mut annotated: BTreeMap<i64, Vec<(u32, Point2)>> = BTreeMap::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let (frame, person) =
            entry(line).ok_or_else(|| format!("{file}:{}: `frame person x z y` expected", number + 1))?;
        annotated.entry(frame).or_default().push(person);
    }
    let numbers: Vec<i64> = annotated.keys().copied().collect();
    let step =
        numbers.windows(2).map(|w| w[1] - w[0]).min().ok_or_else(|| format!("{file} has fewer than 2 frames"))?;
    let mut frames: Vec<Frame> = Vec::new();
    let mut count = 0;
    for (number, persons) in annotated {
        let at = (number - numbers[0]) / step;
        while count < at && at - count < MAX_GAP {
            frames.push(Frame { time: Time::from_millis(STEP_MS * count), persons: Vec::new() });
            count += 1;
        }
        frames.push(Frame { time: Time::from_millis(STEP_MS * at), persons });
        count = at + 1;
    }
    Ok(frames)
}

fn entry(line: &str) -> Option<(i64, (u32, Point2))> {
    let mut numbers = line.split_whitespace().map(|word| word.parse::<f64>().ok().filter(|n| n.is_finite()));
    let (frame, person) = (numbers.next()??, numbers.next()??);
    let (x, _, y) = (numbers.next()??, numbers.next()??, numbers.next()??);
    Some((frame as i64, (person as u32, Point2::new(x as f32, y as f32))))
}
