//! Channels that an app can subscribe to: ports, under the names that they have in recordings, activity, and problems.

use super::messages::{Channel, Moment, nanos};
use crate::live::{Live, Node, Problem};
use apex_rt::studio::message::About;
use serde_json::{Value, json};

/// Numbers of the channels for activity and problems, and of the first port.
pub const ACTIVITY: u32 = 1;
pub const PROBLEMS: u32 = 2;
const FIRST: u32 = 3;

/// Levels of messages in a log of Foxglove.
const ERROR: u8 = 4;

/// Returns the channels of a robot. Tokens with a message of ROS 2 are sent as that, bit by bit; all others as text.
pub fn channels(about: &About) -> Vec<Channel> {
    let ports = (FIRST..).zip(&about.channels).filter_map(|(id, port)| {
        let schema = port.schema.as_ref()?;
        let topic = port.name.clone();
        Some(if schema.definition.is_empty() {
            json_channel(id, topic, schema.name.clone(), &json!({ "text": { "type": "string" } }))
        } else {
            let (schema_name, definition) = (schema.name.clone(), schema.definition.clone());
            Channel { id, topic, encoding: "cdr", schema_name, schema_encoding: "ros2msg", schema: definition }
        })
    });
    let activity = json!({ "name": { "type": "string" }, "active": { "type": "boolean" } });
    let activity = json_channel(ACTIVITY, "apex/activity".to_owned(), "apex.Activity".to_owned(), &activity);
    let problems = json_channel(PROBLEMS, "apex/problems".to_owned(), "foxglove.Log".to_owned(), &log_schema());
    [activity, problems].into_iter().chain(ports).collect()
}

fn json_channel(id: u32, topic: String, schema_name: String, properties: &Value) -> Channel {
    let schema = json!({ "title": &schema_name, "type": "object", "properties": properties }).to_string();
    Channel { id, topic, encoding: "json", schema_name, schema_encoding: "jsonschema", schema }
}

fn log_schema() -> Value {
    let text = || json!({ "type": "string" });
    let whole = || json!({ "type": "integer", "minimum": 0 });
    let time = json!({ "type": "object", "title": "time", "properties": { "sec": whole(), "nsec": whole() } });
    json!({ "timestamp": time, "level": whole(), "message": text(), "name": text(), "file": text(), "line": whole() })
}

/// Returns the port that a channel is for.
pub fn port(channel: u32) -> Option<u32> {
    channel.checked_sub(FIRST)
}

/// Returns the newest token of a port: its time in ns and its bytes. `None` if there is none, or if it is too long.
pub fn token(live: &Live, port: u32) -> Option<(u64, Vec<u8>)> {
    let tokens = live.tokens.get(&port)?;
    let (time, text) = tokens.newest.back()?;
    let schema = live.about.as_ref()?.channels.get(port as usize)?.schema.as_ref()?;
    let payload = if schema.definition.is_empty() {
        json!({ "text": text }).to_string().into_bytes()
    } else {
        tokens.bytes.clone()
    };
    (!payload.is_empty()).then_some((nanos(*time), payload))
}

/// Returns a change of the activity of a node: its time in ns and its bytes.
pub fn activity(about: &About, at: usize, node: &Node, active: bool) -> Option<(u64, Vec<u8>)> {
    let name = &about.nodes.get(at)?.name;
    Some((nanos(node.since), json!({ "name": name, "active": active }).to_string().into_bytes()))
}

/// Returns a problem as a message of a log: its time in ns and its bytes.
pub fn problem(about: &About, problem: &Problem) -> (u64, Vec<u8>) {
    let node = problem.node.and_then(|node| about.nodes.get(node as usize));
    let file = node.and_then(|node| about.files.get(node.file as usize)).map_or("", String::as_str);
    let (name, line) = node.map_or(("", 0), |node| (&node.name, node.line));
    let time = (problem.at * 1e9).round() as i64;
    let message = json!({
        "timestamp": Moment::new(time), "level": ERROR, "message": problem.text, "name": name, "file": file, "line": line,
    });
    (nanos(time), message.to_string().into_bytes())
}
