//! Parameters of a running program: read, set, saved and loaded.

use apex_macros::graph;
use apex_rt::{
    params::{
        LoadError, ParamError, ParamRange, ParamRef, ParamValue, Problem, Rejection, load, load_file, not_saved,
        run_with_files, save, save_file, set_text,
    },
    prelude::*,
};
use apex_tests::react;
use std::{fs, path::PathBuf, time::Duration};

/// A type that is not allowed for parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    Slow,
}

/// A parameter of every kind.
#[node]
pub struct Kinds {
    #[param(unit = "km/h", default = 0.15, range = 0.01..=1.0)]
    pub speed: f32,
    #[param(default = 1.5)]
    pub pause: Duration,
    #[param(default = u64::MAX)]
    pub seed: u64,
    #[param(default = -3, range = -5..5)]
    pub offset: i8,
    #[param(default = String::from("a \"b\"\n\tü\u{7}"))]
    pub title: String,
    #[param(default = true)]
    pub on: bool,
    #[param(default = vec![0.1, -1e-9, 1e20, f64::NEG_INFINITY])]
    pub list: Vec<f64>,
    #[param(default = [[1, 2], [3, 4]])]
    pub rows: [[u16; 2]; 2],
    #[param(default = Mode::Slow)]
    pub mode: Mode,
    #[param(default = "fixed")]
    pub fixed: &'static str,
}

#[node]
impl Kinds {
    fn process(&mut self) {}
}

/// Multiplies by `by`.
#[node]
pub struct Multiplier {
    #[param(default = 2, range = 0..=100)]
    pub by: i64,
}

#[node]
impl Multiplier {
    fn process(&mut self, x: &i64) -> i64 {
        self.by * x
    }
}

graph! {
    graph Body {
        in  x: i64;
        out y: i64;
        node first = Multiplier(by = 3);
        x -> first -> Multiplier() -> y;
    }

    graph Inside {
        in  x: i64;
        out y: i64;
        node body = Body();
        x -> body -> y;
    }

    /// Nodes at the top, in nested graphs, in bodies of `each`, and from Rust.
    graph Tuned {
        node kinds  = Kinds();
        node handed: Multiplier;
        node ones   = OneBased();
        node nested = Inside();
        node lists  = Lists(lists = [[1, 2]]);
        node single = Multiplier() each;
        node bodies = Body() each;
        node by     = Src(values = [-1]);
        node late   = Gain();
        node sum    = Snk();
        node list   = ListSink();
        ones -> handed -> nested -> sum;
        lists -> single -> bodies -> list;
        by -> late.gain;
    }

    graph Plain { node k = Snk(); OneBased() -> k; }
}

fn tuned() -> Tuned {
    Tuned::new(TunedParts { handed: Multiplier { by: 5 } })
}

const NAMES: [&str; 19] = [
    "kinds.speed",
    "kinds.pause",
    "kinds.seed",
    "kinds.offset",
    "kinds.title",
    "kinds.on",
    "kinds.list",
    "kinds.rows",
    "kinds.mode",
    "kinds.fixed",
    "handed.by",
    "nested.body.first.by",
    "nested.body.multiplier_1.by",
    "lists.lists",
    "single.by",
    "bodies.first.by",
    "bodies.multiplier_1.by",
    "by.values",
    "late.gain",
];

const SAVED: &str = r#"[kinds]
speed = 0.15 # m/s, 0.01..=1
pause = 1.5 # s
seed = 18446744073709551615
offset = -3 # -5..5
title = "a \"b\"\n\tü\u0007"
on = true
list = [0.1, -1e-9, 1e20, -inf]
rows = [[1, 2], [3, 4]]
# mode is a `Mode` and not saved
# fixed is a `&str` and not saved

[handed]
by = 5 # 0..=100

[nested.body.first]
by = 3 # 0..=100

[nested.body.multiplier_1]
by = 2 # 0..=100

[lists]
# lists is a `&[&[i64]]` and not saved

[single]
by = 2 # 0..=100

[bodies.first]
by = 3 # 0..=100

[bodies.multiplier_1]
by = 2 # 0..=100

[by]
# values is a `&[i64]` and not saved

[late]
gain = 1 # 0..=10
"#;

/// Errors in a parameter file as line, column and message. Also checks that the program has not changed.
fn problems(text: &str) -> Vec<String> {
    let mut program = tuned();
    let result = load(&mut program, text);
    assert_eq!(save(&mut program), SAVED, "nothing may change");
    match result {
        Err(LoadError::Text { path: None, problems }) => problems
            .into_iter()
            .map(|Problem { line, column, message }| format!("{line}:{column}: {message}"))
            .collect(),
        other => panic!("{other:?}"),
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("apex-params-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn all_parameters_in_the_order_of_the_text() {
    assert_eq!(Tuned::PARAMS.iter().map(|p| p.name).collect::<Vec<_>>(), NAMES);
    let speed = &Tuned::PARAMS[0];
    assert_eq!((speed.ty, speed.unit), ("f32", Some("m/s")));
    assert_eq!(speed.range, ParamRange::new(Some(0.01), Some(1.0), true));
    assert_eq!(Tuned::PARAMS[1].unit, Some("s"));
    assert!(Plain::PARAMS.is_empty());
}

#[test]
fn par_04_parameters_are_saved() {
    let mut program = tuned();
    assert_eq!(save(&mut program), SAVED);
    assert_eq!(not_saved(&mut program), ["kinds.mode", "kinds.fixed", "lists.lists", "by.values"]);
    assert_eq!(save(&mut Plain::new()), "");
}

#[test]
fn par_04_what_is_saved_is_loaded() {
    let folder = Folder::new("loaded");
    let file = folder.0.join("tuned.toml");
    let mut program = tuned();
    program.set_param("kinds.speed", 0.3_f32).unwrap();
    program.set_param("kinds.title", "new").unwrap();
    program.set_param("kinds.list", [0.5, 1.0 / 3.0]).unwrap();
    program.set_param("kinds.pause", Duration::from_nanos(1_234_567_891)).unwrap();
    program.set_param("handed.by", 7).unwrap();
    program.set_param("nested.body.multiplier_1.by", 11).unwrap();
    program.set_param("bodies.first.by", 13).unwrap();
    save_file(&mut program, &file).unwrap();
    save_file(&mut program, &file).unwrap();
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1, "nothing but the file is left");

    let mut fresh = tuned();
    load_file(&mut fresh, &file).unwrap();
    assert_eq!(save(&mut fresh), save(&mut program));
    react(&mut fresh, 1);
    let nodes = fresh.nodes();
    assert_eq!((nodes.kinds.speed, nodes.kinds.pause), (0.3, Duration::from_nanos(1_234_567_891)));
    assert_eq!((nodes.kinds.title.as_str(), nodes.kinds.list.as_slice()), ("new", &[0.5, 1.0 / 3.0][..]));
    assert_eq!((nodes.kinds.mode, nodes.kinds.fixed), (Mode::Slow, "fixed"));
    assert_eq!(nodes.sum.seen, [7 * 3 * 11]);
    assert_eq!(nodes.list.seen, [[2 * 13 * 2, 4 * 13 * 2]]);
}

#[test]
fn names_that_are_missing_keep_their_values() {
    let mut program = tuned();
    load(&mut program, "kinds.on = false\n[nested.body]\nfirst = { by = 0x10 }\n[late]\n").unwrap();
    let expected = SAVED.replace("on = true", "on = false");
    let expected = expected.replace("[nested.body.first]\nby = 3", "[nested.body.first]\nby = 16");
    assert_eq!(save(&mut program), expected);
    load(&mut program, "").unwrap();
    assert_eq!(save(&mut program), expected);
}

#[test]
fn par_04_unknown_names_are_errors() {
    let text = "handed.bye = 1\n[kinds]\nspeeed = 0.5\non = false\n[nested.bodi.first]\nby = 4\n[nothing]\n[late.gain]\nx = 1\n";
    assert_eq!(
        problems(text),
        [
            "1:8: there is no parameter `handed.bye`; did you mean `handed.by`?",
            "3:1: there is no parameter `kinds.speeed`; did you mean `kinds.speed`?",
            "5:9: there is no node `nested.bodi` with parameters; did you mean `nested.body`?",
            "7:2: there is no node `nothing` with parameters; remove it, or save the parameters to see all names",
            "8:1: `late.gain` (i64) takes an integer, not a table",
        ]
    );
    assert_eq!(
        problems("[latte]\ngain = 2\n"),
        ["1:2: there is no node `latte` with parameters; did you mean `late`?"]
    );
    assert_eq!(problems("late = 2"), ["1:1: `late` is a node: its parameters are in a table, such as `late.gain`"]);
    let Err(LoadError::Text { problems, .. }) = load(&mut Plain::new(), "x = 1") else { panic!("`x` is unknown") };
    assert_eq!(problems[0].message, "there is no parameter `x`; the program has none: remove it");
}

#[test]
fn values_that_are_not_taken() {
    let text = "[kinds]\non = 1\nspeed = 1.5\npause = -1\nseed = -1\noffset = 5\ntitle = 3\nlist = [1, \"two\"]\n\
                rows = [[1, 2]]\nmode = \"Fast\"\nfixed = \"other\"\n[late]\n  gain = 1.0 # not whole\n[handed]\nby = 2000-01-01\n";
    assert_eq!(
        problems(text),
        [
            "2:6: `kinds.on` (bool) takes `true` or `false`, not an integer",
            "3:9: `kinds.speed` cannot be 1.5: its range is 0.01..=1 (m/s)",
            "4:9: the value of `kinds.pause` does not fit into `Duration`",
            "5:8: the value of `kinds.seed` does not fit into `u64`",
            "6:10: `kinds.offset` cannot be 5: its range is -5..5",
            "7:9: `kinds.title` (String) takes a string, not an integer",
            "8:8: `kinds.list` (Vec<f64>) takes a number, not a string",
            "9:8: `kinds.rows` ([[u16; 2]; 2]) takes 2 elements, not 1",
            "10:8: `kinds.mode` is a `Mode`: parameters of this type can only be set in the graph",
            "11:9: `kinds.fixed` is a `&str`: parameters of this type can only be set in the graph",
            "13:10: `late.gain` (i64) takes an integer, not a number with a decimal point",
            "15:6: `handed.by` (i64) takes an integer, not a date",
        ]
    );
    assert_eq!(problems("kinds.speed = nan"), ["1:15: `kinds.speed` cannot be nan: its range is 0.01..=1 (m/s)"]);
    assert_eq!(problems("kinds.speed = 1e300"), ["1:15: the value of `kinds.speed` does not fit into `f32`"]);
    assert_eq!(
        problems("kinds.speed = 1e999"),
        ["1:15: `kinds.speed` (f32) takes a number, not a number that is too large"]
    );
    assert_eq!(problems(&format!("kinds.seed = {}", "9".repeat(50))).len(), 1);
}

#[test]
fn syntax_errors_stand_where_they_are() {
    let found = problems("[kinds]\non = \nspeed = 0.5\n# ü\n  pause == 1\nspeed = 0.6\n");
    assert_eq!(found.len(), 4, "{found:?}");
    assert!(found[0].starts_with("2:") && found[1].starts_with("5:10: this is not TOML: "), "{found:?}");
    assert!(found[3].starts_with("6:1: this is not TOML: duplicate key"), "{found:?}");
    assert!(!problems(&"[".repeat(100_000)).is_empty());
}

#[test]
fn files_that_cannot_be_read_or_written() {
    let folder = Folder::new("files");
    let missing = folder.0.join("missing.toml");
    let error = load_file(&mut tuned(), &missing).unwrap_err().to_string();
    assert_eq!(error, format!("cannot read `{}`: there is no such file", missing.display()));
    let error = load_file(&mut tuned(), &folder.0).unwrap_err().to_string();
    assert!(error.ends_with("it is a folder"), "{error}");
    let wrong = folder.0.join("wrong.toml");
    fs::write(&wrong, "[late]\ngain = 11\n\ngian = 1\n").unwrap();
    let (error, name) = (load_file(&mut tuned(), &wrong).unwrap_err().to_string(), wrong.display());
    assert_eq!(
        error,
        format!(
            "{name}:2:8: `late.gain` cannot be 11: its range is 0..=10\n\
             {name}:4:1: there is no parameter `late.gian`; did you mean `late.gain`?"
        )
    );
    assert!(save_file(&mut tuned(), folder.0.join("no/folder.toml")).is_err());
    assert!(save_file(&mut tuned(), folder.0.join("..")).is_err());
    #[cfg(unix)]
    {
        let socket = folder.0.join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        assert!(save_file(&mut tuned(), &socket).is_err(), "what is no file is not replaced by one");
    }
    fs::write(&wrong, b"\xff").unwrap();
    assert!(load_file(&mut tuned(), &wrong).unwrap_err().to_string().ends_with("byte 0 is not UTF-8"));
}

#[test]
fn a_run_with_files() {
    let folder = Folder::new("run");
    let (load, save) = (folder.0.join("load.toml"), folder.0.join("save.toml"));
    fs::write(&load, "late.gain = 4").unwrap();
    run_with_files(tuned(), SimClock::until(Time::from_millis(3)), Some(&load), Some(&save), None).unwrap();
    assert_eq!(fs::read_to_string(&save).unwrap(), SAVED.replace("gain = 1", "gain = 4"));
    fs::write(&load, "late.gain = 40").unwrap();
    fs::remove_file(&save).unwrap();
    run_with_files(tuned(), SimClock::until(Time::from_millis(3)), Some(&load), Some(&save), None).unwrap_err();
    assert!(!save.exists());
}

#[test]
fn parameters_are_set_and_read_between_reactions() {
    let mut program = tuned();
    react(&mut program, 1);
    program.set_param("late.gain", 9).unwrap();
    assert_eq!(program.param::<i64>("late.gain").unwrap(), 9);
    react(&mut program, 1);
    assert_eq!(program.nodes().late.seen, [1, 9]);

    let error = program.set_param("late.gain", 11).unwrap_err();
    assert!(matches!(error, ParamError::Refused { refusal: Rejection::Range, .. }));
    assert_eq!(error.to_string(), "the value of `late.gain` is out of range: its range is 0..=10");
    let error = program.set_param("late.gian", 1).unwrap_err();
    assert_eq!(error.to_string(), "there is no parameter of this name; did you mean `late.gain`?");
    assert!(matches!(program.set_param("x", 1), Err(ParamError::Unknown { nearest: None })));
    let error = program.set_param("late.gain", "1").unwrap_err();
    assert_eq!(error.to_string(), "`late.gain` (i64) takes an integer, not a string");
    assert!(program.set_param("kinds.mode", "Fast").is_err());
    assert!(program.param::<String>("late.gain").is_err());
    assert_eq!(program.param::<i64>("late.gain").unwrap(), 9);

    set_text(&mut program, "late.gain", "3").unwrap();
    set_text(&mut program, "kinds.rows", "[[5, 6], [7, 8]]").unwrap();
    assert!(set_text(&mut program, "late.gain", "3 4").is_err());
    assert_eq!(program.param::<i64>("late.gain").unwrap(), 3);
    assert_eq!(program.param::<[[u16; 2]; 2]>("kinds.rows").unwrap(), [[5, 6], [7, 8]]);
}

/// A saved number is loaded with the same value.
#[test]
fn single_precision_survives() {
    let mut bits = 1_u32;
    for _ in 0..100_000 {
        bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let value = f32::from_bits(bits);
        let text = ParamRef::Single(value).to_string();
        let read = f32::take(ParamRef::Float(text.parse().unwrap())).unwrap();
        assert!(read == value || value.is_nan() && read.is_nan(), "{text}");
    }
}

graph! {
    use apex_tests::nodes::{Gain, Settings};

    graph Ranges(
        gain: i64 = 4 in 1..=5,
        length: f64[cm] = 25 in 10..50,
        pause: Duration[s] = 1 in 1..=2,
        angle: f64[rad] = 0 in -1..=1,
        free: i64 = 3,
    ) {
        node inner   = Inner(gain = gain);
        node whole   = Settings(length = length, pause = pause, angle = angle, count = free);
        node derived = Settings(length = 2 * length);
        node other   = Inner(gain = 9);
        node handed  = Gain(gain = free);
    }

    graph Inner(gain: i64 in 3..=20) {
        node amplify = Gain(gain = gain);
    }
}

#[test]
fn the_range_of_a_parameter_that_is_passed_on_holds_at_run_time() {
    let mut program = Ranges::new();
    let range = |name: &str| Ranges::PARAMS.iter().find(|info| info.name == name).unwrap().range.to_string();
    let ranges = [
        ("inner.amplify.gain", "3..=5", &[3, 5][..], &[2, 6, 0][..]),
        ("other.amplify.gain", "3..=10", &[3, 10], &[2, 11]),
        ("handed.gain", "0..=10", &[0, 10], &[-1, 11]),
        ("whole.count", "..", &[-70, 70], &[]),
        ("whole.pause", "1..=2", &[1, 2], &[0, 3]),
        ("whole.angle", "-1..=1", &[-1, 0, 1], &[-2, 2]),
        ("whole.length", "0.1..0.5", &[], &[0, 1]),
        ("derived.length", "0..=100", &[0, 100], &[101]),
    ];
    for (name, known, inside, outside) in ranges {
        assert_eq!(range(name), known, "{name}");
        for value in inside {
            program.set_param(name, *value).unwrap_or_else(|error| panic!("{name} = {value}: {error}"));
        }
        for value in outside {
            let error = program.set_param(name, *value).unwrap_err();
            assert!(matches!(error, ParamError::Refused { refusal: Rejection::Range, .. }), "{name} = {value}");
        }
    }
    // Numbers, and those that are none.
    assert!(program.set_param("whole.length", 0.5).is_err() && program.set_param("whole.length", f64::NAN).is_err());
    program.set_param("whole.length", 0.1).unwrap();
    let error = set_text(&mut program, "inner.amplify.gain", "7").unwrap_err();
    assert!(error.to_string().contains("out of range: its range is 3..=5"), "{error}");
}
