//! Recording and replay of programs with all kinds of tokens.

use crate::{Folder, record, repeat};
use apex_macros::graph;
use apex_rt::{
    Program, drive_with,
    prelude::*,
    record::{Channel, Channels, Codec, Role, replay},
};
use std::time::Duration;

graph! {
    use apex_tests::nodes::{
        Diary, Mean, Moody, bits, chart, device, dozen, heights, noise, pairs, ranges, same, swallow, twist, way,
    };

    /// Sources of all kinds.
    robot Restless {
        node a = noise() every 3ms;
        node b = noise() every 5ms;
        node r = ranges() every 4ms;
        node d = device() every 7ms;
        node m = Moody() every 2ms;
        node mean = Mean();
        node sum = bits();
        node slow = same() deadline 500us;
        node diary = Diary();
        node echo = Diary();

        a -> mean;
        b -> slow;
        r -> sum -> [diary.number, m.ask];
        slow.late -> diary.late;
        d.reading -> diary.reading;
        d.odd -> diary.number;
        m.level -> diary.number;
        m.alarm -> diary.number;
        m.answer -> diary.number;
        m.failed -> diary.failure;
        diary.told -> echo.text;
        mean -> same() -> swallow();

        record "restless.mcap" {
            mean.out;
            sum.out;
            slow.late;
            diary.told;
        }
    }

    /// Several tokens at once.
    robot Batches {
        node d = dozen() every 3ms;
        node pairs = pairs();
        node diary = Diary();
        d -> pairs -> swallow();
        node echo = Diary();
        d.processed -> diary.late;
        diary.told -> echo.text;
        record "batches.mcap" {
            pairs.out;
            diary.told;
        }
    }

    /// Tokens with types for navigation.
    robot Navigator {
        node map = same();
        node costs = same();
        node path = same();
        node motion = same();
        chart() every 3ms -> map -> swallow();
        heights() every 3ms -> costs -> swallow();
        way() every 3ms -> path -> swallow();
        twist() every 3ms -> motion -> swallow();
        record "navigator.mcap" { map; costs; path; motion; }
    }

    /// Tokens enter from outside, and events are taken out.
    graph Ports {
        in value: f64;
        slot number: u64;
        event told: String;
        out mean: f64;
        node m = Mean();
        node diary = Diary();
        value -> m -> mean;
        number -> diary.number;
        diary.told -> told;
        record "ports.mcap" {
            m.out;
            diary.told;
        }
    }

    /// Tokens that follow from parameters and slots.
    robot Computed {
        node one    = apex_nodes::flow::constant<f64>(value = 1) every 10ms;
        node shifted = Mean();
        node newest = apex_nodes::flow::Latest() every 10ms;
        node after  = Mean();
        one          -> shifted -> newest.set;
        newest       -> after -> swallow();
        record "computed.mcap" { shifted.out; after.out; }
    }

    /// The order of tokens in several slots counts.
    graph Ordered {
        slot a: u64;
        slot b: u64;
        slot c: u64;
        node diary = Diary();
        node echo = Diary();
        a -> diary.number;
        b -> diary.number;
        c -> diary.number;
        diary.told -> echo.text;
        record "ordered.mcap" { diary.told; }
    }
}

/// A machine on which the duration of reactions varies.
#[derive(Default)]
struct Busy(u32);

impl Observer for Busy {
    fn elapsed(&mut self) -> Duration {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        Duration::from_nanos(u64::from(self.0 >> 12))
    }
}

pub fn until(ms: i64) -> SimClock {
    SimClock::until(Time::from_millis(ms))
}

#[test]
fn a_run_with_chance_in_it_is_the_same_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut first = Restless::new();
    record::<Restless>(&path, |tap| {
        drive_with(&mut first, until(400), (Busy::default(), tap));
    });
    let mut second = Restless::new();
    let report = repeat(&mut second, &path);
    assert!(report.is_same() && report.missing.is_empty() && report.params.is_empty(), "{report}");
    assert_eq!(report.compared.len(), 4, "{report}");
    assert_eq!(report.not_called, ["m"], "it has a slot");
    assert!(report.compared.iter().all(|c| c.equal > 5), "{report}");
    assert_eq!(first.nodes().diary.entries, second.nodes().diary.entries);
    assert!(first.nodes().m.calls > 200);
    assert_eq!(second.nodes().m.calls, 0, "a source that was recorded is not called");
}

/// Observer that keeps the tokens of some channels as text.
struct Listener {
    channels: Channels,
    wanted: &'static [&'static str],
    heard: Vec<(&'static str, String)>,
}

impl Observer for Listener {
    fn wants(&mut self, channel: usize) -> bool {
        self.wanted.contains(&self.channels[channel].name)
    }
    fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        let Channel { name, show, .. } = self.channels[channel];
        let mut bytes = vec![];
        let codec = codec.expect("all of them can be recorded");
        assert!((codec.write)(token, &mut bytes), "{name}");
        self.heard.push((name, show(&bytes).expect("it was just written")));
    }
}

#[test]
fn an_observer_sees_the_tokens_of_any_port() {
    let wanted = &["mean.out", "d.odd", "m.level", "diary.told", "slow.late"];
    let mut listener = Listener { channels: Restless::channels(), wanted, heard: vec![] };
    drive_with(Restless::new(), until(400), (Busy::default(), &mut listener));
    let heard: Vec<(&str, usize)> =
        wanted.iter().map(|name| (*name, listener.heard.iter().filter(|(other, _)| other == name).count())).collect();
    assert!(heard.iter().all(|(_, count)| *count > 5), "{heard:?}");
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut replayed = Listener { channels: Restless::channels(), wanted, heard: vec![] };
    record::<Restless>(&path, |tap| {
        let mut listener = Listener { channels: Restless::channels(), wanted, heard: vec![] };
        drive_with(Restless::new(), until(100), (&mut listener, (Busy::default(), tap)));
        replayed.heard = listener.heard;
    });
    let before = std::mem::take(&mut replayed.heard);
    let again = Shared(std::sync::Arc::new(std::sync::Mutex::new(replayed)));
    assert!(replay(Restless::new(), &path, again.clone()).expect("a recording").is_same());
    assert_eq!(again.0.lock().expect("no panic").heard, before, "a replay has all tokens, not only the recorded ones");
}

/// An observer that several can use.
#[derive(Clone)]
struct Shared(std::sync::Arc<std::sync::Mutex<Listener>>);

impl Observer for Shared {
    fn wants(&mut self, channel: usize) -> bool {
        self.0.lock().expect("no panic").wants(channel)
    }
    fn sent<T>(&mut self, channel: usize, codec: Option<Codec<T>>, token: &T) {
        self.0.lock().expect("no panic").sent(channel, codec, token);
    }
}

#[test]
fn a_program_describes_itself() {
    let info = &Restless::INFO;
    let m = info.nodes.iter().position(|node| node.name == "m").expect("there is one");
    let kind = info.kind(m);
    let place = info.nodes[m].place;
    assert_eq!((kind.name, info.files, place.file, place.column), ("Moody", &["tests/record/round.rs"][..], 0, 14));
    let ports: Vec<String> =
        kind.ports.iter().map(|port| format!("{:?} {}: {}", port.kind, port.name, port.ty)).collect();
    assert_eq!(ports, ["Output level: u64", "Event alarm: u64", "Slot ask: u64", "Event answer: u64"]);
    assert_eq!(info.docs.trim(), "Sources of all kinds.");
    assert_eq!(
        kind.docs,
        "A device that writes its output in place, has an event, fails occasionally, and counts requests."
    );
    assert!(info.kinds.len() < info.nodes.len(), "nodes of one type share a kind");
}

#[test]
fn maps_paths_and_twists_are_the_same_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Navigator>(&path, |tap| {
        drive_with(Navigator::new(), until(30), tap);
    });
    let report = repeat(Navigator::new(), &path);
    assert!(report.is_same() && report.missing.is_empty(), "{report}");
    assert_eq!(report.compared.iter().map(|c| c.equal).collect::<Vec<_>>(), [10; 4], "{report}");
}

#[test]
fn what_comes_from_outside_comes_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut first = Ports::new();
    let run = |program: &mut Ports, tap: &mut apex_rt::record::Tap| {
        for i in 0..60_u64 {
            let now = Time::from_millis(i as i64);
            if i % 2 == 0 {
                let _ = program.inputs().value.put(i as f64);
            }
            let _ = program.inputs().number.put(i);
            if i % 5 == 0 {
                program.events().told.take();
            }
            if i == 20 {
                program.set_param("m.offset", 2.5).expect("there is one");
            }
            program.react_with(now, tap);
        }
    };
    record::<Ports>(&path, |tap| run(&mut first, tap));
    let mut second = Ports::new();
    let report = repeat(&mut second, &path);
    assert!(report.is_same() && report.reactions == 60, "{report}");
    assert_eq!(report.compared.iter().map(|c| c.equal).collect::<Vec<_>>(), [30, 13], "{report}");
    assert_eq!(first.nodes().diary.entries, second.nodes().diary.entries);
    assert_eq!(first.outputs().mean, second.outputs().mean);
    assert_eq!(second.param::<f64>("m.offset").ok(), Some(2.5));
}

#[test]
fn tokens_come_again_in_the_order_in_which_they_were_put_in() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    let mut first = Ordered::new();
    record::<Ordered>(&path, |tap| {
        for (i, order) in ["abc", "acb", "bac", "bca", "cab", "cba", "ca", "b", ""].into_iter().enumerate() {
            for port in order.chars() {
                let inputs = first.inputs();
                let slot = match port {
                    'a' => &mut inputs.a,
                    'b' => &mut inputs.b,
                    _ => &mut inputs.c,
                };
                slot.put(u64::from(u32::from(port))).expect("it is empty");
            }
            first.react_with(Time::from_millis(i as i64), tap);
        }
    });
    let mut second = Ordered::new();
    let report = repeat(&mut second, &path);
    assert!(report.is_same() && report.reactions == 9, "{report}");
    let entries = &first.nodes().diary.entries;
    assert_eq!((entries.len(), entries), (21, &second.nodes().diary.entries));
}

#[test]
fn several_tokens_at_once_are_the_same_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Batches>(&path, |tap| {
        drive_with(Batches::new(), until(30), tap);
    });
    let report = repeat(Batches::new(), &path);
    let equal: Vec<_> = report.compared.iter().map(|compared| compared.equal).collect();
    assert!(report.is_same() && equal == [60, 10], "{report}");
}

#[test]
fn what_is_computed_at_slots_is_computed_again() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Computed>(&path, |tap| {
        drive_with(Computed::new(), until(1000), tap);
    });
    let same = repeat(Computed::new(), &path);
    assert!(same.is_same() && same.not_called.is_empty(), "{same}");
    for (parameter, counts) in [("shifted.offset", [100, 100]), ("after.offset", [0, 100])] {
        let mut other = Computed::new();
        other.set_param(parameter, 1.0).expect("there is one");
        let report = repeat(&mut other, &path);
        let different: Vec<_> = report.compared.iter().map(|compared| compared.different).collect();
        assert_eq!(different, counts, "{parameter}: {report}");
    }
}

#[test]
fn another_parameter_shows_the_first_difference() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Restless>(&path, |tap| {
        drive_with(Restless::new(), until(50), tap);
    });
    let mut other = Restless::new();
    other.set_param("mean.offset", 1.0).expect("there is one");
    let report = repeat(&mut other, &path);
    let mean = report.compared.iter().find(|c| c.name == "mean.out").expect("it is compared");
    assert!(!report.is_same() && mean.equal == 0 && mean.different == 17, "{report}");
    let first = mean.first.as_ref().expect("a difference");
    assert_eq!((first.index, first.time), (0, Time::ZERO));
    let value = |text: &Option<String>| text.as_ref().and_then(|t| t.parse::<f64>().ok()).expect("a number");
    assert!((value(&first.is) - value(&first.was) - 1.0).abs() < 1e-12);
    assert_eq!(report.params, ["`mean.offset` was 0.0 and is 1.0"]);
    let told = report.compared.iter().find(|c| c.name == "diary.told").expect("it is compared");
    assert_eq!(told.different, 0, "what does not depend on it is the same");
}

#[test]
fn a_recording_of_another_program_is_refused() {
    let folder = Folder::new();
    let path = folder.file("a.mcap");
    record::<Restless>(&path, |tap| {
        drive_with(Restless::new(), until(5), tap);
    });
    let error = replay(Ports::new(), &path, ()).expect_err("another program");
    assert_eq!(error.to_string(), format!("`{}` is a recording of `Restless`, not of `Ports`", path.display()));
}

#[test]
fn nothing_is_overwritten() {
    let folder = Folder::new();
    let path = folder.file("run.mcap");
    let names: Vec<String> = (0..3)
        .map(|_| {
            record::<Restless>(&path, |tap| {
                drive_with(Restless::new(), until(2), tap);
            })
        })
        .map(|finished| finished.path.file_name().expect("a name").to_string_lossy().into_owned())
        .collect();
    assert_eq!(names, ["run.mcap", "run-2.mcap", "run-3.mcap"]);
}

#[test]
fn the_text_names_the_file() {
    assert_eq!(Restless::RECORD, Some("restless.mcap"));
    let channels = Restless::channels();
    let names: Vec<&str> = channels.iter().filter(|c| c.role != Role::Port).map(|c| c.name).collect();
    let expected = ["a.out", "b.out", "r.out", "d.reading", "d.odd", "m.level", "m.alarm", "m.answer", "m.failed"];
    assert_eq!(names[..9], expected);
    assert_eq!(names[9..], ["mean.out", "sum.out", "slow.late", "diary.told"]);
    let others: Vec<&str> = channels.iter().filter(|c| c.role == Role::Port).map(|c| c.name).collect();
    assert_eq!(others, ["same_1.out"], "they can be observed");
    assert!(channels.iter().all(|c| c.schema.is_some()));
}
