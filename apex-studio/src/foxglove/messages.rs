//! Messages of the protocol. Numbers in binary ones are little endian.

use axum::extract::ws::Message;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Maximum number of characters of an error message that quotes what an app has sent.
const MAX_WORDS: usize = 300;

/// Numbers of binary messages of an app: tokens, which no robot takes, calls of services, and playback.
const CLIENT_DATA: u8 = 1;
const SERVICE_CALL: u8 = 2;
const PLAYBACK_CONTROL: u8 = 3;

/// Numbers of binary messages to an app.
const MESSAGE_DATA: u8 = 1;
const TIME: u8 = 2;
const PLAYBACK_STATE: u8 = 5;

/// A message of an app in JSON.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub enum Told {
    /// Asks for the tokens of channels.
    Subscribe { subscriptions: Vec<Subscription> },
    /// Asks for them no longer, by the numbers of the subscriptions.
    Unsubscribe { subscription_ids: Vec<u32> },
    /// Asks for parameters; without names, for all.
    GetParameters { parameter_names: Vec<String>, id: Option<String> },
    /// Sets parameters.
    SetParameters { parameters: Vec<Parameter>, id: Option<String> },
    /// Asks for each change of parameters; without names, of all.
    SubscribeParameterUpdates { parameter_names: Vec<String> },
    /// Asks for these changes no longer.
    UnsubscribeParameterUpdates { parameter_names: Vec<String> },
}

/// A message of an app.
#[derive(Debug, Clone, PartialEq)]
pub enum Asked {
    Told(Told),
    Playback(Control),
}

/// A wish for tokens of a channel, under a number that the app has chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Subscription {
    pub id: u32,
    pub channel_id: u32,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    pub name: String,
    /// Its value; an app that wants to remove it leaves it out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
    #[serde(default, rename = "type", skip_serializing_if = "Option::is_none")]
    pub kind: Option<String>,
}

/// A request for another pace, or for another time.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// `true` if the robot shall continue, `false` if it shall halt.
    pub plays: bool,
    /// Seconds of the robot's time per second.
    pub speed: f32,
    /// Time in ns to which the robot shall go.
    pub seek: Option<u64>,
    /// Name of the request.
    pub id: String,
}

/// Returns what an app asks for; `None` for messages of the connection.
///
/// # Errors
/// The message is not one that an app may send.
pub fn asked(message: &Message) -> Result<Option<Asked>, String> {
    match message {
        Message::Text(text) => {
            let told = serde_json::from_str(text).map_err(|error| shortened(&format!("invalid message: {error}")))?;
            Ok(Some(Asked::Told(told)))
        }
        Message::Binary(bytes) => binary(bytes).map(|control| Some(Asked::Playback(control))),
        _ => Ok(None),
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(MAX_WORDS).collect()
}

fn binary(bytes: &[u8]) -> Result<Control, String> {
    match bytes.split_first() {
        Some((&PLAYBACK_CONTROL, rest)) => Control::read(rest).ok_or_else(|| "invalid request for playback".to_owned()),
        Some((&CLIENT_DATA, _)) => Err("a robot takes no messages of an app".to_owned()),
        Some((&SERVICE_CALL, _)) => Err("a robot has no services".to_owned()),
        Some((code, _)) => Err(format!("unknown binary message {code}")),
        None => Err("empty binary message".to_owned()),
    }
}

impl Control {
    /// Reads a command (1 byte), a speed (4), 1 if a time follows, a time (8), and the length (4) and bytes of a name.
    fn read(bytes: &[u8]) -> Option<Self> {
        let (command, rest) = bytes.split_first()?;
        let plays = match command {
            0 => true,
            1 => false,
            _ => return None,
        };
        let (speed, rest) = rest.split_first_chunk()?;
        let (seeks, rest) = rest.split_first()?;
        let (time, rest) = rest.split_first_chunk()?;
        let (length, rest) = rest.split_first_chunk()?;
        let id = rest.get(..u32::from_le_bytes(*length) as usize)?;
        let speed = Some(f32::from_le_bytes(*speed)).filter(|speed| *speed > 0.0)?;
        let seek = (*seeks != 0).then(|| u64::from_le_bytes(*time));
        Some(Self { plays, speed, seek, id: str::from_utf8(id).ok()?.to_owned() })
    }
}

/// A message to an app.
#[derive(Debug, Clone, PartialEq)]
pub enum Frame {
    Text(Text),
    /// A token, with the number of the subscription and its time in ns.
    Data {
        subscription: u32,
        time: u64,
        payload: Vec<u8>,
    },
    /// Time of the robot in ns.
    Time(u64),
    Playback(State),
}

/// A message to an app in JSON.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "op", rename_all = "camelCase", rename_all_fields = "camelCase")]
pub enum Text {
    ServerInfo {
        name: String,
        capabilities: Vec<&'static str>,
        session_id: String,
        #[serde(skip_serializing_if = "Option::is_none")]
        data_start_time: Option<Moment>,
        #[serde(skip_serializing_if = "Option::is_none")]
        data_end_time: Option<Moment>,
    },
    Status {
        level: u8,
        message: String,
    },
    Advertise {
        channels: Vec<Channel>,
    },
    Unadvertise {
        channel_ids: Vec<u32>,
    },
    ParameterValues {
        parameters: Vec<Parameter>,
        #[serde(skip_serializing_if = "Option::is_none")]
        id: Option<String>,
    },
}

/// A time in whole seconds and ns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Moment {
    sec: u64,
    nsec: u64,
}

/// A channel.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Channel {
    pub id: u32,
    pub topic: String,
    pub encoding: &'static str,
    pub schema_name: String,
    pub schema_encoding: &'static str,
    pub schema: String,
}

/// State of a robot whose time can be controlled.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub status: Status,
    /// Time of the robot in ns.
    pub now: u64,
    pub speed: f32,
    /// `true` if it has gone to another time.
    pub jumped: bool,
    /// Name of the request that this answers; empty for none.
    pub id: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    Plays = 0,
    Halted = 1,
    Travels = 2,
    Ended = 3,
}

/// Returns a time of a robot as the protocol has it: none is before zero.
pub fn nanos(time: i64) -> u64 {
    u64::try_from(time).unwrap_or(0)
}

impl Moment {
    /// Returns a time in ns.
    pub fn new(time: i64) -> Self {
        Self { sec: nanos(time) / 1_000_000_000, nsec: nanos(time) % 1_000_000_000 }
    }
}

impl Frame {
    pub fn error(message: impl Into<String>) -> Self {
        Self::Text(Text::Status { level: 2, message: message.into() })
    }

    pub fn warning(message: impl Into<String>) -> Self {
        Self::Text(Text::Status { level: 1, message: message.into() })
    }

    /// Returns the message as it is sent.
    pub fn message(&self) -> Message {
        match self {
            Self::Text(text) => Message::Text(serde_json::to_string(text).unwrap_or_default().into()),
            Self::Data { subscription, time, payload } => {
                let head = [&[MESSAGE_DATA][..], &subscription.to_le_bytes(), &time.to_le_bytes()];
                Message::Binary([&head.concat(), &payload[..]].concat().into())
            }
            Self::Time(time) => Message::Binary([&[TIME][..], &time.to_le_bytes()].concat().into()),
            Self::Playback(State { status, now, speed, jumped, id }) => {
                let head = [&[PLAYBACK_STATE, *status as u8][..], &now.to_le_bytes(), &speed.to_le_bytes()].concat();
                let name = [&(id.len() as u32).to_le_bytes()[..], id.as_bytes()].concat();
                Message::Binary([&head[..], &[u8::from(*jumped)], &name].concat().into())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Option<Asked>, String> {
        asked(&Message::Binary(bytes.to_vec().into()))
    }

    fn says(text: &str) -> Result<Option<Asked>, String> {
        asked(&Message::Text(text.to_owned().into()))
    }

    /// A request as the server of Foxglove's own library takes it.
    const PAUSE: [u8; 22] = [3, 1, 0, 0, 0, 0x40, 1, 9, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, b'a', b'b', b'c'];

    #[test]
    fn requests_for_playback_are_read() {
        let control = Control { plays: false, speed: 2.0, seek: Some(9), id: "abc".to_owned() };
        assert_eq!(read(&PAUSE), Ok(Some(Asked::Playback(control))));
        let mut play = PAUSE;
        (play[1], play[6]) = (0, 0);
        assert!(matches!(read(&play), Ok(Some(Asked::Playback(Control { plays: true, seek: None, .. })))));
    }

    #[test]
    fn wrong_messages_are_errors() {
        (0..PAUSE.len()).for_each(|length| assert!(read(&PAUSE[..length]).is_err(), "{length} bytes"));
        // An unknown command, a length beyond the end, a name that is no text, no number, no pace.
        for (at, wrong) in [(1, 2), (18, 0xff), (19, 0xff)] {
            let mut bytes = PAUSE;
            bytes[at] = wrong;
            assert!(read(&bytes).is_err(), "byte {at}");
        }
        for speed in [f32::NAN, 0.0, -1.0] {
            let mut bytes = PAUSE;
            bytes[2..6].copy_from_slice(&speed.to_le_bytes());
            assert!(read(&bytes).is_err(), "{speed}");
        }
        (0..=u8::MAX).filter(|code| *code != 3).for_each(|code| assert!(read(&[code, 0, 0, 0, 0, 0]).is_err()));
        let texts = [
            "",
            "{",
            "[]",
            "null",
            "{}",
            r#"{"op":7}"#,
            r#"{"op":"unknown"}"#,
            r#"{"op":"subscribe"}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}"#,
            r#"{"op":"subscribe","subscriptions":[{"id":1e99,"channelId":1}]}"#,
            r#"{"op":"getParameters","parameterNames":"all"}"#,
            r#"{"op":"setParameters","parameters":[7]}"#,
        ];
        texts.iter().for_each(|text| assert!(says(text).is_err(), "{text}"));
        let long = format!(r#"{{"op":"{}"}}"#, "x".repeat(100_000));
        assert!(says(&long).unwrap_err().len() <= 4 * MAX_WORDS);
        assert!(says(&"[".repeat(100_000)).is_err());
    }

    #[test]
    fn messages_have_the_bytes_of_the_protocol() {
        let bytes = |frame: Frame| frame.message().into_data().to_vec();
        let data = Frame::Data { subscription: 5, time: 42, payload: b"{}".to_vec() };
        assert_eq!(bytes(data), [1, 5, 0, 0, 0, 42, 0, 0, 0, 0, 0, 0, 0, b'{', b'}']);
        assert_eq!(bytes(Frame::Time(123)), [2, 123, 0, 0, 0, 0, 0, 0, 0]);
        let state = State { status: Status::Halted, now: 77, speed: 2.0, jumped: true, id: "abc".to_owned() };
        let expected = [5, 1, 77, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 1, 3, 0, 0, 0, b'a', b'b', b'c'];
        assert_eq!(bytes(Frame::Playback(state)), expected);
        let info = Frame::Text(Text::ServerInfo {
            name: "x".to_owned(),
            capabilities: vec!["time"],
            session_id: "1".to_owned(),
            data_start_time: Some(Moment::new(5_000_000_005)),
            data_end_time: None,
        });
        let expected = r#"{"op":"serverInfo","name":"x","capabilities":["time"],"sessionId":"1","dataStartTime":{"sec":5,"nsec":5}}"#;
        assert_eq!(bytes(info), expected.as_bytes());
    }
}
