//! Sockets of the machine's network and, on Unix, of the file system.

use super::message;
use core::time::Duration;
use std::{
    boxed::Box,
    env, fs,
    io::{self, Read, Write},
    net::TcpStream,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    vec::Vec,
};
#[cfg(feature = "studio")]
use std::{
    format,
    net::TcpListener,
    path::PathBuf,
    string::{String, ToString as _},
};

/// Environment variable of robots and of those who look at them, with the token that admits viewers.
pub const TOKEN: &str = "APEX_STUDIO_TOKEN";
/// Time between two looks whether a connection is to be closed.
const LOOK: Duration = Duration::from_millis(200);
/// Time in which a robot has to take what is sent to it.
const PATIENCE: Duration = Duration::from_secs(5);

/// A connection to a viewer.
#[cfg(feature = "studio")]
pub trait Wire: Read + Write + Send {}

#[cfg(feature = "studio")]
impl<T: Read + Write + Send> Wire for T {}

/// A socket that waits for viewers.
#[cfg(feature = "studio")]
pub enum Listener {
    Tcp(TcpListener),
    #[cfg(unix)]
    File(std::os::unix::net::UnixListener, PathBuf),
}

#[cfg(feature = "studio")]
impl Listener {
    /// Opens a socket at `address`: `HOST:PORT`, or the path of a file, which has a `/`.
    pub fn open(address: &str) -> io::Result<Self> {
        let listener = match path(address) {
            #[cfg(unix)]
            Some(path) => {
                // A file of an earlier run would be in the way.
                if std::os::unix::net::UnixStream::connect(path).is_err() {
                    let _ = fs::remove_file(path);
                }
                let listener = std::os::unix::net::UnixListener::bind(path)?;
                // Only the user who runs the robot may connect.
                fs::set_permissions(path, std::os::unix::fs::PermissionsExt::from_mode(0o600))?;
                listener.set_nonblocking(true)?;
                Self::File(listener, path.to_owned())
            }
            #[cfg(not(unix))]
            Some(_) => return Err(io::Error::new(io::ErrorKind::Unsupported, "choose an address `HOST:PORT`")),
            None => {
                let listener = TcpListener::bind(address)?;
                listener.set_nonblocking(true)?;
                Self::Tcp(listener)
            }
        };
        Ok(listener)
    }

    /// Returns the next connection, if there is one, with its address. Connections to a file have none but their
    /// `number`.
    pub fn accept(&self, number: u64) -> io::Result<(String, Box<dyn Wire>)> {
        match self {
            Self::Tcp(listener) => {
                let (stream, from) = listener.accept()?;
                stream.set_nonblocking(true)?;
                stream.set_nodelay(true)?;
                Ok((from.to_string(), Box::new(stream)))
            }
            #[cfg(unix)]
            Self::File(listener, _) => {
                let (stream, _) = listener.accept()?;
                stream.set_nonblocking(true)?;
                Ok((format!("{number} of this machine"), Box::new(stream)))
            }
        }
    }

    /// `true` if other machines may reach it.
    pub fn is_public(&self) -> bool {
        match self {
            Self::Tcp(listener) => {
                listener.local_addr().map_or(true, |address| !address.ip().to_canonical().is_loopback())
            }
            #[cfg(unix)]
            Self::File(..) => false,
        }
    }

    /// Returns the address, with the port that the system has chosen.
    pub fn address(&self) -> String {
        match self {
            Self::Tcp(listener) => listener.local_addr().map_or_else(|e| format!("({e})"), |a| a.to_string()),
            #[cfg(unix)]
            Self::File(_, path) => path.display().to_string(),
        }
    }
}

#[cfg(feature = "studio")]
impl Drop for Listener {
    fn drop(&mut self) {
        #[cfg(unix)]
        if let Self::File(_, path) = self {
            let _ = fs::remove_file(path);
        }
    }
}

/// Connects to a robot at `address`: `HOST:PORT`, or the path of a socket or a serial device. The token in the
/// environment variable `APEX_STUDIO_TOKEN` is sent to it, if there is one. After `bytes:`, the address is that of a
/// stream of bytes that may be joined in the middle ([`ByteStream`](crate::bytes::ByteStream)): everything before the
/// next description of the robot is skipped, and no commands are sent. Returns a reader and a writer.
///
/// # Errors
/// There is none.
pub fn connect(address: &str) -> io::Result<Wires> {
    connect_until(address, Arc::default())
}

/// Connects as [`connect`] does. The reader of a socket is at its end when `closed` has become `true`; a writer
/// gives up after some seconds in which the robot takes nothing.
///
/// # Errors
/// There is none.
pub fn connect_until(address: &str, closed: Arc<AtomicBool>) -> io::Result<Wires> {
    let (address, is_bytes) = address.strip_prefix("bytes:").map_or((address, false), |address| (address, true));
    let (from, mut to) = open(address, closed)?;
    if is_bytes {
        // Whatever comes from here lets the robot describe itself.
        to.write_all(&[0])?;
        return Ok((Box::new(message::Joined::new(from)), Box::new(io::sink())));
    }
    if let Some(token) = env::var_os(TOKEN).filter(|token| !token.is_empty()) {
        let mut bytes = Vec::new();
        message::write(&message::Command::Token(token.to_string_lossy().into_owned()), &mut bytes);
        to.write_all(&bytes)?;
    }
    Ok((from, to))
}

/// A reader and a writer.
type Wires = (Box<dyn Read + Send>, Box<dyn Write + Send>);

/// A socket whose reads have a limited time, until it is closed from this side.
struct Patient<R> {
    from: R,
    closed: Arc<AtomicBool>,
}

impl<R: Read> Read for Patient<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            if self.closed.load(Ordering::Acquire) {
                return Ok(0);
            }
            match self.from.read(into) {
                Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {}
                result => return result,
            }
        }
    }
}

fn open(address: &str, closed: Arc<AtomicBool>) -> io::Result<Wires> {
    match path(address) {
        #[cfg(unix)]
        Some(path) if is_device(path) => {
            let file = fs::File::options().read(true).write(true).open(path)?;
            Ok((Box::new(file.try_clone()?), Box::new(file)))
        }
        #[cfg(unix)]
        Some(path) => {
            let stream = std::os::unix::net::UnixStream::connect(path)?;
            stream.set_read_timeout(Some(LOOK))?;
            stream.set_write_timeout(Some(PATIENCE))?;
            Ok((Box::new(Patient { from: stream.try_clone()?, closed }), Box::new(stream)))
        }
        #[cfg(not(unix))]
        Some(_) => Err(io::Error::new(io::ErrorKind::Unsupported, "choose an address `HOST:PORT`")),
        None => {
            let stream = TcpStream::connect(address)?;
            stream.set_nodelay(true)?;
            stream.set_read_timeout(Some(LOOK))?;
            stream.set_write_timeout(Some(PATIENCE))?;
            Ok((Box::new(Patient { from: stream.try_clone()?, closed }), Box::new(stream)))
        }
    }
}

#[cfg(unix)]
fn is_device(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt as _;
    fs::metadata(path).is_ok_and(|file| file.file_type().is_char_device())
}

/// Returns the path, if the address is one.
fn path(address: &str) -> Option<&Path> {
    address.contains(['/', '\\']).then(|| Path::new(address))
}
