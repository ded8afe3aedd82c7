//! The bridge to the drivers: nodes that receive and send datagrams. Their form is in the README.

use apex_nodes::{
    nav::Twist,
    scan::{Pose2, Ranges, Scan},
};
use apex_rt::prelude::*;
use std::{
    io::{self, ErrorKind},
    net::UdpSocket,
};

/// Most datagrams that are read at once: the mission goes on, whatever comes.
const MOST: usize = 100;
/// Largest datagram, in bytes; UDP has no larger ones.
const LARGEST: usize = 1 << 16;

/// Contents of a datagram of the drivers.
#[derive(Debug, PartialEq)]
enum Datagram {
    Odometry(Pose2),
    Scan(Scan),
}

impl Datagram {
    /// Reads a datagram that arrives at the time `now`; `None` if it is none of the drivers.
    fn read(bytes: &[u8], now: Time) -> Option<Self> {
        let text = str::from_utf8(bytes).ok()?;
        let mut words = text.split_ascii_whitespace();
        let kind = words.next()?;
        let numbers: Vec<f32> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
        let are_finite = |numbers: &[f32]| numbers.iter().all(|number| number.is_finite());
        match (kind, &numbers[..]) {
            ("odometry", [x, y, theta]) if are_finite(&numbers) => {
                Some(Self::Odometry(Pose2 { x: *x, y: *y, theta: *theta }))
            }
            ("scan", [angle_min, angle_increment, range_min, range_max, beams @ ..]) if are_finite(&numbers[..4]) => {
                let mut ranges = Ranges::new();
                beams.iter().try_for_each(|range| ranges.push(*range)).ok()?;
                Some(Self::Scan(Scan {
                    angle_min: *angle_min,
                    angle_increment: *angle_increment,
                    range_min: *range_min,
                    range_max: *range_max,
                    stamp: now,
                    ranges,
                    ..Scan::default()
                }))
            }
            _ => None,
        }
    }
}

/// Receives the datagrams of the drivers. Of several ones of a kind, the newest counts. Bad ones are counted; `bad`
/// says so at most once in a second.
#[node]
#[derive(Default)]
pub struct Receive {
    /// Address at which the drivers send.
    #[param]
    listen: &'static str,
    socket: Option<UdpSocket>,
    bad: u64,
    /// Number of bad datagrams that was reported, and the time of the report.
    told: (u64, Option<Time>),
    last_bad: String,
}

#[node]
impl Receive {
    fn process(
        &mut self,
        ctx: &Ctx,
        odometry: Event<Pose2>,
        scan: Event<Scan>,
        bad: Event<String>,
    ) -> Result<(), String> {
        let (pose, sweep) = self.read(ctx.now()).map_err(|error| format!("{}: {error}", self.listen))?;
        if let Some(pose) = pose {
            odometry.emit(pose);
        }
        if let Some(sweep) = sweep {
            scan.emit(sweep);
        }
        let (told, at) = self.told;
        if self.bad > told && at.is_none_or(|at| ctx.now().since(at).as_secs_f32() >= 1.0) {
            self.told = (self.bad, Some(ctx.now()));
            bad.emit(format!("{} bad datagrams, the last one: {:?}", self.bad, self.last_bad));
        }
        Ok(())
    }

    /// Reads what has come since the last time.
    fn read(&mut self, now: Time) -> io::Result<(Option<Pose2>, Option<Scan>)> {
        let (mut pose, mut scan, mut bytes) = (None, None, [0; LARGEST]);
        for _ in 0..MOST {
            let length = match socket(&mut self.socket, self.listen)?.recv(&mut bytes) {
                Ok(length) => length,
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                // A message of the network about an earlier datagram.
                Err(_) => continue,
            };
            match Datagram::read(&bytes[..length], now) {
                Some(Datagram::Odometry(read)) => pose = Some(read),
                Some(Datagram::Scan(read)) => scan = Some(read),
                None => {
                    self.bad += 1;
                    self.last_bad = String::from_utf8_lossy(&bytes[..length]).chars().take(40).collect();
                }
            }
        }
        Ok((pose, scan))
    }
}

/// Sends twists to the drivers.
#[node]
#[derive(Default)]
pub struct Send {
    /// Address at which the drivers listen.
    #[param]
    to: &'static str,
    socket: Option<UdpSocket>,
}

#[node]
impl Send {
    /// Sends a twist.
    #[slot]
    fn twist(&mut self, twist: &Twist) -> Result<(), String> {
        let text = format!("twist {} {} {}", twist.x, twist.y, twist.omega);
        let socket = socket(&mut self.socket, "127.0.0.1:0").map_err(|error| error.to_string())?;
        // Drivers that do not listen yet, or not any more, hear the next one.
        let _ = socket.send_to(text.as_bytes(), self.to);
        Ok(())
    }

    /// Stops the base when the program ends.
    #[on_stop]
    fn stop(&mut self) {
        let _ = self.twist(&Twist::ZERO);
    }
}

/// The socket, which is opened at this address when it is first needed.
fn socket<'a>(open: &'a mut Option<UdpSocket>, address: &str) -> io::Result<&'a UdpSocket> {
    match open {
        Some(socket) => Ok(socket),
        None => {
            let socket = UdpSocket::bind(address)?;
            socket.set_nonblocking(true)?;
            Ok(open.insert(socket))
        }
    }
}

/// Prints a text.
#[node]
pub fn tell(text: &String) {
    eprintln!("{text}");
}

/// Scan of open space, for tests.
#[node]
pub fn open_space(ctx: &Ctx) -> Option<Scan> {
    let Datagram::Scan(scan) = Datagram::read(b"scan -1 1 0.05 20 inf inf inf", ctx.now())? else { return None };
    Some(scan)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn datagrams_are_read() {
        let read = |text: &str| Datagram::read(text.as_bytes(), Time::from_millis(5));
        assert_eq!(read("odometry 1 -2.5 0"), Some(Datagram::Odometry(Pose2 { x: 1.0, y: -2.5, theta: 0.0 })));
        let Some(Datagram::Scan(scan)) = read("scan -1 0.5 0.1 20 1.5 inf nan") else { panic!() };
        assert_eq!((scan.ranges.len(), scan.range(0), scan.stamp), (3, Some(1.5), Time::from_millis(5)));
    }

    #[test]
    fn bad_datagrams_are_refused() {
        let many = format!("scan -1 0.5 0.1 20{}", " 1".repeat(70_000));
        let texts = ["", " ", "odometry", "odometry 1 2", "odometry 1 2 x", "odometry nan 0 0", "odometry 1 2 3 4"];
        let others = ["scan 1 2", "scan inf 0 0 1 1", "twist 0 0 0", "ODOMETRY 0 0 0", &many];
        for text in texts.into_iter().chain(others) {
            assert_eq!(Datagram::read(text.as_bytes(), Time::ZERO), None, "{text:.40}");
        }
        assert_eq!(Datagram::read(b"odometry \xff 0 0", Time::ZERO), None);
    }
}
