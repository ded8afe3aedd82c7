//! Runs peers on request. First it writes a line `graph peer` for each of its peers, and an empty line. For each line
//! `graph peer ticks` that it then reads, it writes `nanoseconds checksum`.

use apex_peers::{PEERS, Ran};
use std::io::{self, BufRead, Write};

fn main() -> io::Result<()> {
    let mut out = io::stdout();
    for peer in PEERS {
        writeln!(out, "{} {}", peer.graph, peer.name)?;
    }
    writeln!(out)?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let Ran { time, checksum } = run(&line).ok_or_else(|| io::Error::other(format!("cannot run `{line}`")))?;
        writeln!(out, "{} {checksum}", time.as_nanos())?;
    }
    Ok(())
}

fn run(line: &str) -> Option<Ran> {
    let mut words = line.split(' ');
    let (graph, name, ticks) = (words.next()?, words.next()?, words.next()?.parse().ok()?);
    let peer = PEERS.iter().find(|peer| peer.graph == graph && peer.name == name)?;
    Some((peer.run)(ticks))
}
