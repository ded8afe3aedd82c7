//! History of a node: when it was active, and when it fired. Nothing is sampled: what happened long ago is summed up in
//! intervals that grow with the length of the run.

use serde::Serialize;
use std::borrow::Cow;

/// Number of entries of all lanes of a robot, and the limits for one of them.
const ENTRIES: usize = 4_000_000;
const FEWEST: usize = 2_000;
const MOST: usize = 100_000;
/// Maximum number of columns of a window.
const MAX_COLUMNS: u32 = 10_000;
/// Width of the first buckets in ns.
const BUCKET: i64 = 1_000_000;

/// History of a node.
#[derive(Clone)]
pub struct Lane {
    /// Number of spans, buckets and marks, beyond which two become one.
    room: usize,
    /// Beginning and end of each time of activity in ns, in sequence; the last one may have no end yet.
    spans: Vec<(i64, i64)>,
    /// Width in ns of the gaps between spans, and of the distances between marks, that are left out; at first 0.
    grain: i64,
    /// Width of a bucket in ns.
    bucket: i64,
    /// Beginning of each bucket with firings, and the number of firings up to its end.
    fired: Vec<(i64, u64)>,
    /// Times of failures, missed deadlines and the like in ns.
    marks: Vec<i64>,
}

/// A lane as it is drawn: positions are columns.
#[derive(Debug, Default, PartialEq, Serialize)]
pub struct Drawn {
    /// Node.
    pub node: usize,
    /// Columns in which it was active: the first one, and the one after the last.
    pub spans: Vec<(u32, u32)>,
    /// Columns in which it fired, with the number of firings.
    pub ticks: Vec<(u32, u64)>,
    /// Columns with problems.
    pub marks: Vec<u32>,
}

/// A part of the time, in columns.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Its beginning in ns.
    pub from: i64,
    /// Its end in ns.
    pub to: i64,
    /// Number of columns.
    pub columns: u32,
}

/// Largest time in ns, before and after 0: 36 years. Times come from robots and pages; within this limit they can be
/// added and subtracted.
const LATEST: i64 = 1 << 60;

/// Limits a time in ns.
pub fn limited(time: i64) -> i64 {
    time.clamp(-LATEST, LATEST)
}

/// Returns a time in s as one in ns, within the limit.
pub fn nanos(seconds: f64) -> i64 {
    limited((seconds * 1e9).round() as i64)
}

impl Window {
    /// The time between two times in s, in this sequence or the other one.
    pub fn new(from: f64, to: f64, columns: u32) -> Self {
        let (from, to) = (nanos(from), nanos(to));
        Self { from: from.min(to), to: from.max(to), columns: columns.clamp(1, MAX_COLUMNS) }
    }

    /// Width of a column in ns.
    pub fn column_width(&self) -> i64 {
        (self.to.saturating_sub(self.from) / i64::from(self.columns.max(1))).max(1)
    }

    /// Column of a time, limited to the window.
    fn column(&self, time: i64) -> u32 {
        let all = self.to.saturating_sub(self.from).max(1) as f64;
        let at = time.min(self.to).saturating_sub(self.from).max(0) as f64;
        (at / all * f64::from(self.columns)) as u32
    }
}

impl Default for Lane {
    fn default() -> Self {
        Self::of(1)
    }
}

impl Lane {
    /// A lane of one of so many nodes.
    pub fn of(nodes: usize) -> Self {
        let room = (ENTRIES / nodes.max(1)).clamp(FEWEST, MOST);
        Self { room, spans: vec![], grain: 0, bucket: BUCKET, fired: vec![], marks: vec![] }
    }

    /// A lane with buckets of this width in ns, for a short time.
    pub fn fine(bucket: i64) -> Self {
        Self { room: usize::MAX, bucket, ..Self::of(1) }
    }

    /// The node becomes active or inactive.
    pub fn activity(&mut self, now: i64, active: bool) {
        let open = self.spans.last_mut().filter(|span| span.1 == i64::MAX);
        match (open, active) {
            (None, true) => match self.spans.last_mut() {
                Some(last) if now - last.1 < self.grain => last.1 = i64::MAX,
                _ => self.spans.push((now, i64::MAX)),
            },
            (Some(span), false) => span.1 = now,
            _ => {}
        }
        if self.spans.len() > self.room {
            self.coarsen();
        }
    }

    /// Leaves out gaps and distances of twice the width, until half of the room is free.
    fn coarsen(&mut self) {
        while self.spans.len().max(self.marks.len()) > self.room / 2 {
            self.grain = (self.grain * 2).max(BUCKET);
            self.leave_out();
        }
    }

    /// Leaves out what is narrower than the grain.
    fn leave_out(&mut self) {
        let grain = self.grain;
        self.spans.dedup_by(|next, last| {
            let is_near = next.0.saturating_sub(last.1) < grain;
            last.1 = if is_near { next.1 } else { last.1 };
            is_near
        });
        self.marks.dedup_by(|next, last| *next - *last < grain);
    }

    /// `true` if all times are as they were.
    pub fn is_exact(&self) -> bool {
        self.grain == 0
    }

    /// `true` if something is summed up in intervals that are wider than a column of the window.
    pub fn is_coarser_than(&self, window: Window) -> bool {
        self.bucket.max(self.grain) > window.column_width()
    }

    /// The node fires.
    pub fn fire(&mut self, now: i64) {
        let (start, before) = (now - now.rem_euclid(self.bucket), self.fired.last().map_or(0, |last| last.1));
        match self.fired.last_mut() {
            Some(last) if last.0 >= start => last.1 += 1,
            _ => self.fired.push((start, before + 1)),
        }
        if self.fired.len() > self.room {
            self.widen();
        }
    }

    /// Makes one bucket of two.
    fn widen(&mut self) {
        self.bucket *= 2;
        let mut wide: Vec<(i64, u64)> = Vec::with_capacity(self.fired.len());
        for (start, count) in self.fired.drain(..) {
            let start = start - start.rem_euclid(self.bucket);
            match wide.last_mut() {
                Some(last) if last.0 == start => last.1 = count,
                _ => wide.push((start, count)),
            }
        }
        self.fired = wide;
    }

    /// A problem occurs.
    pub fn mark(&mut self, now: i64) {
        if self.marks.last().is_none_or(|last| now - last >= self.grain) {
            self.marks.push(now);
        }
        if self.marks.len() > self.room {
            self.coarsen();
        }
    }

    /// The part of it up to a time with this state of the node: activity, and number of firings.
    pub fn until(&self, now: i64, active: bool, fired: u64) -> Self {
        let mut spans: Vec<(i64, i64)> = self.spans.iter().copied().take_while(|span| span.0 <= now).collect();
        if let Some(last) = spans.last_mut().filter(|_| active) {
            last.1 = i64::MAX;
        } else if let Some(last) = spans.last_mut()
            && last.1 > now
        {
            // It became active only in a later reaction at the same time.
            spans.pop();
        }
        let end = self.fired.partition_point(|(_, count)| *count < fired);
        let mut buckets = self.fired[..(end + 1).min(self.fired.len())].to_vec();
        match buckets.last_mut() {
            Some(last) if fired > 0 => last.1 = fired,
            _ => buckets.clear(),
        }
        let marks = self.marks.iter().copied().take_while(|mark| *mark <= now).collect();
        Self { room: self.room, spans, grain: self.grain, bucket: self.bucket, fired: buckets, marks }
    }

    /// `true` if it is active after the reactions at a time.
    pub fn is_active_at(&self, time: i64) -> bool {
        let begun = self.spans.partition_point(|span| span.0 <= time);
        begun > 0 && self.spans[begun - 1].1 > time
    }

    /// Times of activity that end after `from` and begin until `to`.
    pub fn spans_in(&self, from: i64, to: i64) -> impl Iterator<Item = (i64, i64)> + '_ {
        self.spans.iter().copied().filter(move |(begin, end)| *end > from && *begin <= to)
    }

    /// `true` if it was active at any time.
    pub fn was_active(&self) -> bool {
        !self.spans.is_empty()
    }

    /// `true` if it was active or had problems at any time.
    pub fn is_of_interest(&self) -> bool {
        !self.spans.is_empty() || !self.marks.is_empty()
    }

    /// Time of the first difference from another lane between two times, if there is one. What one of them has summed
    /// up is compared as a sum.
    pub fn differs(&self, other: &Self, from: i64, until: i64) -> Option<i64> {
        let (bucket, grain) = (self.bucket.max(other.bucket), self.grain.max(other.grain));
        let (one, other) = (self.with(bucket, grain), other.with(bucket, grain));
        // A span at the end may be joined with one after it.
        let spans = |lane: &Self| lane.changes(from, until.saturating_sub(grain));
        let spans = first_difference(&spans(&one), &spans(&other), |time| *time);
        let fired = first_difference(&one.counts(from, until), &other.counts(from, until), |(start, _)| *start);
        spans.into_iter().chain(fired).min()
    }

    /// Times at which activity begins or ends between two times; the first one, too, if it is active then.
    fn changes(&self, from: i64, until: i64) -> Vec<i64> {
        let first = self.is_active_at(from).then_some(from);
        let ends = self.spans.iter().flat_map(|(begin, end)| [*begin, *end]);
        first.into_iter().chain(ends.filter(|time| *time > from && *time < until)).collect()
    }

    /// Buckets between two times, with their numbers of firings.
    fn counts(&self, from: i64, until: i64) -> Vec<(i64, u64)> {
        let mut before = 0;
        let counts = self.fired.iter().map(|(start, count)| (*start, count - std::mem::replace(&mut before, *count)));
        counts.filter(|(start, _)| *start >= from && start + self.bucket <= until).collect()
    }

    /// The same lane with wider buckets, and a wider grain.
    fn with(&self, bucket: i64, grain: i64) -> Cow<'_, Self> {
        if (self.bucket, self.grain) == (bucket, grain) {
            return Cow::Borrowed(self);
        }
        let mut lane = self.clone();
        while lane.bucket < bucket {
            lane.widen();
        }
        lane.grain = grain;
        lane.leave_out();
        Cow::Owned(lane)
    }

    /// The part of it in a window. `now` is the current time.
    pub fn draw(&self, node: usize, window: Window, now: i64) -> Drawn {
        let mut spans: Vec<(u32, u32)> = vec![];
        let first = self.spans.partition_point(|span| span.1 < window.from);
        for (from, to) in self.spans[first..].iter().take_while(|span| span.0 <= window.to) {
            let (from, to) = (window.column(*from), window.column((*to).min(now)));
            // What is shorter than a column is drawn nevertheless.
            let to = to.max(from + 1);
            match spans.last_mut() {
                Some(last) if last.1 >= from => last.1 = last.1.max(to),
                _ => spans.push((from, to)),
            }
        }
        let mut ticks: Vec<(u32, u64)> = vec![];
        let first = self.fired.partition_point(|(start, _)| *start < window.from);
        let mut before = first.checked_sub(1).map_or(0, |at| self.fired[at].1);
        for (start, count) in self.fired[first..].iter().take_while(|(start, _)| *start <= window.to) {
            let (column, count) = (window.column(*start), count - std::mem::replace(&mut before, *count));
            match ticks.last_mut() {
                Some(last) if last.0 == column => last.1 += count,
                _ => ticks.push((column, count)),
            }
        }
        let first = self.marks.partition_point(|mark| *mark < window.from);
        let mut marks: Vec<u32> = self.marks[first..]
            .iter()
            .take_while(|mark| **mark <= window.to)
            .map(|mark| window.column(*mark))
            .collect();
        marks.dedup();
        Drawn { node, spans, ticks, marks }
    }
}

/// Time of the first entry that is not the same in both.
fn first_difference<T: PartialEq>(one: &[T], other: &[T], time: impl Fn(&T) -> i64) -> Option<i64> {
    let same = one.iter().zip(other).take_while(|(a, b)| a == b).count();
    one.get(same).into_iter().chain(other.get(same)).map(time).min()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Window = Window { from: 0, to: 3_600_000_000_000, columns: 1000 };

    #[test]
    fn an_hour_at_1_khz_is_drawn_without_loss() {
        let mut lane = Lane::default();
        (0..3_600_000).for_each(|ms| lane.fire(ms * 1_000_000));
        assert!(lane.fired.len() <= MOST);
        let drawn = lane.draw(0, ALL, ALL.to);
        assert_eq!(drawn.ticks.len(), 1000);
        assert_eq!(drawn.ticks.iter().map(|(_, count)| count).sum::<u64>(), 3_600_000);
    }

    #[test]
    fn the_shortest_activity_is_seen_at_every_scale() {
        let mut lane = Lane::default();
        lane.activity(5_000_000, true);
        lane.activity(5_000_001, false);
        lane.activity(1_800_000_000_000, true);
        lane.mark(5_000_000);
        let drawn = lane.draw(2, ALL, 2_700_000_000_000);
        assert_eq!(drawn, Drawn { node: 2, spans: vec![(0, 1), (500, 750)], ticks: vec![], marks: vec![0] });
        let near = Window { from: 4_000_000, to: 6_000_000, columns: 100 };
        assert_eq!(lane.draw(2, near, 2_700_000_000_000).spans, [(50, 51)]);
    }

    #[test]
    fn a_lane_is_taken_back_to_an_earlier_state() {
        let (mut early, mut late, ms) = (Lane::default(), Lane::default(), |ms: f64| (ms * 1e6) as i64);
        for lane in [&mut early, &mut late] {
            lane.activity(ms(1.0), true);
            [1.0, 2.1, 2.2].into_iter().for_each(|at| lane.fire(ms(at)));
            lane.mark(ms(2.0));
        }
        late.fire(ms(2.3));
        late.fire(ms(4.0));
        late.activity(ms(4.0), false);
        late.activity(ms(5.0), true);
        late.mark(ms(5.0));
        let back = late.until(ms(2.2), true, 3);
        assert_eq!((back.spans, back.fired, back.marks), (early.spans, early.fired, early.marks));
        let begin = late.until(0, false, 0);
        assert_eq!((begin.spans, begin.fired, begin.marks), (vec![], vec![], vec![]));
    }

    #[test]
    fn any_window_can_be_drawn_of_any_lane() {
        let extremes =
            [f64::NEG_INFINITY, -1e300, -1e9, -1.0, 0.0, 1e-9, 5.0, 1e9, 9.3e9, 1e300, f64::INFINITY, f64::NAN];
        let times = [i64::MIN, i64::MIN + 1, -1, 0, 1, 5_000_000_000, i64::MAX - 1, i64::MAX].map(limited);
        let mut lane = Lane::of(usize::MAX);
        for time in times {
            lane.activity(time, true);
            lane.fire(time);
            lane.mark(time);
            lane.activity(time, false);
        }
        for from in extremes {
            for to in extremes {
                for columns in [0, 1, 1000, u32::MAX] {
                    let window = Window::new(from, to, columns);
                    assert!(window.from <= window.to && window.column_width() > 0);
                    let drawn = lane.draw(0, window, limited(i64::MAX));
                    assert!(drawn.spans.iter().all(|(from, to)| from < to && *to <= window.columns + 1));
                }
            }
        }
    }

    #[test]
    fn activity_that_changes_all_the_time_needs_little_room() {
        let lane = |changes: i64| {
            let mut lane = Lane::of(2000);
            for ms in 0..changes {
                lane.activity(ms * 1_000_000, ms % 3 == 0);
                lane.mark(ms * 1_000_000);
            }
            lane
        };
        let long = lane(300_000);
        assert!(!long.is_exact() && long.spans.len().max(long.marks.len()) <= long.room);
        let drawn = long.draw(0, Window { to: 300_000_000_000, columns: 100, ..ALL }, 300_000_000_000);
        assert_eq!((drawn.spans, drawn.marks.len()), (vec![(0, 99)], 100));
        // One that has summed up less is compared in the same way.
        assert_eq!(long.differs(&lane(5000), 0, 4_000_000_000), None);
    }

    #[test]
    fn the_first_difference_of_two_runs_is_found() {
        let lane = |spans: &[(i64, i64)], fired: &[i64]| {
            let mut lane = Lane::default();
            fired.iter().for_each(|ms| lane.fire(ms * 1_000_000));
            for (from, to) in spans {
                lane.activity(from * 1_000_000, true);
                lane.activity(to * 1_000_000, false);
            }
            lane
        };
        let (one, ms) = (lane(&[(1, 5), (8, 9)], &[1, 2, 3]), |ms: i64| ms * 1_000_000);
        let differs = |spans, fired, until| one.differs(&lane(spans, fired), ms(0), ms(until));
        assert_eq!(differs(&[(1, 5), (8, 9)], &[1, 2, 3], 99), None);
        assert_eq!(differs(&[(1, 5), (7, 9)], &[1, 2, 3], 99), Some(ms(7)));
        assert_eq!(differs(&[(1, 5)], &[1, 2, 3], 99), Some(ms(8)));
        assert_eq!(differs(&[(1, 5)], &[1, 2, 3], 8), None);
        assert_eq!(differs(&[(1, 5), (8, 9)], &[1, 2, 2, 3], 99), Some(ms(2)));
        // One of which only the end is known.
        assert_eq!(one.differs(&lane(&[(3, 5), (8, 9)], &[3]), ms(3), ms(99)), None);
        assert_eq!(one.differs(&lane(&[(4, 5), (8, 9)], &[3]), ms(3), ms(99)), Some(ms(3)));
    }
}
