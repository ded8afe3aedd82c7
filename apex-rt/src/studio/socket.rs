//! Sockets of the machine's network and, on Unix, of the file system.

use super::message;
use std::{
    boxed::Box,
    fs,
    io::{self, Read, Write},
    net::TcpStream,
    path::Path,
};
#[cfg(feature = "studio")]
use std::{
    format,
    net::TcpListener,
    path::PathBuf,
    string::{String, ToString as _},
};

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

    /// Returns the next connection, if there is one.
    pub fn accept(&self) -> io::Result<Box<dyn Wire>> {
        match self {
            Self::Tcp(listener) => {
                let (stream, _) = listener.accept()?;
                stream.set_nonblocking(true)?;
                stream.set_nodelay(true)?;
                Ok(Box::new(stream))
            }
            #[cfg(unix)]
            Self::File(listener, _) => {
                let (stream, _) = listener.accept()?;
                stream.set_nonblocking(true)?;
                Ok(Box::new(stream))
            }
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

/// Connects to a robot at `address`: `HOST:PORT`, or the path of a socket or a serial device. After `bytes:`, it is a
/// stream of bytes that may be joined in the middle ([`ByteStream`](crate::bytes::ByteStream)): everything before the
/// next description of the robot is skipped, and no commands are sent. Returns a reader and a writer.
///
/// # Errors
/// There is none.
pub fn connect(address: &str) -> io::Result<(Box<dyn Read + Send>, Box<dyn Write + Send>)> {
    let Some(address) = address.strip_prefix("bytes:") else { return open(address) };
    let (from, mut to) = open(address)?;
    // Whatever comes from here lets the robot describe itself.
    to.write_all(&[0])?;
    Ok((Box::new(message::Joined::new(from)), Box::new(io::sink())))
}

fn open(address: &str) -> io::Result<(Box<dyn Read + Send>, Box<dyn Write + Send>)> {
    match path(address) {
        #[cfg(unix)]
        Some(path) if is_device(path) => {
            let file = fs::File::options().read(true).write(true).open(path)?;
            Ok((Box::new(file.try_clone()?), Box::new(file)))
        }
        #[cfg(unix)]
        Some(path) => {
            let stream = std::os::unix::net::UnixStream::connect(path)?;
            Ok((Box::new(stream.try_clone()?), Box::new(stream)))
        }
        #[cfg(not(unix))]
        Some(_) => Err(io::Error::new(io::ErrorKind::Unsupported, "choose an address `HOST:PORT`")),
        None => {
            let stream = TcpStream::connect(address)?;
            stream.set_nodelay(true)?;
            Ok((Box::new(stream.try_clone()?), Box::new(stream)))
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
