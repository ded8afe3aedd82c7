//! The protocol of Foxglove, spoken from outside as an app does.

use crate::{
    page::{Restarted, opened, start, studio, studio_of},
    several::NoText,
    socket,
    steady::Steady,
};
use apex_studio::{Remote, Seat};
use apex_tests::python;
use serde_json::{Value, json};
use std::{
    net::TcpStream,
    path::Path,
    process::Command,
    sync::Arc,
    time::{Duration, Instant},
};
use tungstenite::{Error, Message, WebSocket, client, client::IntoClientRequest as _, http::StatusCode};

/// An app of Foxglove.
struct App {
    socket: WebSocket<Steady>,
}

/// Address of a robot for apps, from that of the page.
fn address(page: &str, end: &str) -> String {
    let (host, token) = page.trim_start_matches("http://").split_once("/#").expect("an address with a token");
    format!("ws://{host}/foxglove/{token}{end}")
}

/// Connects, as an app does that runs in a browser.
fn connect(address: &str, host: Option<&str>, protocols: Option<&str>) -> Result<WebSocket<Steady>, StatusCode> {
    let own = address.trim_start_matches("ws://").split('/').next().expect("a host");
    let mut request = address.into_client_request().expect("an address");
    let headers = request.headers_mut();
    headers.insert("Origin", "https://app.example.org".parse().expect("a header"));
    host.into_iter().for_each(|host| drop(headers.insert("Host", host.parse().expect("a header"))));
    protocols
        .into_iter()
        .for_each(|names| drop(headers.insert("Sec-WebSocket-Protocol", names.parse().expect("a header"))));
    match client(request, Steady(TcpStream::connect(own).expect("the studio listens"))) {
        Ok((socket, _)) => Ok(socket),
        Err(tungstenite::HandshakeError::Failure(Error::Http(response))) => Err(response.status()),
        Err(error) => panic!("{error}"),
    }
}

impl App {
    fn open(page: &str) -> Self {
        let socket = connect(&address(page, ""), None, Some("foxglove.sdk.v1")).expect("it is admitted");
        Self { socket }
    }

    fn send(&mut self, message: &Value) {
        self.say(Message::Text(message.to_string().into()));
    }

    fn say(&mut self, message: Message) {
        self.socket.send(message).expect("the studio reads");
    }

    /// Waits for a message for which `read` returns something. Those before it are lost.
    fn wait<T>(&mut self, what: &str, read: impl Fn(&Message) -> Option<T>) -> T {
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(100) {
            let message = self.socket.read().expect("the studio answers");
            if let Some(found) = read(&message) {
                return found;
            }
        }
        panic!("no {what} has come");
    }

    /// Waits for a message in JSON of this kind.
    fn hear(&mut self, op: &str) -> Value {
        self.wait(op, |message| {
            let value: Value = serde_json::from_str(message.to_text().ok()?).ok()?;
            (value["op"] == op).then_some(value)
        })
    }

    /// Waits for a complaint with these words.
    fn complaint(&mut self, words: &str) {
        self.wait(words, |message| {
            let value: Value = serde_json::from_str(message.to_text().ok()?).ok()?;
            (value["op"] == "status" && value["message"].as_str()?.contains(words)).then_some(())
        });
    }

    /// Waits for a token of a subscription. Returns its time in ns and its bytes.
    fn token(&mut self, subscription: u32) -> (u64, Vec<u8>) {
        self.wait("token", |message| {
            let Message::Binary(bytes) = message else { return None };
            let rest = bytes.strip_prefix(&[1])?.strip_prefix(&subscription.to_le_bytes())?;
            let (time, payload) = rest.split_first_chunk()?;
            Some((u64::from_le_bytes(*time), payload.to_vec()))
        })
    }

    /// Waits for a token in JSON.
    fn json(&mut self, subscription: u32, is: impl Fn(&Value) -> bool) -> Value {
        loop {
            let value: Value = serde_json::from_slice(&self.token(subscription).1).expect("JSON");
            if is(&value) {
                return value;
            }
        }
    }

    /// Waits for a state of the time for which `is` holds: the status, the time in ns, the speed, `true` after a jump,
    /// and the name of the request.
    fn state(&mut self, is: impl Fn(&State) -> bool) -> State {
        self.wait("state", |message| {
            let Message::Binary(bytes) = message else { return None };
            let (head, name) = bytes.strip_prefix(&[5])?.split_first_chunk::<18>()?;
            let number = u64::from_le_bytes(head[1..9].try_into().expect("eight bytes"));
            let speed = f32::from_le_bytes(head[9..13].try_into().expect("four bytes"));
            assert_eq!(name.len(), u32::from_le_bytes(head[14..].try_into().expect("four bytes")) as usize);
            let state = (head[0], number, speed, head[13] == 1, String::from_utf8_lossy(name).into_owned());
            is(&state).then_some(state)
        })
    }

    /// Controls the time.
    fn control(&mut self, plays: bool, speed: f32, seek: Option<f64>, name: &str) {
        let time = (seek.unwrap_or(0.0) * 1e9) as u64;
        let mut bytes = vec![3, u8::from(!plays)];
        bytes.extend(speed.to_le_bytes());
        bytes.push(u8::from(seek.is_some()));
        bytes.extend(time.to_le_bytes());
        bytes.extend((name.len() as u32).to_le_bytes());
        bytes.extend(name.as_bytes());
        self.say(Message::Binary(bytes.into()));
    }

    /// Number of the channel with this topic, once there is one.
    fn channel(&mut self, topic: &str) -> Value {
        self.wait(topic, |message| {
            let value: Value = serde_json::from_str(message.to_text().ok()?).ok()?;
            value["channels"].as_array()?.iter().find(|channel| channel["topic"] == topic).cloned()
        })
    }

    fn subscribe(&mut self, id: u32, channel: &Value) {
        self.send(&json!({ "op": "subscribe", "subscriptions": [{ "id": id, "channelId": channel["id"] }] }));
    }
}

type State = (u8, u64, f32, bool, String);

const PLAYS: u8 = 0;
const HALTED: u8 = 1;
const TRAVELS: u8 = 2;

#[test]
fn only_apps_with_the_token_and_the_protocol_are_admitted() {
    let page = studio("fox-foreign", false).0;
    let admitted = |end: &str, host: Option<&str>, protocols: Option<&str>| {
        connect(&address(&page, end), host, protocols).map(drop).err().map_or(101, |status| status.as_u16())
    };
    let both = Some("foxglove.sdk.v1, foxglove.websocket.v1");
    assert_eq!(admitted("", None, Some("foxglove.sdk.v1")), 101);
    assert_eq!(admitted("", None, Some("foxglove.websocket.v1")), 101);
    assert_eq!(admitted("/0", None, both), 101);
    assert_eq!(admitted("/1", None, both), 404);
    assert_eq!(admitted("/-1", None, both), 400);
    assert_eq!(admitted("x", None, both), 403);
    assert_eq!(admitted("", Some("example.org"), both), 403);
    assert_eq!(admitted("", None, Some("other")), 400);
    assert_eq!(admitted("", None, None), 400);
}

#[test]
fn an_app_sees_tokens_activity_and_problems() {
    let _robot = start("fox-tokens", 3600);
    let mut app = App::open(&studio("fox-tokens", false).0);
    let info = app.wait("robot", |message| {
        let value: Value = serde_json::from_str(message.to_text().ok()?).ok()?;
        (value["op"] == "serverInfo" && value["name"] == "Counts").then_some(value)
    });
    assert_eq!(info["capabilities"], json!(["time", "parameters", "parametersSubscribe", "playbackControl"]));
    let channels = app.hear("advertise")["channels"].clone();
    let channel = |topic: &str| {
        let mut all = channels.as_array().into_iter().flatten();
        all.find(|channel| channel["topic"] == topic).cloned().unwrap_or_else(|| panic!("`{topic}` in {channels}"))
    };
    let pose = channel("pose_on_circle_1.out");
    assert_eq!(pose["schemaName"], "geometry_msgs/msg/PoseStamped");
    assert_eq!((&pose["encoding"], &pose["schemaEncoding"]), (&json!("cdr"), &json!("ros2msg")));
    assert!(pose["schema"].as_str().is_some_and(|text| text.contains("geometry_msgs/Pose pose")));
    app.subscribe(9, &channel("apex/activity"));
    app.json(9, |value| *value == json!({ "name": "gated.gate", "active": true }));
    app.subscribe(10, &channel("apex/problems"));
    let problem = app.json(10, |value| value["message"] == "three <b>");
    assert_eq!((&problem["name"], &problem["level"]), (&json!("times"), &json!(4)));
    // A number is a message of ROS 2 with 64 bits, and it counts from the beginning, every 10 ms.
    app.subscribe(7, &channel("count.out"));
    for _ in 0..3 {
        let (time, payload) = app.token(7);
        let number = i64::from_le_bytes(payload[4..].try_into().expect("a number"));
        assert_eq!(payload[..4], [0, 1, 0, 0]);
        assert!((number - 1).abs_diff(time as i64 / 10_000_000) <= 1, "{number} at {time} ns");
    }
    app.subscribe(8, &pose);
    assert!(app.token(8).1.len() > 60);
    app.wait("time", |message| matches!(message, Message::Binary(bytes) if bytes[0] == 2).then_some(()));
    app.send(&json!({ "op": "unsubscribe", "subscriptionIds": [7, 99] }));
    app.subscribe(7, &channel("times.out"));
    assert!(app.token(7).1.len() == 12);
}

/// The parameters in a message.
fn values(message: &Value) -> Vec<(&str, &Value)> {
    let all = message["parameters"].as_array().into_iter().flatten();
    all.map(|parameter| (parameter["name"].as_str().unwrap_or_default(), &parameter["value"])).collect()
}

#[test]
fn an_app_reads_sets_and_follows_parameters() {
    let _robot = start("fox-params", 3600);
    let page = studio("fox-params", false).0;
    let (mut app, mut other) = (App::open(&page), App::open(&page));
    for app in [&mut app, &mut other] {
        app.channel("times.out");
        // Its values come a little later than the robot.
        loop {
            app.send(&json!({ "op": "getParameters", "parameterNames": [], "id": "all" }));
            let all = app.hear("parameterValues");
            if values(&all).contains(&("times.factor", &json!(2))) {
                assert_eq!(all["id"], "all");
                break;
            }
        }
    }
    other.send(&json!({ "op": "subscribeParameterUpdates", "parameterNames": ["times.factor", "unknown"] }));
    other.send(&json!({ "op": "getParameters", "parameterNames": ["unknown", "times.factor"], "id": "one" }));
    assert_eq!(values(&other.hear("parameterValues")), [("times.factor", &json!(2))]);
    let set = |value: Value| json!({ "op": "setParameters", "id": "set", "parameters": [{ "name": "times.factor", "value": value }] });
    app.send(&set(json!(7)));
    let answer = app.hear("parameterValues");
    assert_eq!((values(&answer), &answer["id"]), (vec![("times.factor", &json!(7))], &json!("set")));
    let news = other.hear("parameterValues");
    assert_eq!((values(&news), &news["id"]), (vec![("times.factor", &json!(7))], &Value::Null));
    // Out of range, of another type, removed, unknown: the value stays.
    app.send(&set(json!(10)));
    app.complaint("`times.factor` was not set");
    assert_eq!(values(&app.hear("parameterValues")), [("times.factor", &json!(7))]);
    app.send(&set(json!("seven")));
    app.complaint("`times.factor` was not set");
    app.send(&json!({ "op": "setParameters", "parameters": [{ "name": "times.factor" }] }));
    app.complaint("cannot be removed");
    app.send(&json!({ "op": "setParameters", "parameters": [{ "name": "unknown", "value": 1 }] }));
    app.complaint("there is no parameter `unknown`");
    other.send(&json!({ "op": "unsubscribeParameterUpdates", "parameterNames": [] }));
}

#[test]
fn an_app_that_may_only_look_changes_nothing() {
    let _robot = start("fox-readonly", 3600);
    let mut app = App::open(&studio("fox-readonly", true).0);
    app.channel("times.out");
    app.send(&json!({ "op": "setParameters", "id": "set", "parameters": [{ "name": "times.factor", "value": 7 }] }));
    app.complaint("may only look");
    assert_eq!(app.hear("parameterValues")["id"], "set");
    app.control(false, 1.0, None, "halt");
    app.complaint("cannot be controlled");
    app.send(&json!({ "op": "getParameters", "parameterNames": ["times.factor"] }));
    assert_eq!(values(&app.hear("parameterValues")), [("times.factor", &json!(2))]);
}

#[test]
fn an_app_halts_a_robot_and_goes_forth_and_back() {
    let mut app = App::open(&studio_of(Restarted::new("fox-time", None), false).0);
    let count = app.channel("count.out");
    app.subscribe(1, &count);
    app.token(1);
    app.control(false, 1.0, None, "halt");
    // Ahead, where nothing is known yet. The robot halts there, also if it was still being halted before.
    app.control(false, 1.0, Some(5.0), "ahead");
    assert_eq!(app.state(|state| state.4 == "halt").0, HALTED);
    assert!(app.state(|state| state.4 == "ahead").3);
    let (_, now, ..) = app.state(|state| state.0 == HALTED);
    assert_eq!(now, 4_990_000_000);
    let number = |(_, payload): (u64, Vec<u8>)| i64::from_le_bytes(payload[4..].try_into().expect("a number"));
    // Back. A token before that time is the newest one then, and the robot goes on from there.
    app.control(true, 2.0, Some(1.0), "back");
    assert_eq!(app.state(|state| state.4 == "back").0, TRAVELS);
    let (status, now, speed, ..) = app.state(|state| state.0 == PLAYS);
    assert!((990_000_000..4_000_000_000).contains(&now) && speed == 2.0, "{status} {now} {speed}");
    let first = number(app.token(1));
    assert!((90..400).contains(&first), "{first}");
    assert!(number(app.token(1)) > first);
}

#[test]
fn a_robot_that_was_started_elsewhere_cannot_go_back() {
    let _robot = start("fox-remote", 3600);
    let mut app = App::open(&studio("fox-remote", false).0);
    app.channel("count.out");
    app.control(false, 1.0, Some(2.0), "ahead");
    app.state(|state| state.0 == HALTED && state.1 > 0);
    app.control(false, 1.0, Some(0.5), "back");
    app.complaint("cannot go back");
}

#[test]
fn hostile_messages_are_refused_and_others_go_on() {
    let _robot = start("fox-hostile", 3600);
    let page = studio("fox-hostile", false).0;
    let (mut app, mut other) = (App::open(&page), App::open(&page));
    let count = other.channel("count.out");
    other.subscribe(1, &count);
    app.channel("count.out");
    let texts = ["", "{", "null", "[1]", r#"{"op":"unknown"}"#, r#"{"op":"subscribe","subscriptions":7}"#];
    for text in texts {
        app.say(Message::Text(text.into()));
        app.complaint("invalid message");
    }
    app.say(Message::Text("[".repeat(500_000).into()));
    app.complaint("invalid message");
    for (bytes, words) in [
        (vec![], "empty binary message"),
        (vec![9, 1, 2], "unknown binary message 9"),
        (vec![1, 0, 0, 0, 0], "takes no messages"),
        (vec![2; 300], "no services"),
        (vec![3], "invalid request"),
        ([&[3, 0, 0, 0, 0x80, 0x3f, 0][..], &[0; 8], &[0xff; 4]].concat(), "invalid request"),
    ] {
        app.say(Message::Binary(bytes.into()));
        app.complaint(words);
    }
    app.subscribe(1, &json!({ "id": 4_000_000_000_u32 }));
    app.complaint("there is no channel 4000000000");
    app.subscribe(1, &count);
    app.subscribe(1, &count);
    app.complaint("there is a subscription");
    app.control(true, 1.0, Some(1e30), "too far");
    app.state(|state| state.4 == "too far");
    app.control(true, 1.0, None, "on");
    app.state(|state| state.4 == "on");
    // More than a message may have: the studio ends this connection alone.
    let _ = app.socket.send(Message::Binary(vec![3; 2 << 20].into()));
    while app.socket.read().is_ok() {}
    other.token(1);
}

#[test]
fn an_app_may_choose_a_robot_and_sees_it_come_and_go() {
    let seat = |name: &str| {
        let robot = Box::new(Remote { address: socket(name).display().to_string() });
        Seat { name: name.to_owned(), robot, source: Arc::new(NoText), shadow_of: None }
    };
    let page = opened(vec![seat("fox-none"), seat("fox-second")], false);
    let socket = connect(&address(&page, "/1"), None, Some("foxglove.websocket.v1")).expect("it is admitted");
    let mut app = App { socket };
    // Nobody is there yet.
    assert_eq!(app.hear("serverInfo")["name"], "Apex");
    assert_eq!(app.hear("advertise")["channels"], json!([]));
    let first = start("fox-second", 1);
    let count = app.channel("count.out");
    app.subscribe(1, &count);
    app.token(1);
    first.join();
    let _again = start("fox-second", 3600);
    // Another run: all of it is introduced once more.
    assert!(app.hear("unadvertise")["channelIds"].as_array().is_some_and(|all| all.contains(&count["id"])));
    let count = app.channel("count.out");
    app.subscribe(1, &count);
    app.token(1);
}

/// A client of others, with a decoder of others for what it is sent.
const READ: &str = "import asyncio, json, math, struct, sys
import websockets
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
async def main():
    decoders, found = {}, {}
    async with websockets.connect(sys.argv[1], subprotocols=['foxglove.sdk.v1', 'foxglove.websocket.v1']) as app:
        print(app.subprotocol)
        async for message in app:
            if isinstance(message, str):
                told = json.loads(message)
                wanted = [c for c in told.get('channels', []) if c['encoding'] == 'cdr']
                for c in wanted:
                    schema = Schema(id=c['id'], name=c['schemaName'], encoding=c['schemaEncoding'], data=c['schema'].encode())
                    decoders[c['id']] = (c['topic'], DecoderFactory().decoder_for(c['encoding'], schema))
                wishes = [{'id': c['id'], 'channelId': c['id']} for c in wanted]
                await app.send(json.dumps({'op': 'subscribe', 'subscriptions': wishes}))
            elif message[0] == 1:
                subscription, time = struct.unpack_from('<IQ', message, 1)
                topic, decode = decoders[subscription]
                found[topic] = decode(message[13:])
            if len(found) == 5:
                break
    for topic in sorted(found):
        m = found[topic]
        if topic.startswith('pose'):
            print(topic, round(math.hypot(m.pose.position.x, m.pose.position.y), 3), m.header.frame_id)
        else:
            print(topic, type(m.data).__name__)
asyncio.run(main())
";

#[test]
fn software_of_others_reads_what_an_app_is_sent() {
    let packages = "websockets mcap mcap-ros2-support";
    let temporary = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let Some(python) = python(temporary, "websockets, mcap_ros2", packages) else { return };
    let _robot = start("fox-python", 3600);
    let page = studio("fox-python", false).0;
    let output = Command::new(python).args(["-c", READ, &address(&page, "")]).output().expect("python runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let expected = "foxglove.sdk.v1\ncount.out int\ndrawn_count_2.out str\ngated.gate.out int\npose_on_circle_1.out 1.0 robot\ntimes.out int\n";
    assert_eq!(String::from_utf8_lossy(&output.stdout), expected);
}
