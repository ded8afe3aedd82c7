use apex_rt::{bytes::ByteStream, prelude::*};

/// Runs a program for a second, and sends what it does over a serial line.
pub fn drive<P: Program>(mut program: P, uart: fn(&[u8])) {
    let mut stream = ByteStream::new(uart);
    stream.describe(&program);
    for ms in 0..1000 {
        let now = Time::from_millis(ms);
        stream.before_reaction(now, &mut program);
        program.react_with(now, &mut stream);
    }
}
