//! Connection to an editor by standard input and output. An invalid message does not end the server.

use crate::{
    frames::{Frame, Frames},
    serve::{PATIENCE, serve},
};
use crossbeam_channel::{Sender, bounded};
use lsp_server::{Connection, ErrorCode, Message};
use serde_json::{Value, json};
use std::{
    io::{self, Read, Write as _},
    thread,
    time::Duration,
};

/// Capacity of the channels between the streams and the server.
const MESSAGES: usize = 64;
/// Time limit for the last messages to an editor that disconnects.
const FAREWELL: Duration = Duration::from_secs(1);

/// Serves an editor on standard input and output until it disconnects. Returns `true` if the shutdown followed the
/// protocol.
///
/// # Errors
/// Fails if standard input cannot be read, or if a thread cannot be started.
pub fn stdio() -> Result<bool, String> {
    let (incoming, receiver) = bounded(MESSAGES);
    let (sender, outgoing) = bounded::<Message>(MESSAGES);
    let (finished, end) = bounded::<()>(0);
    let connection = Connection { sender, receiver };
    let no_thread = |e: io::Error| format!("cannot start a thread: {e}");
    let writer = move || {
        // A closed connection is detected by the reader.
        let _ = outgoing.into_iter().try_for_each(|message| message.write(&mut io::stdout().lock()));
        drop(finished);
    };
    thread::Builder::new().name("apex-write".to_owned()).spawn(writer).map_err(no_thread)?;
    let reader = move || read(io::stdin().lock(), &incoming);
    let reader = thread::Builder::new().name("apex-read".to_owned()).spawn(reader).map_err(no_thread)?;
    let orderly = serve(&connection, PATIENCE);
    drop(connection);
    // A running check keeps the channel open.
    let _ = end.recv_timeout(FAREWELL);
    // The reader ends with the input, after `exit`, or when the server has ended.
    match reader.join() {
        Ok(Err(error)) => Err(format!("the messages of the editor cannot be read: {error}")),
        _ => Ok(orderly),
    }
}

/// Passes messages on until the editor disconnects. Answers invalid messages itself.
fn read(input: impl Read, incoming: &Sender<Message>) -> io::Result<()> {
    let mut frames = Frames::new(input);
    while let Some(frame) = frames.next()? {
        let body = match frame {
            Frame::Body(body) => body,
            Frame::Broken(reason) => {
                refuse(&Refused { id: Value::Null, code: ErrorCode::InvalidRequest, reason });
                continue;
            }
        };
        match message(&body) {
            Ok(message) => {
                let leaves = matches!(&message, Message::Notification(n) if n.method == "exit");
                if incoming.send(message).is_err() || leaves {
                    break;
                }
            }
            Err(refused) => {
                let is_json = !matches!(refused.code, ErrorCode::ParseError);
                refuse(&refused);
                if !is_json {
                    frames.give_back(body);
                }
            }
        }
    }
    Ok(())
}

/// An invalid message.
struct Refused {
    /// Id, if it could be read.
    id: Value,
    code: ErrorCode,
    reason: String,
}

/// Answers with an error. The id may be unknown, which `lsp_server` does not support.
fn refuse(refused: &Refused) {
    let error = json!({ "code": refused.code as i32, "message": refused.reason });
    let body = json!({ "jsonrpc": "2.0", "id": refused.id, "error": error }).to_string();
    let mut output = io::stdout().lock();
    let _ = write!(output, "Content-Length: {}\r\n\r\n{body}", body.len()).and_then(|()| output.flush());
}

/// Parses the message in a body. Invalid characters (bytes that are not UTF-8, halves of surrogate pairs) are replaced.
/// If such a message were dropped, the text would differ from that in the editor.
fn message(body: &[u8]) -> Result<Message, Refused> {
    let text = String::from_utf8_lossy(body);
    if let Ok(message) = serde_json::from_str(&text) {
        return Ok(message);
    }
    let text = with_whole_pairs(&text);
    let value: Value = serde_json::from_str(&text).map_err(|error| Refused {
        id: Value::Null,
        code: ErrorCode::ParseError,
        reason: format!("a message that is not JSON: {error}"),
    })?;
    let id = value.get("id").filter(|id| id.is_number() || id.is_string()).cloned().unwrap_or_default();
    serde_json::from_value(value).map_err(|_| Refused {
        id,
        code: ErrorCode::InvalidRequest,
        reason: "neither a request (`id`, `method`) nor a notification (`method`) nor a response (`id`, `result`)"
            .to_owned(),
    })
}

/// Replaces halves of surrogate pairs in JSON by the replacement character.
fn with_whole_pairs(json: &str) -> String {
    let mut whole = String::with_capacity(json.len());
    let mut rest = json;
    while let Some(at) = rest.find('\\') {
        whole.push_str(&rest[..at]);
        rest = &rest[at..];
        let length = match (unit(rest), rest.get(6..).and_then(unit)) {
            (Some(0xd800..=0xdbff), Some(0xdc00..=0xdfff)) => 12,
            (Some(0xd800..=0xdfff), _) => {
                whole.push_str("\\ufffd");
                rest = &rest[6..];
                continue;
            }
            (Some(_), _) => 6,
            // The escaped character may be another backslash.
            (None, _) => 1 + rest[1..].chars().next().map_or(0, char::len_utf8),
        };
        whole.push_str(&rest[..length]);
        rest = &rest[length..];
    }
    whole.push_str(rest);
    whole
}

/// UTF-16 code unit at the start of a text, written as `\u12ab`.
fn unit(text: &str) -> Option<u16> {
    let digits = text.strip_prefix("\\u")?.get(..4)?;
    digits.bytes().all(|b| b.is_ascii_hexdigit()).then(|| u16::from_str_radix(digits, 16).ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_of_pairs() {
        for (json, whole) in [
            (r"a\ud83d\ude00b", r"a\ud83d\ude00b"),
            (r"a\ud83db", r"a\ufffdb"),
            (r"\ude00\ud83d", r"\ufffd\ufffd"),
            (r"\ud83d\ud83d\ude00", r"\ufffd\ud83d\ude00"),
            (r"\\ud83d\n\u00fc", r"\\ud83d\n\u00fc"),
            (r"\ud8", r"\ud8"),
            ("\\ü\\", "\\ü\\"),
        ] {
            assert_eq!(with_whole_pairs(json), whole);
        }
    }

    #[test]
    fn what_is_no_message_is_refused() {
        let refused = |body: &str| message(body.as_bytes()).err().map(|r| (r.id, r.code as i32));
        assert_eq!(refused("{"), Some((Value::Null, -32700)));
        assert_eq!(refused(&"[".repeat(100_000)), Some((Value::Null, -32700)));
        assert_eq!(refused("[]"), Some((Value::Null, -32600)));
        assert_eq!(refused(r#"{"id":7}"#), Some((json!(7), -32600)));
        assert_eq!(refused(r#"{"id":1e99,"method":"x"}"#), None);
        assert_eq!(refused(r#"{"method":"x","params":["\ud800"]}"#), None);
        assert!(message(b"{\"method\":\"\xff\"}").is_ok());
    }
}
