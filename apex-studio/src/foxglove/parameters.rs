//! Parameters of an app, in JSON, and of a robot, in TOML.

use super::messages::Parameter;
use crate::live::{Live, Param};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// `true` for the type of a parameter that is a number with a fraction.
fn is_float(ty: &str) -> bool {
    matches!(ty, "f32" | "f64")
}

fn type_of<'a>(live: &'a Live, name: &str) -> &'a str {
    let about = live.about.iter().flat_map(|about| &about.params);
    about.filter(|param| param.name == name).map(|param| param.ty.as_str()).next().unwrap_or_default()
}

/// Returns a parameter as an app shows it.
fn parameter(live: &Live, name: &str, param: &Param) -> Parameter {
    let value = param.value.parse::<toml::Value>().ok().and_then(|value| serde_json::to_value(value).ok());
    // There are no infinite numbers in JSON.
    let value = value.filter(|value| !value.is_null()).unwrap_or_else(|| Value::String(param.value.clone()));
    let kind = (is_float(type_of(live, name)) && value.is_number()).then(|| "float64".to_owned());
    Parameter { name: name.to_owned(), value: Some(value), kind }
}

/// Returns the parameters with these names; without names, all.
pub fn parameters<'a>(live: &Live, names: impl IntoIterator<Item = &'a String>) -> Vec<Parameter> {
    let names: BTreeSet<&String> = names.into_iter().collect();
    let is_wanted = |(name, param): &(&String, &Param)| (names.is_empty() || names.contains(name)) && !param.fixed;
    live.params.iter().filter(is_wanted).map(|(name, param)| parameter(live, name, param)).collect()
}

/// Returns the value of an app in TOML.
///
/// # Errors
/// There is none, or TOML has no such value.
pub fn text(live: &Live, given: &Parameter) -> Result<String, String> {
    let Parameter { name, value, .. } = given;
    let value = value.as_ref().ok_or_else(|| format!("`{name}` cannot be removed"))?;
    // Apps do not know whole numbers from others.
    if let Some(number) = value.as_f64().filter(|_| is_float(type_of(live, name))) {
        return Ok(format!("{number:?}"));
    }
    let value = toml::Value::try_from(value).map_err(|error| format!("`{name}`: {error}"))?;
    Ok(value.to_string())
}

/// Parameters of which an app wants to know each change.
#[derive(Default)]
pub struct Followed(BTreeMap<String, u64>);

impl Followed {
    /// Follows parameters; without names, all.
    pub fn add(&mut self, live: &Live, names: &[String]) {
        let is_new = |name: &String| names.is_empty() || names.contains(name);
        for (name, param) in live.params.iter().filter(|(name, _)| is_new(name)) {
            self.0.entry(name.clone()).or_insert(param.version);
        }
    }

    /// Follows them no longer; without names, none.
    pub fn remove(&mut self, names: &[String]) {
        self.0.retain(|name, _| !(names.is_empty() || names.contains(name)));
    }

    /// Returns those that have changed.
    pub fn news(&mut self, live: &Live) -> Vec<Parameter> {
        let mut news = vec![];
        for (name, seen) in &mut self.0 {
            if let Some(param) = live.params.get(name).filter(|param| param.version != *seen) {
                *seen = param.version;
                news.push(parameter(live, name, param));
            }
        }
        news
    }
}

/// A request for new values that the robot has not answered yet.
pub struct Pending {
    /// Name of the request, if it has one.
    pub id: Option<String>,
    /// The parameters, with the number of messages about them before.
    pub versions: BTreeMap<String, u64>,
}

impl Pending {
    /// `true` if the robot has answered.
    pub fn is_answered(&self, live: &Live) -> bool {
        self.versions.iter().all(|(name, version)| live.params.get(name).is_none_or(|param| param.version != *version))
    }

    /// Returns the reasons why parameters were not set.
    pub fn errors(&self, live: &Live) -> Vec<String> {
        let error = |name: &String| Some(format!("`{name}` was not set: {}", live.params.get(name)?.error.as_ref()?));
        self.versions.keys().filter_map(error).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::robot;
    use apex_rt::studio::message::{AboutParam, Report};
    use serde_json::json;

    /// A robot with parameters of these names, types and values.
    fn live(params: &[(&str, &str, &str)]) -> Live {
        let about = |(name, ty, _): &(&str, &str, &str)| AboutParam {
            name: (*name).into(),
            ty: (*ty).into(),
            unit: None,
            min: None,
            max: None,
        };
        let mut live = Live::default();
        live.begin(apex_rt::studio::message::About { params: params.iter().map(about).collect(), ..robot(&[]) });
        for (name, _, value) in params {
            live.note(Report::Param { name: (*name).into(), value: Ok((*value).into()), reactions: None });
        }
        live
    }

    #[test]
    fn values_of_a_robot_are_those_of_an_app() {
        let values = [
            ("a", "f64", "1.5", json!(1.5), true),
            ("b", "i64", "-3", json!(-3), false),
            ("c", "bool", "true", json!(true), false),
            ("d", "String", "\"x\"", json!("x"), false),
            ("e", "[f64; 2]", "[1.0, 2.5]", json!([1.0, 2.5]), false),
            ("f", "f32", "inf", json!("inf"), false),
        ];
        let live = live(&values.each_ref().map(|(name, ty, text, ..)| (*name, *ty, *text)));
        let expected = values.map(|(name, _, _, value, is_float)| Parameter {
            name: name.to_owned(),
            value: Some(value),
            kind: is_float.then(|| "float64".to_owned()),
        });
        assert_eq!(parameters(&live, &[]), expected);
        assert_eq!(parameters(&live, &["b".to_owned(), "unknown".to_owned()]), expected[1..2]);
    }

    #[test]
    fn values_of_an_app_are_those_of_a_robot() {
        let live = live(&[("a", "f64", "1.0"), ("b", "i64", "1")]);
        let given = |name: &str, value| text(&live, &Parameter { name: name.to_owned(), value, kind: None });
        assert_eq!(given("a", Some(json!(3))).as_deref(), Ok("3.0"));
        assert_eq!(given("b", Some(json!(3))).as_deref(), Ok("3"));
        assert_eq!(given("b", Some(json!([true, "x"]))).as_deref(), Ok("[true, \"x\"]"));
        assert!(given("a", None).unwrap_err().contains("cannot be removed"));
        assert!(given("a", Some(Value::Null)).is_err());
    }
}
