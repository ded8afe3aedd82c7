//! Addresses of files.

use lsp_types::Uri;
use std::{
    path::{Path, PathBuf},
    str::FromStr as _,
};

/// Path for an address. An address that is not a file is used as a path itself.
pub fn to_path(uri: &Uri) -> PathBuf {
    let text = uri.as_str();
    let Some(rest) = text.strip_prefix("file://") else { return PathBuf::from(text) };
    // The two slashes are followed by a host, which is empty or this machine.
    let path = rest.find('/').map_or("/", |slash| &rest[slash..]);
    let path = decoded(path);
    // `/c:/folder` on Windows.
    let is_drive = path.as_bytes().get(2) == Some(&b':') && path.as_bytes()[1].is_ascii_alphabetic();
    PathBuf::from(if is_drive { &path[1..] } else { &path })
}

/// Address of a file.
pub fn from_path(path: &Path) -> Option<Uri> {
    let text = path.to_str()?;
    if !path.is_absolute() {
        return Uri::from_str(text).ok();
    }
    let mut uri = String::from("file://");
    if !text.starts_with('/') {
        uri.push('/');
    }
    for byte in text.bytes() {
        match byte {
            b'\\' if cfg!(windows) => uri.push('/'),
            b'/' | b'-' | b'_' | b'.' | b'~' | b':' => uri.push(byte as char),
            _ if byte.is_ascii_alphanumeric() => uri.push(byte as char),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
    }
    Uri::from_str(&uri).ok()
}

/// Decodes `%20` and other escapes.
fn decoded(text: &str) -> String {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).and_then(|b| (*b as char).to_digit(16));
    let (mut out, mut at) = (vec![], 0);
    while at < bytes.len() {
        match (bytes[at], digit(at + 1), digit(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((high * 16 + low) as u8);
                at += 3;
            }
            (byte, ..) => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn there_and_back() {
        for path in ["/a/b.afg", "/a b/ü%20#?.afg"] {
            assert_eq!(to_path(&from_path(Path::new(path)).unwrap()), Path::new(path));
        }
        assert_eq!(to_path(&Uri::from_str("file:///a%2Fb").unwrap()), Path::new("/a/b"));
        assert_eq!(to_path(&Uri::from_str("untitled:one").unwrap()), Path::new("untitled:one"));
    }
}
