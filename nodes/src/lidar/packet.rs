//! Data packet of the VLP-16. Sections are those of its user manual (63-9243).

use apex_rt::Time;
use core::{
    f32::consts::{PI, TAU},
    fmt,
};
use libm::sincosf;

/// Size of a data packet, in bytes (9.3.2).
pub const PACKET: usize = 1206;
/// Number of lasers.
pub const LASERS: usize = 16;

/// Number of data blocks of a packet, and size of each, in bytes.
const BLOCKS: usize = 12;
const BLOCK: usize = 100;
/// First bytes of a block.
const FLAG: [u8; 2] = [0xff, 0xee];
/// Size of the measurement of a laser, in bytes.
const POINT: usize = 3;
/// Number of firings of a block.
const FIRINGS: usize = 2;
/// Hundredths of a degree in a turn.
const CENTIDEGREES: u16 = 36_000;
/// Radians in a hundredth of a degree.
const RADIANS: f32 = TAU / CENTIDEGREES as f32;
/// Largest angle between two blocks that is not a gap: at 20 turns in a second it is 0.8°.
const LARGEST_STEP: u16 = 100;
/// Unit of distances, in m (9.3.1).
const UNIT: f32 = 0.002;
/// Time from a firing to the next one, and from a laser to the next one, in ns (9.4).
const FIRING: u32 = 55_296;
const LASER: u32 = 2_304;
/// Time after which the clock of the scanner begins again, in ns (9.3.1).
#[cfg(feature = "std")]
const HOUR: u64 = 3_600_000_000_000;
/// Bytes that say which returns are measured, and which scanner it is (9.3.1).
const STRONGEST: u8 = 0x37;
const LAST: u8 = 0x38;
const DUAL: u8 = 0x39;
const VLP16: u8 = 0x22;

/// Data packet of a VLP-16: 24 firings of its 16 lasers, or 12 of them with two returns each.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct VelodynePacket {
    /// Time at which it came, right after its last firing.
    pub stamp: Time,
    bytes: [u8; PACKET],
}

/// Firing of all lasers, one after the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Firing {
    /// Time of the first laser by the clock of the scanner, in ns since the full hour.
    pub nanos: u64,
    /// Direction of the first laser, in rad from 0 to 2π, clockwise from the x axis, seen from above.
    pub azimuth: f32,
    /// Angle by which the scanner turns until the next firing, in rad.
    pub step: f32,
    /// Last returns of the lasers, in the order in which they fire; the only ones if the scanner sends one of each.
    pub last: [Echo; LASERS],
    /// Strongest returns, or the second strongest ones where the last one is the strongest; the only ones if the
    /// scanner sends one of each. Without a second return it is that in `last`.
    pub other: [Echo; LASERS],
}

/// Return of a laser.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Echo {
    /// Distance, in m; 0 if there was no return.
    pub distance: f32,
    /// Calibrated reflectivity: up to 100 for diffuse surfaces, more for retroreflectors.
    pub reflectivity: u8,
}

/// Reason why bytes are not a data packet of a VLP-16.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PacketError {
    /// It has this number of bytes.
    Size(usize),
    /// Its scanner has this number.
    Scanner(u8),
    /// Its returns have this number.
    Returns(u8),
    /// The block of this number does not begin as one.
    Flag(usize),
    /// The block of this number has this direction, in hundredths of a degree.
    Azimuth(usize, u16),
}

impl fmt::Display for PacketError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(size) => write!(f, "a packet has {size} bytes, and a data packet of a VLP-16 {PACKET}"),
            Self::Scanner(number) => write!(
                f,
                "byte 1205 of a packet is {number:#04x}, and not {VLP16:#04x}: it comes from another scanner than a \
                 VLP-16, whose lasers have other directions"
            ),
            Self::Returns(number) => write!(
                f,
                "byte 1204 of a packet is {number:#04x}, and not {STRONGEST:#04x}, {LAST:#04x} or {DUAL:#04x}: set the \
                 returns of the scanner to strongest, last or dual"
            ),
            Self::Flag(block) => write!(f, "block {block} of a packet does not begin with ff ee: it is damaged"),
            Self::Azimuth(block, azimuth) => {
                write!(f, "the direction of block {block} of a packet is {azimuth}, and not below {CENTIDEGREES}")
            }
        }
    }
}

impl core::error::Error for PacketError {}

impl VelodynePacket {
    /// Packet with these bytes, which came at a time.
    ///
    /// # Errors
    /// If the bytes are not a data packet of a VLP-16.
    pub fn new(stamp: Time, bytes: &[u8]) -> Result<Self, PacketError> {
        let packet = Self { stamp, bytes: bytes.try_into().map_err(|_| PacketError::Size(bytes.len()))? };
        let [.., returns, scanner] = packet.bytes;
        if scanner != VLP16 {
            return Err(PacketError::Scanner(scanner));
        }
        if !matches!(returns, STRONGEST | LAST | DUAL) {
            return Err(PacketError::Returns(returns));
        }
        for block in 0..BLOCKS {
            if packet.bytes[block * BLOCK..].first_chunk() != Some(&FLAG) {
                return Err(PacketError::Flag(block));
            }
            let azimuth = packet.azimuth(block);
            if azimuth >= CENTIDEGREES {
                return Err(PacketError::Azimuth(block, azimuth));
            }
        }
        Ok(packet)
    }

    /// Bytes of the packet.
    pub const fn bytes(&self) -> &[u8; PACKET] {
        &self.bytes
    }

    /// Time of its first firing by the clock of the scanner, in ns since the full hour.
    pub fn nanos(&self) -> u64 {
        let micros = self.bytes[BLOCKS * BLOCK..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes));
        u64::from(micros) * 1000
    }

    /// Time from its first firing to the end of the last one, in ns.
    pub const fn duration(&self) -> u64 {
        let blocks = if self.is_dual() { 2 } else { 1 };
        (BLOCKS / blocks * FIRINGS) as u64 * FIRING as u64
    }

    /// Returns `true` if it has two returns of each laser.
    pub const fn is_dual(&self) -> bool {
        self.bytes[PACKET - 2] == DUAL
    }

    /// Firings in the order of their times.
    ///
    /// The directions between those of the blocks are interpolated (9.5). After the last block the scanner turns as
    /// before. A gap, where the scanner does not measure, does not count as turning.
    pub fn firings(&self) -> impl Iterator<Item = Firing> + '_ {
        let blocks = if self.is_dual() { 2 } else { 1 };
        let mut step = self.first_step(blocks);
        (0..BLOCKS / blocks).flat_map(move |group| {
            step = self.step(group * blocks, blocks).unwrap_or(step);
            let step = step;
            (0..FIRINGS).map(move |firing| self.firing(group, firing, blocks, step))
        })
    }

    /// Firing of a group of blocks with the same directions; `step` is the angle to the next group, in hundredths of a
    /// degree.
    fn firing(&self, group: usize, firing: usize, blocks: usize, step: u16) -> Firing {
        let (block, step) = (group * blocks, 0.5 * f32::from(step));
        let number = group * FIRINGS + firing;
        let azimuth = (f32::from(self.azimuth(block)) + step * firing as f32) * RADIANS;
        Firing {
            nanos: self.nanos() + number as u64 * u64::from(FIRING),
            azimuth: if azimuth < TAU { azimuth } else { azimuth - TAU },
            step: step * RADIANS,
            // Of two returns, the first block has the last one (9.3.1).
            last: core::array::from_fn(|laser| self.echo(block, firing, laser)),
            other: core::array::from_fn(|laser| self.echo(block + blocks - 1, firing, laser)),
        }
    }

    fn echo(&self, block: usize, firing: usize, laser: usize) -> Echo {
        let at = block * BLOCK + FLAG.len() + 2 + (firing * LASERS + laser) * POINT;
        let distance = u16::from_le_bytes([self.bytes[at], self.bytes[at + 1]]);
        Echo { distance: f32::from(distance) * UNIT, reflectivity: self.bytes[at + 2] }
    }

    /// Direction of a block, in hundredths of a degree.
    fn azimuth(&self, block: usize) -> u16 {
        u16::from_le_bytes([self.bytes[block * BLOCK + 2], self.bytes[block * BLOCK + 3]])
    }

    /// Angle from a block to the next group, in hundredths of a degree; `None` if there is none, or a gap.
    fn step(&self, block: usize, blocks: usize) -> Option<u16> {
        let next = (block + blocks < BLOCKS).then(|| self.azimuth(block + blocks))?;
        let before = self.azimuth(block);
        let step = if next < before { CENTIDEGREES - before + next } else { next - before };
        (step <= LARGEST_STEP).then_some(step)
    }

    /// First angle that is not a gap; 0 if there is none.
    fn first_step(&self, blocks: usize) -> u16 {
        (0..BLOCKS).step_by(blocks).find_map(|block| self.step(block, blocks)).unwrap_or(0)
    }
}

/// Shows the time and the kind instead of the bytes.
impl fmt::Debug for VelodynePacket {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VelodynePacket")
            .field("stamp", &self.stamp)
            .field("is_dual", &self.is_dual())
            .finish_non_exhaustive()
    }
}

impl Firing {
    /// Time between two firings, in ns.
    pub const NANOS: u64 = FIRING as u64;

    /// Strongest return of a laser: of two returns, the one with the higher reflectivity.
    pub const fn strongest(&self, laser: usize) -> Echo {
        let (last, other) = (self.last[laser], self.other[laser]);
        if other.reflectivity > last.reflectivity { other } else { last }
    }

    /// Direction of a laser as it fires, in rad clockwise from the x axis; it may be a little more than 2π.
    pub fn azimuth_of(&self, laser: usize) -> f32 {
        self.azimuth + self.step * (laser as u32 * LASER) as f32 / FIRING as f32
    }

    /// Position of a return of a laser, in m in the frame of the scanner: x forward, y to the left, z up.
    ///
    /// The rays meet in the origin. The heights of the lasers above it, up to 11 mm (9.2), are left out, as other
    /// readers of these packets do.
    pub fn position(&self, laser: usize, echo: Echo) -> [f32; 3] {
        let (sin, cos) = sincosf(self.azimuth_of(laser));
        let (up, level) = sincosf(elevation(laser));
        [echo.distance * level * cos, -echo.distance * level * sin, echo.distance * up]
    }
}

/// Time from one time of the scanner to a later one, in ns.
#[cfg(feature = "std")]
pub(super) const fn since(from: u64, to: u64) -> u64 {
    (to % HOUR + HOUR - from % HOUR) % HOUR
}

/// Elevation of a laser, in rad (9.2). Lasers with even numbers look down, others up; they are 2° apart.
pub fn elevation(laser: usize) -> f32 {
    let laser = laser.min(LASERS - 1);
    let degrees = if laser.is_multiple_of(2) { laser as f32 - 15.0 } else { laser as f32 };
    degrees * PI / 180.0
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Bytes of a packet whose blocks (pairs of them with two returns) have these directions, in hundredths of a
    /// degree. `point` gives the distance in units of 2 mm and the reflectivity of block, firing and laser.
    pub(crate) fn bytes(
        (returns, micros): (u8, u32),
        azimuth: impl Fn(usize) -> u16,
        point: impl Fn(usize, usize, usize) -> (u16, u8),
    ) -> Vec<u8> {
        let mut bytes = vec![];
        for block in 0..BLOCKS {
            bytes.extend(FLAG);
            bytes.extend(azimuth(if returns == DUAL { block / 2 } else { block }).to_le_bytes());
            for i in 0..FIRINGS * LASERS {
                let (distance, reflectivity) = point(block, i / LASERS, i % LASERS);
                bytes.extend(distance.to_le_bytes());
                bytes.push(reflectivity);
            }
        }
        bytes.extend(micros.to_le_bytes());
        bytes.extend([returns, VLP16]);
        bytes
    }

    fn packet(bytes: &[u8]) -> VelodynePacket {
        VelodynePacket::new(Time::from_millis(5), bytes).expect("a packet")
    }

    fn degrees(angle: f32) -> f32 {
        angle * 180.0 / PI
    }

    #[test]
    fn directions_and_times_are_those_of_the_manual() {
        let packet = packet(&bytes((STRONGEST, 7), |block| (35_990 + 40 * block as u16) % 36_000, |_, _, _| (500, 9)));
        let firings: Vec<Firing> = packet.firings().collect();
        assert_eq!((firings.len(), packet.duration()), (24, 24 * 55_296));
        // A step is 20 hundredths of a degree, also in the last block.
        for (i, firing) in firings.iter().enumerate() {
            let expected = (359.9 + 0.2 * i as f32) % 360.0;
            assert!((degrees(firing.azimuth) - expected).abs() < 1e-3, "{i}: {firing:?}");
            assert_eq!(firing.nanos, 7_000 + 55_296 * i as u64);
            assert!((degrees(firing.azimuth_of(15) - firing.azimuth) - 0.2 * 34.56 / 55.296).abs() < 1e-3);
            assert!((0.0..TAU).contains(&firing.azimuth));
        }
    }

    #[test]
    fn lasers_have_the_order_of_the_manual() {
        let degrees: Vec<i32> = (0..LASERS).map(|laser| degrees(elevation(laser)).round() as i32).collect();
        assert_eq!(degrees, [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15]);
        let packet = packet(&bytes(
            (LAST, 0),
            |_| 9_000,
            |block, firing, laser| (1000 * block as u16 + 100 * firing as u16 + laser as u16, laser as u8),
        ));
        let firing = packet.firings().nth(3).expect("a firing");
        assert_eq!(firing.last[4], Echo { distance: 1104.0 * 0.002, reflectivity: 4 });
        assert_eq!(firing.last, firing.other);
        // 90° clockwise from the front is to the right.
        let [x, y, z] = firing.position(4, Echo { distance: 2.0, reflectivity: 0 });
        let (up, level) = sincosf(-11.0 * PI / 180.0);
        assert!(x.abs() < 1e-5 && (y + 2.0 * level).abs() < 1e-5 && (z - 2.0 * up).abs() < 1e-5, "{x} {y} {z}");
    }

    #[test]
    fn of_two_returns_the_stronger_and_the_last_one_are_known() {
        // The lasers 0 to 7 have their strongest return last.
        let point = |block: usize, _, laser: usize| match (block.is_multiple_of(2), laser < 8) {
            (true, _) => (2000, 50),
            (false, true) => (1000, 20),
            (false, false) => (1000, 80),
        };
        let packet = packet(&bytes((DUAL, 0), |pair| 100 + 40 * pair as u16, point));
        assert!(packet.is_dual());
        let firings: Vec<Firing> = packet.firings().collect();
        assert_eq!((firings.len(), packet.duration()), (12, 12 * 55_296));
        for (i, firing) in firings.iter().enumerate() {
            assert!((degrees(firing.azimuth) - 1.0 - 0.2 * i as f32).abs() < 1e-3);
            assert_eq!(firing.nanos, 55_296 * i as u64);
            assert_eq!((firing.last[3].distance, firing.last[9].distance), (4.0, 4.0));
            assert_eq!((firing.strongest(3).distance, firing.strongest(9).distance), (4.0, 2.0));
            assert_eq!(firing.other[3].distance, 2.0);
        }
    }

    #[test]
    fn a_gap_is_not_a_step() {
        let gap = |block| if block < 6 { 40 * block as u16 } else { 18_000 + 40 * block as u16 };
        let firings: Vec<Firing> = packet(&bytes((LAST, 0), gap, |_, _, _| (1, 1))).firings().collect();
        assert!(firings.iter().all(|firing| (degrees(firing.step) - 0.2).abs() < 1e-3));
        let still: Vec<Firing> = packet(&bytes((LAST, 0), |_| 77, |_, _, _| (1, 1))).firings().collect();
        assert!(still.iter().all(|firing| firing.step == 0.0 && (degrees(firing.azimuth) - 0.77).abs() < 1e-4));
        let wild = |block| 7_000 * (block as u16 % 5);
        assert!(packet(&bytes((LAST, 0), wild, |_, _, _| (1, 1))).firings().all(|firing| firing.step == 0.0));
    }

    #[test]
    fn other_bytes_are_refused() {
        let whole = bytes((DUAL, u32::MAX), |_| 35_999, |_, _, _| (u16::MAX, u8::MAX));
        assert_eq!(packet(&whole).firings().count(), 12);
        let refused = |bytes: &[u8]| VelodynePacket::new(Time::ZERO, bytes).expect_err("not a packet").to_string();
        for size in [0, 512, 1205] {
            assert_eq!(
                refused(&whole[..size]),
                format!("a packet has {size} bytes, and a data packet of a VLP-16 1206")
            );
        }
        let changed = |at: usize, to: u8| {
            let mut bytes = whole.clone();
            bytes[at] = to;
            refused(&bytes)
        };
        assert!(changed(1205, 0x28).starts_with("byte 1205 of a packet is 0x28, and not 0x22: it comes from another"));
        assert!(changed(1204, 0x00).starts_with("byte 1204 of a packet is 0x00, and not 0x37, 0x38 or 0x39: set"));
        assert_eq!(changed(701, 0xdd), "block 7 of a packet does not begin with ff ee: it is damaged");
        assert_eq!(changed(303, 0xff), "the direction of block 3 of a packet is 65439, and not below 36000");
    }
}
