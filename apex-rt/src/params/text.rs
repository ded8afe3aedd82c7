//! Parameters in TOML: one table per node, values in SI units.

use super::{
    Access, Given, GivenList, ParamError, ParamInfo, ParamRef, ParamVisitor, Parameters, Rejection, error::nearest,
};
use std::{
    collections::BTreeMap,
    fmt::{self, Write as _},
    path::PathBuf,
    string::{String, ToString as _},
    vec::Vec,
};
use toml::{
    Spanned,
    de::{DeArray, DeTable, DeValue},
};

/// An error in a text of parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Error message.
    pub message: String,
}

/// Reason why parameters were not loaded. No parameter was changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LoadError {
    /// The file cannot be read.
    Read {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// The text has errors.
    Text {
        /// The file with the text, if it comes from one.
        path: Option<PathBuf>,
        /// All errors, in the order of the text.
        problems: Vec<Problem>,
    },
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { path, reason } => write!(f, "cannot read `{}`: {reason}", path.display()),
            Self::Text { path, problems } => {
                for (index, problem) in problems.iter().enumerate() {
                    let Problem { line, column, message } = problem;
                    let end = if index > 0 { "\n" } else { "" };
                    match path {
                        Some(path) => write!(f, "{end}{}:{line}:{column}: {message}", path.display())?,
                        None => write!(f, "{end}line {line}, column {column}: {message}")?,
                    }
                }
                Ok(())
            }
        }
    }
}

impl std::error::Error for LoadError {}

/// Returns all parameters of `program` as a text for [`load`]: a table per node in the order of the graph, values in SI
/// units, units and ranges in comments. A parameter whose type is not a [`ParamValue`](super::ParamValue) is named in a
/// comment.
///
/// ```
/// use apex_rt::{params::save, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let mut smooth = Smooth::new();
/// assert_eq!(save(&mut smooth), "[filter]\nweight = 0.5 # 0..=1\n");
/// # }
/// ```
pub fn save<P: Parameters>(program: &mut P) -> String {
    let mut saved = Save::default();
    program.visit_params(&mut saved);
    saved.text
}

/// Returns the names of the parameters that [`save`] leaves out because their type is not a
/// [`ParamValue`](super::ParamValue).
///
/// ```
/// use apex_rt::{params::not_saved, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let mut smooth = Smooth::new();
/// assert!(not_saved(&mut smooth).is_empty());
/// # }
/// ```
pub fn not_saved<P: Parameters>(program: &mut P) -> Vec<&'static str> {
    let mut saved = Save::default();
    program.visit_params(&mut saved);
    saved.left_out
}

/// Sets the parameters in `text`, which has the form that [`save`] writes. All others keep their values.
///
/// ```
/// use apex_rt::{params::load, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let mut smooth = Smooth::new();
/// assert_eq!(load(&mut smooth, "[filter]\nweight = 0.25\n"), Ok(()));
/// assert_eq!(smooth.param("filter.weight"), Ok(0.25));
/// let error = load(&mut smooth, "[filter]\nweight = 3\n").expect_err("the largest weight is 1");
/// assert_eq!(error.to_string(), "line 2, column 10: `filter.weight` cannot be 3: its range is 0..=1");
/// # }
/// ```
///
/// # Errors
/// All errors in the text; then no parameter is changed.
pub fn load<P: Parameters>(program: &mut P, text: &str) -> Result<(), LoadError> {
    let mut problems = Problems { text, found: vec![] };
    let (document, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        problems.add(error.span().map_or(0, |span| span.start), format!("this is not TOML: {}", error.message()));
    }
    if !problems.found.is_empty() {
        return problems.result();
    }
    let mut file = File { params: P::PARAMS, values: BTreeMap::new(), problems };
    file.table("", document.get_ref());
    program.visit_params(&mut Check(&mut file));
    if !file.problems.found.is_empty() {
        return file.problems.result();
    }
    program.visit_params(&mut Set(&file));
    Ok(())
}

/// Sets the parameter `name` to a value in TOML: `1.5`, `true`, `"text"`, `[1, 2]`.
///
/// ```
/// use apex_rt::{params::set_text, prelude::*};
///
/// apex_macros::graph!("examples/smooth.afg");
///
/// # fn main() {
/// let mut smooth = Smooth::new();
/// assert_eq!(set_text(&mut smooth, "filter.weight", "0.25"), Ok(()));
/// assert_eq!(smooth.param("filter.weight"), Ok(0.25));
/// # }
/// ```
///
/// # Errors
/// The errors of [`Parameters::set_param`]. A `value` that is not valid TOML is refused as one of the wrong kind.
pub fn set_text<P: Parameters>(program: &mut P, name: &str, value: &str) -> Result<(), ParamError> {
    program.set_param(name, parsed(value))
}

/// Reads a value in TOML. Takes time and memory by its length.
pub(crate) fn parsed(text: &str) -> Given {
    let (value, mut room) = (DeValue::parse(text).ok(), usize::MAX);
    let copied = value.and_then(|value| Given::copy(given(value.get_ref()), &mut room));
    copied.unwrap_or(Given::Other("something that is not a TOML value"))
}

#[derive(Default)]
struct Save {
    text: String,
    /// The node of the current table.
    node: Option<&'static str>,
    left_out: Vec<&'static str>,
}

impl ParamVisitor for Save {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let (node, name) = info.name.rsplit_once('.').unwrap_or(("", info.name));
        if self.node != Some(node) {
            let path: Vec<String> = node.split('.').map(key).collect();
            let gap = if self.text.is_empty() { "" } else { "\n" };
            self.text += &format!("{gap}[{}]\n", path.join("."));
            self.node = Some(node);
        }
        let Some(access) = access else {
            self.left_out.push(info.name);
            self.text += &format!("# {name} is a `{}` and not saved\n", info.ty.replace(['\n', '\r'], " "));
            return;
        };
        let comment = comment(info);
        let gap = if comment.is_empty() { "" } else { " # " };
        // Writing into a string cannot fail.
        let _ = writeln!(self.text, "{} = {}{gap}{comment}", key(name), access.get());
    }
}

/// Returns the comment on a parameter: its unit and its range.
fn comment(info: &ParamInfo) -> String {
    let range = info.range.is_known().then(|| info.range.to_string());
    let parts: Vec<String> = info.unit.map(str::to_owned).into_iter().chain(range).collect();
    parts.join(", ")
}

/// Returns a name as a TOML key.
fn key(name: &str) -> String {
    let is_bare = !name.is_empty() && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-');
    if is_bare { name.to_owned() } else { ParamRef::Text(name).to_string() }
}

/// A value of the file, with its position as a byte offset.
struct Entry<'a> {
    at: usize,
    value: &'a DeValue<'a>,
}

/// Parsed text with values for the parameters of a program.
struct File<'a> {
    params: &'static [ParamInfo],
    values: BTreeMap<&'static str, Entry<'a>>,
    problems: Problems<'a>,
}

impl<'a> File<'a> {
    /// Reads a table. `prefix` is its name with a trailing dot, or empty.
    fn table(&mut self, prefix: &str, table: &'a DeTable<'a>) {
        for (key, value) in table {
            let name = format!("{prefix}{}", key.get_ref());
            self.entry(&name, key.span().start, value);
        }
    }

    fn entry(&mut self, name: &str, at: usize, value: &'a Spanned<DeValue<'a>>) {
        if let Some(param) = self.params.iter().find(|p| p.name == name) {
            self.values.insert(param.name, Entry { at: value.span().start, value: value.get_ref() });
            return;
        }
        let inner = format!("{name}.");
        let first = self.params.iter().find(|p| p.name.starts_with(&inner));
        match (value.get_ref(), first) {
            (DeValue::Table(table), Some(_)) => self.table(&inner, table),
            (_, Some(param)) => {
                let message = format!("`{name}` is a node: its parameters are in a table, such as `{}`", param.name);
                self.problems.add(at, message);
            }
            (DeValue::Table(_), None) => {
                let hint = self.hint(nearest(name, self.params.iter().filter_map(|p| node_of(p.name, name))));
                self.problems.add(at, format!("there is no node `{name}` with parameters; {hint}"));
            }
            (_, None) => {
                let hint = self.hint(nearest(name, self.params.iter().map(|p| p.name)));
                self.problems.add(at, format!("there is no parameter `{name}`; {hint}"));
            }
        }
    }

    fn hint(&self, near: Option<&str>) -> String {
        match near {
            Some(near) => format!("did you mean `{near}`?"),
            None if self.params.is_empty() => "the program has none: remove it".to_owned(),
            None => "remove it, or save the parameters to see all names".to_owned(),
        }
    }
}

/// Returns the leading part of `param` that has as many names as `like`.
fn node_of(param: &'static str, like: &str) -> Option<&'static str> {
    let dots = like.matches('.').count();
    param.match_indices('.').nth(dots).map(|(end, _)| &param[..end])
}

/// Visitor that finds values which would be refused.
struct Check<'a, 'b>(&'a mut File<'b>);

impl ParamVisitor for Check<'_, '_> {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        let Some(entry) = self.0.values.get(info.name) else { return };
        let value = given(entry.value);
        if let Err(refusal) = access.map_or(Err(Rejection::Opaque), |access| access.check(value)) {
            self.0.problems.add(entry.at, Refused { info, refusal, value }.to_string());
        }
    }
}

struct Refused<'a> {
    info: &'static ParamInfo,
    refusal: Rejection,
    value: ParamRef<'a>,
}

impl fmt::Display for Refused<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.refusal.say(self.info, Some(&self.value), f)
    }
}

/// Visitor that sets all values, which were checked before.
struct Set<'a, 'b>(&'a File<'b>);

impl ParamVisitor for Set<'_, '_> {
    fn param(&mut self, info: &'static ParamInfo, access: Option<&mut dyn Access>) {
        if let (Some(entry), Some(access)) = (self.0.values.get(info.name), access) {
            let set = access.set(given(entry.value));
            debug_assert_eq!(set, Ok(()), "`{}` was checked", info.name);
        }
    }
}

/// Converts a value of TOML to a value of a parameter.
fn given<'a>(value: &'a DeValue<'_>) -> ParamRef<'a> {
    match value {
        DeValue::String(text) => ParamRef::Text(text),
        DeValue::Integer(integer) => i128::from_str_radix(integer.as_str(), integer.radix())
            .map_or(ParamRef::Other("an integer with very many digits"), ParamRef::Integer),
        DeValue::Float(float) => {
            let value = float.as_str().parse::<f64>().ok();
            let value =
                value.filter(|value| value.is_finite() || !float.as_str().contains(|c: char| c.is_ascii_digit()));
            value.map_or(ParamRef::Other("a number that is too large"), ParamRef::Float)
        }
        DeValue::Boolean(value) => ParamRef::Bool(*value),
        DeValue::Datetime(_) => ParamRef::Other("a date"),
        DeValue::Array(array) => ParamRef::List(array),
        DeValue::Table(_) => ParamRef::Other("a table"),
    }
}

impl GivenList for DeArray<'_> {
    fn count(&self) -> usize {
        self.len()
    }

    fn element(&self, index: usize) -> ParamRef<'_> {
        self.get(index).map_or(ParamRef::Other("nothing"), |value| given(value.get_ref()))
    }
}

/// Errors in a text.
struct Problems<'a> {
    text: &'a str,
    found: Vec<(usize, String)>,
}

impl Problems<'_> {
    /// Adds an error at byte `at` of the text.
    fn add(&mut self, at: usize, message: String) {
        self.found.push((at, message));
    }

    fn result(mut self) -> Result<(), LoadError> {
        self.found.sort();
        let text = self.text;
        let problem = |(at, message): (usize, String)| {
            let before = text.get(..at).unwrap_or(text);
            let (line, start) = (before.matches('\n').count() + 1, before.rfind('\n').map_or(0, |end| end + 1));
            Problem { line, column: before[start..].chars().count() + 1, message }
        };
        Err(LoadError::Text { path: None, problems: self.found.into_iter().map(problem).collect() })
    }
}
