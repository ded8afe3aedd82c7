//! Reader of definition files. A service becomes its two messages and their event, an action those of its services.

use crate::import::{Wrong, names};

/// Kind of a definition file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// `.msg`.
    Message,
    /// `.srv`: request and response.
    Service,
    /// `.action`: goal, result and feedback.
    Action,
}

/// Role of a type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Struct that is encoded.
    Message,
    /// Service, with fields for its hash only.
    Service,
    /// Action, with fields for its hash only.
    Action,
    /// Event of a service, for its hash only.
    Event,
}

/// A type with its fields.
#[derive(Debug, Clone)]
pub struct Type {
    /// Name: `sensor_msgs/msg/LaserScan`.
    pub name: String,
    pub role: Role,
    pub constants: Vec<Constant>,
    pub fields: Vec<Field>,
}

#[derive(Debug, Clone)]
pub struct Constant {
    pub ty: Plain,
    pub name: String,
    /// Value as it is written, without quotes.
    pub value: String,
}

#[derive(Debug, Clone)]
pub struct Field {
    pub name: String,
    pub element: Element,
    pub many: Many,
    /// Value by default, as it is written.
    pub default: Option<String>,
}

/// Type of a field, or of the elements of an array or a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Element {
    Plain(Plain),
    /// Text of at most so many bytes.
    Text(Option<usize>),
    /// Message of this name.
    Message(String),
}

/// Number of elements of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Many {
    One,
    Array(usize),
    /// List of at most so many elements.
    List(Option<usize>),
}

/// Type of a number, or of a truth value. A text has it only in constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plain {
    Bool,
    Byte,
    F32,
    F64,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    Text,
}

impl Plain {
    fn read(name: &str) -> Option<Self> {
        Some(match name {
            "bool" => Self::Bool,
            "byte" => Self::Byte,
            "float32" => Self::F32,
            "float64" => Self::F64,
            "int8" => Self::I8,
            "uint8" | "char" => Self::U8,
            "int16" => Self::I16,
            "uint16" => Self::U16,
            "int32" => Self::I32,
            "uint32" => Self::U32,
            "int64" => Self::I64,
            "uint64" => Self::U64,
            _ => return None,
        })
    }

    /// Name in definitions.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Byte => "byte",
            Self::F32 => "float32",
            Self::F64 => "float64",
            Self::I8 => "int8",
            Self::U8 => "uint8",
            Self::I16 => "int16",
            Self::U16 => "uint16",
            Self::I32 => "int32",
            Self::U32 => "uint32",
            Self::I64 => "int64",
            Self::U64 => "uint64",
            Self::Text => "string",
        }
    }

    /// Name in Rust.
    pub fn rust(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::I8 => "i8",
            Self::Byte | Self::U8 => "u8",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::Text => "&str",
        }
    }

    /// Value in Rust.
    pub fn value(self, text: &str) -> Option<String> {
        match self {
            Self::Bool => match text {
                "true" | "True" | "1" => Some("true".to_owned()),
                "false" | "False" | "0" => Some("false".to_owned()),
                _ => None,
            },
            Self::F32 | Self::F64 => text.parse::<f64>().ok().filter(|n| n.is_finite()).map(|n| format!("{n:?}")),
            Self::Text => Some(format!("{text:?}")),
            _ => {
                let (sign, digits) = text.strip_prefix('-').map_or(("", text), |digits| ("-", digits));
                let number = match digits.split_at_checked(2) {
                    Some(("0x" | "0X", digits)) => i128::from_str_radix(digits, 16).ok()?,
                    Some(("0b" | "0B", digits)) => i128::from_str_radix(digits, 2).ok()?,
                    Some(("0o" | "0O", digits)) => i128::from_str_radix(digits, 8).ok()?,
                    _ => digits.parse().ok()?,
                };
                let number = if sign.is_empty() { number } else { -number };
                self.range().contains(&number).then(|| number.to_string())
            }
        }
    }

    fn range(self) -> std::ops::RangeInclusive<i128> {
        let (bits, is_signed) = match self {
            Self::I8 => (8, true),
            Self::I16 => (16, true),
            Self::U16 => (16, false),
            Self::I32 => (32, true),
            Self::U32 => (32, false),
            Self::I64 => (64, true),
            Self::U64 => (64, false),
            _ => (8, false),
        };
        let one = 1_i128;
        if is_signed { -(one << (bits - 1))..=(one << (bits - 1)) - 1 } else { 0..=(one << bits) - 1 }
    }
}

impl Field {
    fn new(name: &str, message: &str, many: Many) -> Self {
        Self { name: name.to_owned(), element: Element::Message(message.to_owned()), many, default: None }
    }

    fn plain(name: &str, ty: Plain) -> Self {
        Self { name: name.to_owned(), element: Element::Plain(ty), many: Many::One, default: None }
    }

    /// Name of the message in the field.
    pub fn message(&self) -> Option<&str> {
        match &self.element {
            Element::Message(name) => Some(name),
            _ => None,
        }
    }
}

impl Type {
    /// Name of the package.
    pub fn package(&self) -> &str {
        self.name.split('/').next().unwrap_or_default()
    }

    /// Name of the struct: `SpinSendGoalRequest` for `nav2_msgs/action/Spin_SendGoal_Request`.
    pub fn rust_name(&self) -> String {
        names::camel(self.name.rsplit('/').next().unwrap_or_default())
    }

    /// The definition, without comments.
    pub fn text(&self) -> String {
        let constants = self.constants.iter().map(|Constant { ty, name, value }| {
            let quotes = if *ty == Plain::Text { "\"" } else { "" };
            format!("{} {name}={quotes}{value}{quotes}", ty.name())
        });
        let fields = self.fields.iter().map(|field| {
            let element = match &field.element {
                Element::Plain(ty) => ty.name().to_owned(),
                Element::Text(None) => "string".to_owned(),
                Element::Text(Some(most)) => format!("string<={most}"),
                Element::Message(name) => name.replacen("/msg/", "/", 1),
            };
            let many = match field.many {
                Many::One => String::new(),
                Many::Array(count) => format!("[{count}]"),
                Many::List(None) => "[]".to_owned(),
                Many::List(Some(most)) => format!("[<={most}]"),
            };
            let default = field.default.as_ref().map_or_else(String::new, |value| format!(" {value}"));
            format!("{element}{many} {}{default}", field.name)
        });
        constants.chain(fields).collect::<Vec<_>>().join("\n")
    }
}

/// Reads a file: the types in it.
pub fn read(text: &str, package: &str, name: &str, kind: Kind) -> Result<Vec<Type>, Wrong> {
    if !is_name(package) || !is_name(name) {
        return Err(Wrong::new(1, format!("`{package}/{name}` is not a name of a type")));
    }
    let mut parts = vec![(vec![], vec![])];
    for (index, line) in text.lines().enumerate() {
        let wrong = |message: String| Wrong::new(index + 1, message);
        let line = without_comment(line).trim();
        match line {
            "" => {}
            line if line.starts_with("---") => parts.push((vec![], vec![])),
            line => {
                let (constants, fields) = parts.last_mut().expect("there is one from the beginning");
                match statement(line, package).map_err(wrong)? {
                    Statement::Constant(constant) => constants.push(constant),
                    Statement::Field(field) if fields.iter().any(|other: &Field| other.name == field.name) => {
                        return Err(wrong(format!("two fields are named `{}`", field.name)));
                    }
                    Statement::Field(field) => fields.push(field),
                }
            }
        }
    }
    let (wanted, folder) = match kind {
        Kind::Message => (1, "msg"),
        Kind::Service => (2, "srv"),
        Kind::Action => (3, "action"),
    };
    if parts.len() != wanted {
        let found = parts.len();
        return Err(Wrong::new(
            1,
            format!("a `.{folder}` file has {wanted} parts with `---` between them, not {found}"),
        ));
    }
    let base = format!("{package}/{folder}/{name}");
    let part = |(constants, fields), suffix: &str| Type {
        name: format!("{base}{suffix}"),
        role: Role::Message,
        constants,
        fields,
    };
    let mut parts = parts.into_iter();
    let mut next = |suffix| parts.next().map(|found| part(found, suffix));
    Ok(match kind {
        Kind::Message => next("").into_iter().collect(),
        Kind::Service => service(&base, next("_Request"), next("_Response")),
        Kind::Action => action(&base, [next("_Goal"), next("_Result"), next("_Feedback")]),
    })
}

/// Types of a service.
fn service(base: &str, request: Option<Type>, response: Option<Type>) -> Vec<Type> {
    let (of_request, of_response, of_event) =
        (format!("{base}_Request"), format!("{base}_Response"), format!("{base}_Event"));
    let ty = |name: &str, role, fields| Type { name: name.to_owned(), role, constants: vec![], fields };
    let event = vec![
        Field::new("info", "service_msgs/msg/ServiceEventInfo", Many::One),
        Field::new("request", &of_request, Many::List(Some(1))),
        Field::new("response", &of_response, Many::List(Some(1))),
    ];
    let whole = vec![
        Field::new("request_message", &of_request, Many::One),
        Field::new("response_message", &of_response, Many::One),
        Field::new("event_message", &of_event, Many::One),
    ];
    let others = [ty(&of_event, Role::Event, event), ty(base, Role::Service, whole)];
    request.into_iter().chain(response).chain(others).collect()
}

/// Types of an action.
fn action(base: &str, parts: [Option<Type>; 3]) -> Vec<Type> {
    let name = |suffix: &str| format!("{base}{suffix}");
    let message = |suffix: &str, fields| Type { name: name(suffix), role: Role::Message, constants: vec![], fields };
    let id = || Field::new("goal_id", "unique_identifier_msgs/msg/UUID", Many::One);
    let stamp = Field::new("stamp", "builtin_interfaces/msg/Time", Many::One);
    let send_goal = service(
        &name("_SendGoal"),
        Some(message("_SendGoal_Request", vec![id(), Field::new("goal", &name("_Goal"), Many::One)])),
        Some(message("_SendGoal_Response", vec![Field::plain("accepted", Plain::Bool), stamp])),
    );
    let result = vec![Field::plain("status", Plain::I8), Field::new("result", &name("_Result"), Many::One)];
    let get_result = service(
        &name("_GetResult"),
        Some(message("_GetResult_Request", vec![id()])),
        Some(message("_GetResult_Response", result)),
    );
    let feedback = message("_FeedbackMessage", vec![id(), Field::new("feedback", &name("_Feedback"), Many::One)]);
    let whole = [
        ("goal", "_Goal"),
        ("result", "_Result"),
        ("feedback", "_Feedback"),
        ("send_goal_service", "_SendGoal"),
        ("get_result_service", "_GetResult"),
        ("feedback_message", "_FeedbackMessage"),
    ];
    let fields = whole.map(|(field, part)| Field::new(field, &name(part), Many::One)).into();
    let whole = Type { name: base.to_owned(), role: Role::Action, constants: vec![], fields };
    parts.into_iter().flatten().chain(send_goal).chain(get_result).chain([feedback, whole]).collect()
}

/// The line up to a `#` outside of quotes.
fn without_comment(line: &str) -> &str {
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match (quote, c) {
            (None, '#') => return &line[..at],
            (None, '"' | '\'') => quote = Some(c),
            (Some(open), _) if open == c => quote = None,
            _ => {}
        }
    }
    line
}

enum Statement {
    Constant(Constant),
    Field(Field),
}

fn statement(line: &str, package: &str) -> Result<Statement, String> {
    let (ty, rest) =
        line.split_once(char::is_whitespace).ok_or_else(|| format!("a field needs a type and a name: `{line}`"))?;
    let rest = rest.trim();
    let end = rest.find(|c: char| c.is_whitespace() || c == '=').unwrap_or(rest.len());
    let (name, rest) = rest.split_at(end);
    if !is_name(name) {
        return Err(format!("`{name}` is not a name of a field"));
    }
    let rest = rest.trim();
    if let Some(value) = rest.strip_prefix('=') {
        return constant(ty, name, value.trim()).map(Statement::Constant);
    }
    let (element, many) = field_type(ty, package)?;
    let default = Some(rest.to_owned()).filter(|value| !value.is_empty());
    Ok(Statement::Field(Field { name: name.to_owned(), element, many, default }))
}

fn constant(ty: &str, name: &str, value: &str) -> Result<Constant, String> {
    let plain = if ty == "string" { Some(Plain::Text) } else { Plain::read(ty) };
    let plain = plain.ok_or_else(|| format!("a constant of type `{ty}`: only numbers, truth values and texts"))?;
    let value = if plain == Plain::Text { value.trim_matches(['"', '\'']) } else { value };
    if plain.value(value).is_none() {
        return Err(format!("`{value}` is not a value of type `{ty}`"));
    }
    Ok(Constant { ty: plain, name: name.to_owned(), value: value.to_owned() })
}

fn field_type(ty: &str, package: &str) -> Result<(Element, Many), String> {
    let number = |text: &str| text.parse().map_err(|_| format!("`{text}` in `{ty}` is not a number"));
    let (element, many) = match ty.strip_suffix(']').and_then(|ty| ty.rsplit_once('[')) {
        None => (ty, Many::One),
        Some((element, "")) => (element, Many::List(None)),
        Some((element, count)) => match count.strip_prefix("<=") {
            Some(most) => (element, Many::List(Some(number(most)?))),
            None => (element, Many::Array(number(count)?)),
        },
    };
    if let Many::Array(0) = many {
        return Err(format!("`{ty}` is an array without elements"));
    }
    if let Many::Array(1_000_000..) = many {
        return Err(format!("`{ty}` is an array of more than a million elements"));
    }
    if element.starts_with("wstring") {
        return Err("the type `wstring` is not supported: use `string`, which is UTF-8".to_owned());
    }
    if let Some(plain) = Plain::read(element) {
        return Ok((Element::Plain(plain), many));
    }
    if let Some(bound) = element.strip_prefix("string") {
        match bound.strip_prefix("<=") {
            None if bound.is_empty() => return Ok((Element::Text(None), many)),
            Some(most) => return Ok((Element::Text(Some(number(most)?)), many)),
            None => {}
        }
    }
    let parts: Vec<&str> = element.split('/').collect();
    let name = match parts.as_slice() {
        // As in ROS 1.
        ["Header"] if package != "std_msgs" => "std_msgs/msg/Header".to_owned(),
        ["time"] => "builtin_interfaces/msg/Time".to_owned(),
        ["duration"] => "builtin_interfaces/msg/Duration".to_owned(),
        [name] if is_name(name) => format!("{package}/msg/{name}"),
        [package, name] | [package, "msg", name] if is_name(package) && is_name(name) => {
            format!("{package}/msg/{name}")
        }
        // Parts of services and actions, as the definitions of these are written here.
        [package, folder @ ("srv" | "action"), name] if is_name(package) && is_name(name) => {
            format!("{package}/{folder}/{name}")
        }
        _ => return Err(format!("`{element}` is not a name of a type")),
    };
    Ok((Element::Message(name), many))
}

fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_ascii_alphabetic()) && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}
