//! Types of tokens.

/// A type of tokens.
#[derive(Debug, PartialEq, Eq)]
pub struct Type {
    /// Notation in the source file and in Rust.
    pub name: &'static str,
    /// Item that declares it, unless it is in the standard library.
    pub item: &'static str,
    /// `true` if it implements `Clone`.
    pub clone: bool,
    /// `true` if it implements `Default`.
    pub default: bool,
    /// Values in the notation of the language.
    pub values: &'static [&'static str],
}

const fn ty(name: &'static str, item: &'static str, values: &'static [&'static str]) -> Type {
    Type { name, item, clone: true, default: true, values }
}

const fn without(name: &'static str, item: &'static str, clone: bool, default: bool) -> Type {
    Type { name, item, clone, default, values: &[] }
}

/// Types without special properties.
pub const PLAIN: &[Type] = &[
    ty("i64", "", &["3", "-7", "0", "9_000"]),
    ty("f64", "", &["1.5", "-0.25", "3", "1e3"]),
    ty("u8", "", &["7", "255", "0x1f"]),
    ty("bool", "", &["true", "false"]),
    ty("String", "", &["\"a text\"", "\"\""]),
    ty("Vec<f64>", "", &[]),
    ty("(f64, u8)", "", &[]),
    ty("Pose", POSE, &["crate::HOME", "crate::Pose { x: 1.5 }", "Pose { x: -2, }"]),
    ty("Phase", PHASE, &["crate::Phase::Idle", "crate::Phase::Busy"]),
    ty("Pair<i64>", PAIR, &["Pair { a: 3, b: -1 }", "crate::Pair { b: 2 * 3, a: 9_000 }"]),
    ty("Meters", "pub type Meters = f64;", &["2.5"]),
    ty("u32", "", &["70000", "1"]),
];

const POSE: &str = "#[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd)]\npub struct Pose {\n    pub x: f64,\n}\npub const HOME: Pose = Pose { x: 0.0 };";
const PHASE: &str =
    "#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]\npub enum Phase {\n    #[default]\n    Idle,\n    Busy,\n}";
const PAIR: &str =
    "#[derive(Debug, Clone, Copy, Default, PartialEq)]\npub struct Pair<T> {\n    pub a: T,\n    pub b: T,\n}";

/// Types without common traits, and types that are rarely sent.
pub const ODD: &[Type] = &[
    without("Solid", "#[derive(Debug, Default, PartialEq)]\npub struct Solid(pub u8);", false, true),
    without("Bare", "pub struct Bare;", false, false),
    without("Needed", "#[derive(Debug, Clone)]\npub struct Needed(pub u8);", true, false),
    without("Silent", "#[derive(Clone, Default)]\npub struct Silent(pub u8);", true, true),
    without("Shared", "#[derive(Debug, Clone, Default)]\npub struct Shared(pub std::rc::Rc<u8>);", true, true),
    without("std::rc::Rc<u8>", "", true, true),
    without("std::cell::Cell<u8>", "", true, true),
    without("Vec<Solid>", "#[derive(Debug, Default, PartialEq)]\npub struct Solid(pub u8);", false, true),
    ty("Option<f64>", "", &[]),
    ty("Box<i64>", "", &[]),
    ty("Vec<Vec<u8>>", "", &[]),
    without("Result<u8, String>", "", true, false),
    ty("Grid<3>", GRID, &[]),
    ty("char", "", &[]),
    ty("usize", "", &["4"]),
    ty("i128", "", &["4"]),
    ty("std::collections::BTreeMap<String, u8>", "", &[]),
    ty("inner::Deep", "pub mod inner {\n    #[derive(Debug, Clone, Default)]\n    pub struct Deep(pub u8);\n}", &[]),
    ty("(u8, (bool, String))", "", &[]),
    ty("core::time::Duration", "", &["2s"]),
    ty("Option<Option<u8>>", "", &[]),
    without("Box<dyn Fn() -> u8>", "", false, false),
];

const GRID: &str = "#[derive(Debug, Clone, Copy, Default, PartialEq)]\npub struct Grid<const N: usize>(pub [u8; 4], pub [(); N])\nwhere\n    [(); N]: Default;";

/// Types that do not exist, or have other type arguments.
pub const WRONG: &[&str] = &[
    "Pos2",
    "crate::Pos2",
    "Elsewhere",
    "crate::Elsewhere",
    "geometry_msgs::Pose",
    "nav::Path",
    "Vec",
    "Vec<u8, u8, u8>",
    "f64<u8>",
    "Pair",
    "Pair<u8, u8>",
    "Pose<u8>",
    "String<u8>",
    "Option",
    "Grid<u8>",
    "Grid",
    "Vec<Pos2>",
    "(f64, Pos2)",
    "[Pos2]",
    "Self",
    "T",
    "_",
    "i65",
    "float",
    "int",
    "string",
    "std::Nope",
    "Meters<u8>",
    "crate",
    "self",
    "crate::HOME",
    "HOME",
    "Box",
    "Result<u8>",
    "u8::MAX",
    "std::vec::Vec",
    "core::option",
    "apex_rt::Nope",
    "apex_rt::Event",
    "apex_rt::Event<u8>",
    "str",
    "dyn",
    "fn",
    "crate::inner::Nope",
    "super::Pose",
    "Phase::Idle",
    "Some<u8>",
    "HashMap<u8, u8>",
    "Rc<u8>",
    "[f64; 0]",
    "[f64; 1]",
    "pass",
    "core::time::Duration<u8>",
    "apex_nodes::scan::Nope",
    "apex_nodes::Scan",
    "()<u8>",
    "[u8; 99999999999]",
    "Vec<3>",
    "Pair<3>",
];
