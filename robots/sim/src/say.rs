use std::io::{self, Write as _};

/// Writes a text to the standard output. A pipe that was closed is not an error, so that a table can be cut off by
/// other commands.
///
/// # Errors
/// If the text cannot be written.
pub fn say(text: &str) -> Result<(), String> {
    let mut output = io::stdout();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write the output: {e}")),
        _ => Ok(()),
    }
}
