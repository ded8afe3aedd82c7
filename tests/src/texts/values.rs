//! Parameters of nodes and graphs, with valid and invalid values.

/// A type of parameters.
#[derive(Debug, PartialEq, Eq)]
pub struct Param {
    /// Type in Rust.
    pub ty: &'static str,
    /// Default in Rust.
    pub default: &'static str,
    /// Item that the type needs.
    pub item: &'static str,
    /// Valid values.
    pub good: &'static [&'static str],
    /// Invalid values.
    pub bad: &'static [&'static str],
}

const fn param(
    ty: &'static str,
    default: &'static str,
    item: &'static str,
    good: &'static [&'static str],
    bad: &'static [&'static str],
) -> Param {
    Param { ty, default, item, good, bad }
}

const PHASE: &str =
    "#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]\npub enum Phase {\n    #[default]\n    Idle,\n    Busy,\n}";
const POSE: &str = "#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd)]\npub struct Pose {\n    pub x: f64,\n}\npub const HOME: Pose = Pose { x: 0.0 };";

/// All types of parameters.
pub const PARAMS: &[Param] = &[
    param(
        "u8",
        "3",
        "",
        &["1", "255", "0xf", "2 * 3", "7 % 4"],
        &["300", "-1", "1.5", "1e40", "\"s\"", "true", "5m", "256", "7 % 0", "1 / 0"],
    ),
    param("i8", "-3", "", &["-128", "127"], &["128", "-129", "0x80", "1e3"]),
    param("u16", "3", "", &["65535"], &["65536", "-0.5", "[1]"]),
    param("i64", "3", "", &["-5", "9223372036854775807"], &["9223372036854775808", "1e40", "0.5", "[]"]),
    param("u64", "3", "", &["18446744073709551615"], &["18446744073709551616", "-1"]),
    param("usize", "3", "", &["4"], &["-4", "99999999999999999999"]),
    param("f32", "0.5", "", &["1", "1e10", "-2.5"], &["1e40", "-1e39", "\"s\"", "3s", "1e400"]),
    param("f64", "0.5", "", &["1", "1e300", "-2.5", "1 / 4"], &["1e400", "true", "[1]", "1 / 0", "0 / 0", "1.5 % 0"]),
    param("bool", "true", "", &["true", "!true", "1 < 2"], &["1", "\"true\"", "!1"]),
    param("String", "String::new()", "", &["\"a\"", "\"\\n\\\"\""], &["1", "true", "[\"a\"]"]),
    param("&'static str", "\"x\"", "", &["\"a\""], &["1", "a"]),
    param("core::time::Duration", "1", "", &["2s", "5ms", "0s"], &["-1s", "5", "1e30s", "\"1s\"", "3m"]),
    param(
        "[f64; 2]",
        "[1.0, 2.0]",
        "",
        &["[1, 2]", "[0.5, -1]"],
        &["[1]", "[1, 2, 3]", "[1, \"s\"]", "1", "[1s, 2s]", "[[1, 2], [3, 4]]"],
    ),
    param("[[u8; 2]; 2]", "[[1; 2]; 2]", "", &["[[1, 2], [3, 4]]"], &["[[1, 2]]", "[1, 2]", "[[1, 2], [3, 300]]"]),
    param("&'static [f64]", "&[1.0]", "", &["[1, 2]", "[]"], &["1", "[true]"]),
    param(
        "Phase",
        "Phase::Idle",
        PHASE,
        &["crate::Phase::Busy"],
        &["crate::Phase::Nope", "crate::Phase", "Phase", "Idle", "1", "\"Idle\""],
    ),
    param(
        "Pose",
        "HOME",
        POSE,
        &["crate::HOME", "crate::Pose { x: 1 / 4 }", "Pose { x: 3 }"],
        &[
            "1",
            "crate::Pose",
            "HOME",
            "[1]",
            "Pose { }",
            "Pose { x: true }",
            "Pose { y: 1 }",
            "Pose { x: 1m }",
            "Phase { }",
        ],
    ),
    param("Option<f64>", "None", "", &[], &["5", "true", "None", "Some", "crate::MAYBE"]),
    param("Vec<u8>", "Vec::new()", "", &[], &["[1, 2]", "1", "[]"]),
    param("char", "'c'", "", &[], &["\"c\"", "99"]),
    param("(u8, u8)", "(1, 2)", "", &[], &["[1, 2]", "1"]),
    param("std::num::NonZeroU8", "std::num::NonZeroU8::MIN", "", &[], &["1", "0"]),
];

/// Constants beside the graph.
pub const CONSTANTS: &str = "pub const GAIN: f64 = 1.5;\npub const NUMBER: i64 = 3;\npub const SMALL: u8 = 3;\npub const MAYBE: Option<f64> = None;\npub const TEXT: &str = \"text\";\npub static STILL: u8 = 3;\nconst HIDDEN: u8 = 3;\npub mod limits {\n    pub const TOP: u8 = 9;\n    const LOW: u8 = 1;\n    pub const SUM: u8 = TOP + LOW;\n}\npub fn made() -> u8 {\n    HIDDEN + limits::SUM\n}";

/// Paths of constants, of any type or missing.
pub const PATHS: &[&str] = &[
    "crate::AWAY",
    "crate::GAIN",
    "crate::NUMBER",
    "crate::SMALL",
    "crate::MAYBE",
    "crate::TEXT",
    "crate::STILL",
    "crate::HIDDEN",
    "crate::limits::TOP",
    "crate::limits::LOW",
    "crate::MISSING",
    "crate::made",
    "crate::limits",
    "GAIN",
    "SMALL",
    "limits::TOP",
    "std::f64::consts::PI",
    "core::f64::consts::PI",
    "core::u8::MAX",
    "u8::MAX",
    "f64::NAN",
    "crate::Self",
    "crate",
    "self::GAIN",
    "super::GAIN",
    "crate::GAIN::X",
    "apex_rt::Nope",
    "apex_nodes::NOPE",
    "None",
    "crate::limits::SUM + 1",
    "-crate::NUMBER",
    "crate::SMALL * 2",
];
