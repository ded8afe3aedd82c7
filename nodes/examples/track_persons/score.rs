use crate::{tracking::Track, walks::Frame};
use pathfinding::{kuhn_munkres::kuhn_munkres, matrix::Matrix};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt,
};

/// Maximum distance of a track from the person that it follows, in m.
const REACH: f32 = 1.0;

/// Errors of a tracker: those of CLEAR MOT (Bernardin and Stiefelhagen 2008) and of identity (Ristani et al. 2016).
#[derive(Debug, Clone, Copy, Default)]
pub struct Score {
    persons: u64,
    tracks: u64,
    missed: u64,
    wrong: u64,
    switches: u64,
    /// Positions that are right in the best assignment of tracks to persons.
    identified: u64,
}

impl Score {
    /// Scores the tracks in each frame.
    pub fn of(frames: &[Frame], tracks: &[Vec<Track>]) -> Self {
        let mut score = Self { identified: identified(frames, tracks), ..Self::default() };
        // Track that followed each person last, and those that follow one now.
        let mut last: BTreeMap<u32, u32> = BTreeMap::new();
        let mut current: BTreeMap<u32, u32> = BTreeMap::new();
        for (frame, tracks) in frames.iter().zip(tracks) {
            current = correspond(frame, tracks, &current);
            score.persons += frame.persons.len() as u64;
            score.tracks += tracks.len() as u64;
            score.missed += (frame.persons.len() - current.len()) as u64;
            score.wrong += (tracks.len() - current.len()) as u64;
            for (person, track) in &current {
                let before = last.insert(*person, *track);
                score.switches += u64::from(before.is_some_and(|before| before != *track));
            }
        }
        score
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self {
            persons: self.persons + other.persons,
            tracks: self.tracks + other.tracks,
            missed: self.missed + other.missed,
            wrong: self.wrong + other.wrong,
            switches: self.switches + other.switches,
            identified: self.identified + other.identified,
        }
    }

    /// Multiple object tracking accuracy.
    pub fn mota(&self) -> f64 {
        1.0 - (self.missed + self.wrong + self.switches) as f64 / self.persons.max(1) as f64
    }

    /// F1 score of identification.
    pub fn idf1(&self) -> f64 {
        2.0 * self.identified as f64 / (self.persons + self.tracks).max(1) as f64
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |count: u64| 100.0 * count as f64 / self.persons.max(1) as f64;
        let (idf1, mota) = (100.0 * self.idf1(), 100.0 * self.mota());
        let (missed, wrong, switches) = (percent(self.missed), percent(self.wrong), percent(self.switches));
        write!(f, "{idf1:>6.1} {mota:>6.1} {missed:>7.1} {wrong:>7.1} {switches:>9.2}")
    }
}

fn is_near(person: &Track, track: &Track) -> bool {
    (person.1 - track.1).norm() <= REACH
}

/// Track of each person in a frame: the same as before if it is near enough, otherwise by the best assignment.
fn correspond(frame: &Frame, tracks: &[Track], before: &BTreeMap<u32, u32>) -> BTreeMap<u32, u32> {
    let mut pairs = BTreeMap::new();
    for person in &frame.persons {
        let kept = before.get(&person.0).and_then(|id| tracks.iter().find(|track| track.0 == *id));
        if let Some(track) = kept.filter(|track| is_near(person, track)) {
            pairs.insert(person.0, track.0);
        }
    }
    let used: BTreeSet<u32> = pairs.values().copied().collect();
    let persons: Vec<&Track> = frame.persons.iter().filter(|p| !pairs.contains_key(&p.0)).collect();
    let tracks: Vec<&Track> = tracks.iter().filter(|t| !used.contains(&t.0)).collect();
    // As many pairs as possible, then the nearest ones, in mm.
    let value = |p: &&Track, t: &&Track| {
        if is_near(p, t) { 1_000_000 - (1000.0 * (p.1 - t.1).norm()) as i64 } else { 0 }
    };
    for (person, track) in assign(&persons, &tracks, value) {
        pairs.insert(person.0, track.0);
    }
    pairs
}

/// Pairs of positive value with the largest sum.
fn assign<'a, A, B>(rows: &'a [A], columns: &'a [B], value: impl Fn(&A, &B) -> i64) -> Vec<(&'a A, &'a B)> {
    let size = rows.len().max(columns.len());
    if rows.is_empty() || columns.is_empty() {
        return Vec::new();
    }
    let entry = |(i, j): (usize, usize)| rows.get(i).zip(columns.get(j)).map_or(0, |(a, b)| value(a, b));
    let (_, partners) = kuhn_munkres(&Matrix::from_fn(rows.len(), size, entry));
    let pairs = rows.iter().zip(partners).filter_map(|(row, partner)| Some((row, columns.get(partner)?)));
    pairs.filter(|(row, column)| value(row, column) > 0).collect()
}

/// Number of positions that are right in the best assignment of whole tracks to persons.
fn identified(frames: &[Frame], tracks: &[Vec<Track>]) -> u64 {
    let mut together: BTreeMap<(u32, u32), i64> = BTreeMap::new();
    for (frame, tracks) in frames.iter().zip(tracks) {
        for person in &frame.persons {
            for track in tracks.iter().filter(|track| is_near(person, track)) {
                *together.entry((person.0, track.0)).or_default() += 1;
            }
        }
    }
    let persons: Vec<u32> = together.keys().map(|(p, _)| *p).collect::<BTreeSet<_>>().into_iter().collect();
    let tracks: Vec<u32> = together.keys().map(|(_, t)| *t).collect::<BTreeSet<_>>().into_iter().collect();
    let value = |p: &u32, t: &u32| together.get(&(*p, *t)).copied().unwrap_or(0);
    assign(&persons, &tracks, value).into_iter().map(|(p, t)| value(p, t) as u64).sum()
}
