//! Sockets for tests, on which a call goes on that the system interrupted.
//!
//! A read with a time-out is interrupted whenever the machine is paused, or the process is stopped and goes on, even
//! where no signal has a handler (signal(7)). The standard library tries again in `read_exact` and `write_all` alone.

use std::{
    io::{ErrorKind, Read, Result, Write},
    net::TcpStream,
};

/// A stream whose calls are never interrupted.
pub struct Steady<S = TcpStream>(pub S);

/// Makes a call of the system again until it is not interrupted.
pub fn steadily<T>(mut call: impl FnMut() -> Result<T>) -> Result<T> {
    loop {
        match call() {
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            result => return result,
        }
    }
}

impl<S: Read> Read for Steady<S> {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        steadily(|| self.0.read(into))
    }
}

impl<S: Write> Write for Steady<S> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        steadily(|| self.0.write(bytes))
    }

    fn flush(&mut self) -> Result<()> {
        steadily(|| self.0.flush())
    }
}

#[test]
fn a_call_that_is_interrupted_goes_on() {
    struct Shaken(u8);
    impl Read for Shaken {
        fn read(&mut self, into: &mut [u8]) -> Result<usize> {
            self.0 += 1;
            if self.0 < 4 {
                return Err(ErrorKind::Interrupted.into());
            }
            into[0] = self.0;
            Ok(1)
        }
    }
    let mut byte = [0];
    assert_eq!(Steady(Shaken(0)).read(&mut byte).expect("a byte"), 1);
    assert_eq!(byte, [4]);
}
