//! Types and constants of the standard library and of the runtime that source files may name by their path. These
//! crates are not scanned. Their other items, and those of other such crates, need a name in Rust first.

/// Primitive types of Rust.
pub const PRIMITIVES: [&str; 17] = [
    "bool", "char", "str", "u8", "u16", "u32", "u64", "u128", "usize", "i8", "i16", "i32", "i64", "i128", "isize",
    "f32", "f64",
];
/// Types of the standard library that need no import.
pub const STD: [&str; 4] = ["Vec", "Option", "String", "Box"];
/// The type of durations, which source files can name without an import.
pub const DURATION: &str = "Duration";
/// The type of points in time, which source files can name without an import, too.
pub const TIME: &str = "Time";
/// Names of the standard library.
pub const STANDARD: [&str; 3] = ["std", "core", "alloc"];
/// The crate of the runtime.
pub const RUNTIME: &str = "apex_rt";

/// Types of the standard library by their path in it, with the smallest and largest number of type arguments.
const TYPES: [(&str, usize, usize); 44] = [
    ("borrow::Cow", 1, 1),
    ("boxed::Box", 1, 1),
    ("cell::Cell", 1, 1),
    ("cell::RefCell", 1, 1),
    ("collections::BTreeMap", 2, 2),
    ("collections::BTreeSet", 1, 1),
    ("collections::BinaryHeap", 1, 1),
    ("collections::HashMap", 2, 3),
    ("collections::HashSet", 1, 2),
    ("collections::LinkedList", 1, 1),
    ("collections::VecDeque", 1, 1),
    ("ffi::CString", 0, 0),
    ("ffi::OsString", 0, 0),
    ("marker::PhantomData", 1, 1),
    ("net::IpAddr", 0, 0),
    ("net::Ipv4Addr", 0, 0),
    ("net::Ipv6Addr", 0, 0),
    ("net::SocketAddr", 0, 0),
    ("num::NonZeroI16", 0, 0),
    ("num::NonZeroI32", 0, 0),
    ("num::NonZeroI64", 0, 0),
    ("num::NonZeroI8", 0, 0),
    ("num::NonZeroU16", 0, 0),
    ("num::NonZeroU32", 0, 0),
    ("num::NonZeroU64", 0, 0),
    ("num::NonZeroU8", 0, 0),
    ("num::NonZeroUsize", 0, 0),
    ("num::Wrapping", 1, 1),
    ("ops::ControlFlow", 1, 2),
    ("ops::Range", 1, 1),
    ("ops::RangeInclusive", 1, 1),
    ("option::Option", 1, 1),
    ("path::PathBuf", 0, 0),
    ("rc::Rc", 1, 1),
    ("result::Result", 2, 2),
    ("string::String", 0, 0),
    ("sync::Arc", 1, 1),
    ("sync::Mutex", 1, 1),
    ("sync::RwLock", 1, 1),
    ("task::Poll", 1, 1),
    ("time::Duration", 0, 0),
    ("time::Instant", 0, 0),
    ("time::SystemTime", 0, 0),
    ("vec::Vec", 1, 1),
];
/// Types of the runtime that can be tokens.
const RUNTIME_TYPES: [&str; 2] = ["Failure", "Time"];
/// Returns `true` if a path begins with a crate of which only the names in this file are known.
pub fn is_listed(path: &[String]) -> bool {
    path.first().is_some_and(|name| STANDARD.contains(&name.as_str()) || name == RUNTIME)
}

/// Returns `true` if the name of a type that is not scanned is one of the standard library. Such a type is not an alias
/// of a number or a list.
pub fn is_standard(name: &str) -> bool {
    STD.contains(&name) || name.split("::").next().is_some_and(|krate| STANDARD.contains(&krate))
}

/// Name of a listed type in its crate, which is the same whichever crate of the standard library it is taken from. Such
/// a type is an alias of no other one.
pub fn name_of_listed(path: &str) -> Option<&'static str> {
    if let Some(name) = STD.into_iter().find(|name| *name == path) {
        return Some(name);
    }
    let (krate, name) = path.split_once("::")?;
    listed(krate, name).map(|(name, ..)| name)
}

/// The entry of a type of a crate, with the smallest and largest number of its type arguments.
fn listed(krate: &str, name: &str) -> Option<(&'static str, usize, usize)> {
    match krate {
        RUNTIME => RUNTIME_TYPES.into_iter().find(|listed| *listed == name).map(|name| (name, 0, 0)),
        _ if STANDARD.contains(&krate) => TYPES.into_iter().find(|(listed, ..)| *listed == name),
        _ => None,
    }
}

/// Name without a path of a type that needs no import.
pub fn short(path: &[String]) -> Option<&'static str> {
    let [krate, _, name] = path else { return None };
    let is_standard = STANDARD.contains(&krate.as_str()) && type_arguments(path).is_some();
    STD.into_iter().find(|short| is_standard && short == name)
}

/// Smallest and largest number of type arguments of a listed type.
pub fn type_arguments(path: &[String]) -> Option<(usize, usize)> {
    let (krate, rest) = path.split_first()?;
    listed(krate, &rest.join("::")).map(|(_, fewest, most)| (fewest, most))
}
