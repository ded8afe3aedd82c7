use super::{Echo, Firing, LASERS, VelodynePacket, VelodynePackets, packet::since};
use crate::cloud::{CloudPoint, RingCloud};
use apex_rt::{Out, Time, node};
use core::{
    f32::consts::{PI, TAU},
    mem,
};
use std::{collections::VecDeque, vec::Vec};

/// Maximum number of columns of a turn: a VLP-16 has 3617 at five turns in a second, its slowest speed.
const MAX_COLUMNS: usize = 4096;
/// Minimum number of columns of a turn: 904 at 20 turns in a second, its highest speed.
const MIN_COLUMNS: usize = 800;
/// Maximum number of turns that wait.
const MAX_READY: usize = 16;

/// Makes turns of the packets of a VLP-16, as the nodes for scanners with rings take them.
///
/// A turn has a column for each firing of all lasers: 1808 at ten turns in a second. Their directions are in equal
/// steps, but for noise. The points of a column are those of the 16 lasers, sorted by elevation; each has its own
/// direction, as the scanner turns on by 0.12° while they fire. The time of a column is that of its first laser. A
/// column that is lost with its packet has no measurements.
///
/// Turns are cut in the direction `cut`. The turn in which packets begin to come is left out, as it is not whole, and
/// so is one with fewer than 800 or more than 4096 columns, which no speed of the scanner gives, or with packets that
/// are not in the order of their times. A firing sends one turn at most; another one in the same packets follows in the
/// next firing, also in one without packets.
///
/// Times within a turn are by the clock of the scanner. The stamp of a turn, which is that of its end, is by the time
/// at which its last packet came.
///
/// Cost: O(n) for n points. Allocates for the first turns.
#[node]
#[derive(Debug)]
pub struct VelodyneTurns {
    /// Direction in which turns begin and end, to the left of the x axis.
    #[param(unit = "rad", default = PI, range = -3.2..=3.2)]
    cut: f32,
    /// Takes the last return of each laser, and not the strongest one, if the scanner sends both.
    #[param(default = false)]
    last: bool,
    /// Distance below which a point is not measured.
    #[param(unit = "m", default = 0.5, range = 0.0..=200.0)]
    min_range: f32,
    /// Columns of the turn that is not over yet, and their times by the clock of the scanner, in ns.
    turn: RingCloud,
    nanos: Vec<u64>,
    /// `true` if the turn has its beginning.
    is_whole: bool,
    /// Angle from `cut` to the last column, in rad, and its time in ns.
    before: Option<(f32, u64)>,
    /// Turns that are over.
    ready: VecDeque<RingCloud>,
    /// Storage of a turn that was sent.
    spare: RingCloud,
}

#[node]
impl VelodyneTurns {
    fn process(&mut self, packets: Option<&VelodynePackets>, turn: &mut Out<RingCloud>) {
        for packet in packets.into_iter().flat_map(|packets| &packets.packets) {
            self.add(packet);
        }
        if let Some(mut ready) = self.ready.pop_front() {
            mem::swap(turn.get_mut(), &mut ready);
            self.spare = ready;
        }
    }

    fn add(&mut self, packet: &VelodynePacket) {
        for firing in packet.firings() {
            let angle = (firing.azimuth + self.cut).rem_euclid(TAU);
            if let Some((before, nanos)) = self.before {
                self.add_missing(nanos, firing.nanos);
                if angle + PI < before {
                    self.end(begin_of(packet, &firing), firing.nanos);
                }
            }
            self.before = Some((angle, firing.nanos));
            self.add_column(&firing);
        }
    }

    /// Adds the columns that are lost between two times.
    fn add_missing(&mut self, from: u64, to: u64) {
        let steps = (since(from, to) + Firing::NANOS / 2) / Firing::NANOS;
        if steps > MAX_COLUMNS as u64 {
            self.is_whole = false;
            return;
        }
        for step in 1..steps {
            self.push(from + step * Firing::NANOS, [CloudPoint::MISSING; LASERS]);
        }
    }

    fn add_column(&mut self, firing: &Firing) {
        let point = |row: usize| {
            let laser = laser_of(row);
            let echo = if self.last { firing.last[laser] } else { firing.strongest(laser) };
            if self.measures(echo) { point(firing.position(laser, echo), echo) } else { CloudPoint::MISSING }
        };
        self.push(firing.nanos, core::array::from_fn(point));
    }

    fn measures(&self, echo: Echo) -> bool {
        echo.distance > 0.0 && echo.distance >= self.min_range
    }

    fn push(&mut self, nanos: u64, points: [CloudPoint; LASERS]) {
        if self.turn.columns() == MAX_COLUMNS {
            self.is_whole = false;
        }
        if self.is_whole {
            self.turn.push_column(0.0, &points);
            self.nanos.push(nanos);
        }
    }

    /// Ends a turn at a time, which is also given by the clock of the scanner.
    fn end(&mut self, stamp: Time, nanos: u64) {
        if self.is_whole && self.turn.columns() >= MIN_COLUMNS {
            self.turn.stamp = stamp;
            let times = self.nanos.iter().map(|time| -(since(*time, nanos) as f32 * 1e-9));
            self.turn.times_mut().iter_mut().zip(times).for_each(|(out, time)| *out = time);
            if self.ready.len() == MAX_READY {
                self.ready.pop_front();
            }
            self.ready.push_back(mem::replace(&mut self.turn, mem::take(&mut self.spare)));
        }
        self.turn.reset(stamp, LASERS, 0);
        self.nanos.clear();
        self.is_whole = true;
    }
}

/// Time at which a firing of a packet began.
fn begin_of(packet: &VelodynePacket, firing: &Firing) -> Time {
    let before = packet.duration().saturating_sub(since(packet.nanos(), firing.nanos));
    Time::from_nanos(packet.stamp.as_nanos().saturating_sub(before as i64))
}

/// Laser of a ring, counted from the uppermost one.
const fn laser_of(row: usize) -> usize {
    let half = LASERS / 2;
    if row < half { LASERS - 1 - 2 * row } else { 2 * (LASERS - 1 - row) }
}

fn point([x, y, z]: [f32; 3], echo: Echo) -> CloudPoint {
    CloudPoint { x, y, z, intensity: f32::from(echo.reflectivity) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lidar::{elevation, packet::tests::bytes};
    use apex_rt::Construct;

    /// Angle of a firing, in hundredths of a degree, and columns of a turn.
    const STEP: usize = 20;
    const COLUMNS: usize = 36_000 / STEP;
    /// Number of firings of a packet, and its duration in ns.
    const FIRINGS: usize = 24;
    const DURATION: i64 = FIRINGS as i64 * Firing::NANOS as i64;

    fn node(cut: f32) -> VelodyneTurns {
        VelodyneTurns::construct((cut, false, 0.5))
    }

    /// Packet of this number of a scanner in the middle of a drum of 10 m. It begins at 100 ms, forward; the clock of
    /// the scanner is an hour old soon.
    fn packet(number: usize) -> VelodynePacket {
        let azimuth = |block: usize| (STEP * (FIRINGS * number + 2 * block) % 36_000) as u16;
        let micros = (3_599_950_000 + (number as u64 * DURATION as u64) / 1000) % 3_600_000_000;
        let bytes = bytes((0x37, micros as u32), azimuth, |_, _, laser| (5000, laser as u8));
        let stamp = 100_000_000 + (number as i64 + 1) * DURATION;
        VelodynePacket::new(Time::from_nanos(stamp), &bytes).expect("a packet")
    }

    /// Turns of packets that come one by one.
    fn turns(node: &mut VelodyneTurns, packets: impl Iterator<Item = VelodynePacket>) -> Vec<RingCloud> {
        let one_by_one = |packet| {
            let mut out = Out::new();
            node.process(Some(&VelodynePackets { packets: vec![packet] }), &mut out);
            out.get().cloned()
        };
        packets.filter_map(one_by_one).collect()
    }

    #[test]
    fn turns_are_whole_and_cut_behind() {
        let turns = turns(&mut node(PI), (0..260).map(packet));
        assert_eq!(turns.len(), 2, "3.5 turns, of which the first and the last are not whole");
        for (i, turn) in turns.iter().enumerate() {
            assert_eq!((turn.rings(), turn.columns()), (LASERS, COLUMNS));
            // The turn ends one and a half turns after the beginning.
            let end = 100_000_000 + (COLUMNS * (3 + 2 * i) / 2) as i64 * Firing::NANOS as i64;
            assert!((turn.stamp.as_nanos() - end).abs() < 2, "{:?}", turn.stamp);
            let duration = COLUMNS as f32 * Firing::NANOS as f32 * 1e-9;
            assert!((turn.times()[0] + duration).abs() < 2e-6, "{}", turn.times()[0]);
            assert!(turn.times().is_sorted() && (turn.times()[COLUMNS - 1] + Firing::NANOS as f32 * 1e-9).abs() < 2e-6);
            let [first, front] = [0, COLUMNS / 2].map(|column| turn.points()[LASERS * column]);
            assert!(first.x < -9.0 && front.x > 9.0 && first.y.abs() < 0.05 && front.y.abs() < 0.05);
        }
    }

    #[test]
    fn rings_are_sorted_by_elevation() {
        let turns = turns(&mut node(0.0), (0..160).map(packet));
        assert_eq!(turns.len(), 1);
        for (i, point) in turns[0].points().iter().enumerate() {
            let laser = laser_of(i % LASERS);
            assert_eq!(point.intensity, laser as f32);
            let up = libm::asinf(point.z / 10.0);
            assert!(
                (up - elevation(laser)).abs() < 1e-5
                    && (up - (15.0 - 2.0 * (i % LASERS) as f32).to_radians()).abs() < 1e-5
            );
        }
        // A quarter of a turn later, it looks to the right.
        assert!(turns[0].points()[LASERS * (COLUMNS / 4)].y < -9.0);
    }

    #[test]
    fn lost_packets_are_columns_without_measurements() {
        let lost = 95..98;
        let whole = turns(&mut node(0.0), (0..160).map(packet));
        let some = turns(&mut node(0.0), (0..160).filter(|number| !lost.contains(number)).map(packet));
        assert_eq!((some.len(), some[0].columns(), some[0].stamp), (1, COLUMNS, whole[0].stamp));
        let missing = some[0].points().iter().filter(|point| !point.is_measured()).count();
        assert_eq!(missing, 3 * FIRINGS * LASERS);
        let most = |a: &f32, b: &f32| (a - b).abs() < 3e-6;
        assert!(some[0].times().iter().zip(whole[0].times()).all(|(a, b)| most(a, b)));
        // Half of a second is longer than any turn.
        assert_eq!(turns(&mut node(0.0), (0..100).chain(500..560).map(packet)).len(), 0);
    }

    #[test]
    fn turns_of_one_token_follow_each_other() {
        let (mut node, mut sent) = (node(0.0), vec![]);
        let all = VelodynePackets { packets: (0..400).map(packet).collect() };
        for packets in [Some(&all), None, None, None, None, None] {
            let mut out = Out::new();
            node.process(packets, &mut out);
            sent.extend(out.get().map(|turn: &RingCloud| turn.stamp));
        }
        let expected: Vec<i64> =
            (2..=5).map(|turn| 100_000_000 + turn * COLUMNS as i64 * Firing::NANOS as i64).collect();
        assert_eq!(sent.len(), 4);
        assert!(sent.iter().zip(expected).all(|(stamp, end)| (stamp.as_nanos() - end).abs() < 2), "{sent:?}");
    }

    #[test]
    fn near_points_and_absent_ones_are_not_measured() {
        let near = |number: usize| {
            let azimuth = |block: usize| (STEP * (FIRINGS * number + 2 * block) % 36_000) as u16;
            let micros = number as i64 * DURATION / 1000;
            let bytes = bytes((0x38, micros as u32), azimuth, |_, _, laser| ([0, 200, 300][laser % 3], 7));
            VelodynePacket::new(Time::ZERO, &bytes).expect("a packet")
        };
        let turn = turns(&mut node(0.0), (0..160).map(near)).remove(0);
        for (i, point) in turn.points().iter().enumerate() {
            assert_eq!(point.is_measured(), laser_of(i % LASERS) % 3 == 2);
        }
        assert!(node(0.0).measures(Echo { distance: 0.5, reflectivity: 0 }));
    }

    #[test]
    fn a_scanner_that_stands_or_jumps_fills_no_memory() {
        let mut node = node(0.0);
        let still = |number: usize| {
            let bytes = bytes((0x38, number as u32 * 1327), |_| 5, |_, _, _| (500, 7));
            VelodynePacket::new(Time::ZERO, &bytes).expect("a packet")
        };
        assert!(turns(&mut node, (0..160).chain(160..400).map(packet).chain((0..500).map(still))).len() <= 4);
        assert!(node.turn.columns() <= MAX_COLUMNS && node.nanos.len() <= MAX_COLUMNS);
        let wild = |number: usize| {
            let bytes = bytes((0x38, 0), |block| [35_999, 3][block % 2], |_, _, _| (500, number as u8));
            VelodynePacket::new(Time::ZERO, &bytes).expect("a packet")
        };
        let all = VelodynePackets { packets: (0..2000).map(wild).collect() };
        node.process(Some(&all), &mut Out::new());
        assert!(node.ready.is_empty(), "no turn has two columns");
    }
}
