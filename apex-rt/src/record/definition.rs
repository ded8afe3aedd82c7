//! Comparison of the definitions of messages by what they encode: the numbers and texts in their order, with the names
//! of their fields. Comments, constants, defaults, and the forms of type names do not matter.

use std::collections::BTreeMap;

/// Maximum depth of messages in messages.
const MAX_DEPTH: usize = 16;
/// Maximum number of fields, so that messages of messages end.
const MAX_FIELDS: usize = 10_000;

/// Types that definitions may leave out, because every program knows them.
const KNOWN: [(&str, &str); 3] = [
    ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"),
    ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec"),
    ("builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"),
];

/// Types that are not messages.
const PLAIN: [&str; 13] = [
    "bool", "float32", "float64", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "string",
    "wstring",
];

/// Returns the first fields in which two definitions differ; `None` if they are the same. A missing one is `nothing`.
pub fn difference(was: &str, is: &str) -> Option<(String, String)> {
    let (was, is) = (fields(was), fields(is));
    let same = was.iter().zip(&is).take_while(|(was, is)| was == is).count();
    let place = |fields: &[String]| fields.get(same).map_or_else(|| "nothing".to_owned(), String::clone);
    (same < was.len().max(is.len())).then(|| (place(&was), place(&is)))
}

/// Returns the definition of a message of ROS 1 as ROS 2 has it: times are messages, and headers have no number.
pub fn of_ros1(definition: &str) -> String {
    let (mut text, mut is_header) = (String::new(), false);
    for line in definition.lines() {
        let (ty, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line, ""));
        if ty == "MSG:" {
            is_header = rest.trim() == "std_msgs/Header";
        }
        let (plain, array) = ty.find('[').map_or((ty, ""), |at| ty.split_at(at));
        let plain = match plain {
            "time" => "builtin_interfaces/Time",
            "duration" => "builtin_interfaces/Duration",
            "Header" => "std_msgs/Header",
            other => other,
        };
        if !(is_header && ty == "uint32" && rest.trim() == "seq") {
            text.extend([plain, array, " ", rest, "\n"]);
        }
    }
    text
}

/// Fields of plain types with their names: `float64 pose.position.x`.
fn fields(definition: &str) -> Vec<String> {
    let mut messages = BTreeMap::new();
    let (mut name, mut lines) = (String::new(), vec![]);
    for line in definition.lines() {
        if let Some(next) = line.trim().strip_prefix("MSG:") {
            messages.entry(name).or_insert(std::mem::take(&mut lines));
            name = whole(next.trim());
        } else {
            lines.extend(Field::read(line));
        }
    }
    messages.entry(name).or_insert(lines);
    for (name, text) in KNOWN {
        messages.entry(name.to_owned()).or_insert_with(|| text.lines().filter_map(Field::read).collect());
    }
    let mut fields = vec![];
    add("", "", &messages, 0, &mut fields);
    fields
}

/// Field of a message.
struct Field<'a> {
    ty: &'a str,
    /// Suffix of an array, in a single form; empty for others.
    array: String,
    name: &'a str,
}

impl<'a> Field<'a> {
    /// Reads a line; `None` for one without a field.
    fn read(line: &'a str) -> Option<Self> {
        let mut words = line.split('#').next()?.split_whitespace();
        let (ty, name) = (words.next()?, words.next()?);
        // A constant; its value may follow without a space.
        if name.contains('=') || words.next().is_some_and(|word| word.starts_with('=')) {
            return None;
        }
        let (ty, array) = ty.split_once('[').unwrap_or((ty, ""));
        // Bounds do not change what is encoded.
        let ty = ty.split("<=").next().unwrap_or(ty);
        let array = match array.strip_suffix(']') {
            Some(count) if count.starts_with("<=") => "[]".to_owned(),
            Some(count) => format!("[{count}]"),
            None => String::new(),
        };
        let ty = match ty {
            "byte" | "char" => "uint8",
            ty => ty,
        };
        Some(Self { ty, array, name })
    }
}

/// Name of a type without `msg`: `std_msgs/Header` for `std_msgs/msg/Header`.
fn whole(name: &str) -> String {
    name.replace("/msg/", "/")
}

/// Adds the fields of the message `name` in the field `path`.
fn add(
    name: &str,
    path: &str,
    messages: &BTreeMap<String, Vec<Field<'_>>>,
    depth: usize,
    fields: &mut Vec<String>,
) -> bool {
    let Some(message) = messages.get(name).filter(|_| depth < MAX_DEPTH && fields.len() < MAX_FIELDS) else {
        return false;
    };
    for field in message {
        let path = if path.is_empty() { field.name.to_owned() } else { format!("{path}.{}", field.name) };
        let path = path + &field.array;
        let is_plain = PLAIN.contains(&field.ty);
        if is_plain || !add(&resolve(field.ty, name, messages), &path, messages, depth + 1, fields) {
            fields.push(format!("{} {path}", field.ty));
        }
    }
    true
}

/// Whole name of a type, which may be written without the package that it shares with the message around it.
fn resolve(ty: &str, around: &str, messages: &BTreeMap<String, Vec<Field<'_>>>) -> String {
    let ty = whole(ty);
    if ty.contains('/') {
        return ty;
    }
    let package = around.split('/').next().unwrap_or_default();
    let near = format!("{package}/{ty}");
    if messages.contains_key(&near) {
        return near;
    }
    // The package of the outermost message is not in its definition.
    let is_it = |name: &&String| name.rsplit('/').next() == Some(&ty);
    messages.keys().find(is_it).cloned().unwrap_or(ty)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OURS: &str = "std_msgs/Header header\ngeometry_msgs/Pose pose\n===\nMSG: geometry_msgs/Pose\n\
                        geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n===\n\
                        MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n===\n\
                        MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w";

    #[test]
    fn definitions_of_ros_are_the_same_in_other_words() {
        let theirs = "# A Pose with reference coordinate frame and timestamp\n\nstd_msgs/Header header\nPose pose\n\n\
                      ===\nMSG: geometry_msgs/msg/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0 # up\nfloat64 w 1\n\
                      ===\nMSG: geometry_msgs/Pose\n  Point position\nQuaternion  orientation\n\
                      ===\nMSG: geometry_msgs/Point\n# in m\nfloat64 x\nfloat64 y\nfloat64 z\n\
                      ===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
        assert_eq!(difference(theirs, OURS), None);
        let constants = "uint8 INT8    = 1\nuint8 UINT8=2\nstring name\nuint32 offset";
        assert_eq!(difference(constants, "string name\nuint32 offset"), None);
        assert_eq!(difference("byte[<=4] a\nstring<=9 b", "uint8[] a\nstring b"), None);
    }

    #[test]
    fn definitions_of_ros_1_are_those_of_ros_2() {
        let theirs = "Header header\ntime[] times\n===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id";
        assert_eq!(difference(&of_ros1(theirs), "std_msgs/Header header\nbuiltin_interfaces/Time[] times"), None);
        let changed = difference(&of_ros1("uint32 seq\nduration lasts"), "uint32 seq\nfloat64 lasts");
        assert_eq!(changed, Some(("int32 lasts.sec".to_owned(), "float64 lasts".to_owned())));
    }

    #[test]
    fn another_field_type_or_order_is_a_difference() {
        let found = difference(&OURS.replace("Point\nfloat64 x", "Point\nfloat32 x"), OURS);
        let pair = |was: &str, is: &str| Some((was.to_owned(), is.to_owned()));
        assert_eq!(found, pair("float32 pose.position.x", "float64 pose.position.x"));
        assert_eq!(difference("float32 a\nfloat32 b", "float32 b\nfloat32 a"), pair("float32 a", "float32 b"));
        assert_eq!(difference("float32 a", "float32 a\nfloat32 b"), pair("nothing", "float32 b"));
        assert_eq!(difference("float32[3] a", "float32[4] a"), pair("float32 a[3]", "float32 a[4]"));
        assert_eq!(difference("pkg/Unknown a", "pkg/Other a"), pair("pkg/Unknown a", "pkg/Other a"));
    }

    #[test]
    fn messages_of_themselves_end() {
        let endless = "pkg/A a\npkg/A b\n===\nMSG: pkg/A\npkg/A a\npkg/A b\nfloat32 c";
        assert_eq!(difference(endless, endless), None);
        assert!(fields(endless).len() < 10 * MAX_FIELDS);
    }
}
