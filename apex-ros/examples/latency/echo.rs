//! Common parts of the latencies over Zenoh and over DDS: the program, what a plain program does in its place, the
//! measurement, and what is printed.

use apex_macros::graph;
use apex_messages::{
    Message as _,
    cdr::{Outside, Reader, Writer},
};
use apex_nodes::scan::Scan;
use apex_rt::prelude::*;
use std::{
    sync::mpsc::Receiver,
    thread,
    time::{Duration, Instant},
};

/// Sends back a scan.
#[node]
#[derive(Default)]
#[allow(non_camel_case_types, reason = "as a function")]
pub struct back;

#[node]
impl back {
    /// Sends a scan back.
    #[slot]
    fn put(&mut self, scan: &Scan, sent: Event<Scan>) {
        sent.emit(scan.clone());
    }
}

graph!("latency.afg");

/// Measured messages of each round, and rounds of each program.
const MESSAGES: usize = 2000;
pub const ROUNDS: usize = 5;
/// Beams of a scan.
const BEAMS: usize = 720;

/// The scan that is sent, as a message.
pub fn ping() -> Vec<u8> {
    Scan { ranges: (0..BEAMS).map(|i| i as f32).collect(), ..Scan::default() }.to_bytes()
}

/// The answer of a plain program, which decodes and encodes the scan.
pub fn answer(bytes: &[u8]) -> Vec<u8> {
    let scan = Scan::read(&mut Reader::new(bytes).expect("CDR").since(5)).expect("a scan");
    let mut bytes = vec![];
    scan.write(&mut Writer::new(&mut bytes).for_others(Outside { zero: 5, now: 5, frame: None }));
    bytes
}

/// Times of a round of round trips, in µs. `pongs` has the instants at which answers come.
pub fn measure(send: impl Fn(), pongs: &Receiver<Instant>) -> Vec<f64> {
    let mut times = vec![];
    while times.len() < MESSAGES {
        let start = Instant::now();
        send();
        if let Ok(end) = pongs.recv_timeout(Duration::from_secs(1)) {
            times.push((end - start).as_secs_f64() * 1e6);
        }
        thread::sleep(Duration::from_micros(500));
    }
    times
}

/// Prints the median and the 99th percentile of the times of a program.
pub fn print(name: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let at = |part: f64| times[(part * times.len() as f64) as usize];
    println!("{name:13} p50 {:6.0} µs   p99 {:6.0} µs   ({} round trips)", at(0.5), at(0.99), times.len());
}
