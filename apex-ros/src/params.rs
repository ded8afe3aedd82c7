//! The parameters of a program as those of its node in ROS 2.

use crate::{Error, Publisher, Ros, time::RosTime};
use apex_messages::{
    builtin_interfaces::Time,
    rcl_interfaces::{
        DescribeParameters, DescribeParametersResponse, FloatingPointRange, GetParameterTypes,
        GetParameterTypesResponse, GetParameters, GetParametersResponse, IntegerRange, ListParameters,
        ListParametersRequest, ListParametersResponse, ListParametersResult, Parameter, ParameterDescriptor,
        ParameterEvent, ParameterType as Kind, ParameterValue, SetParameters, SetParametersAtomically,
        SetParametersAtomicallyResponse, SetParametersResponse, SetParametersResult,
    },
};
use apex_rt::{
    RemoteParams,
    params::{GivenList, IntoParam, ParamInfo, ParamRef, ParamValue, Rejection},
};
use std::sync::{Arc, OnceLock};

/// The parameter that every node has. It is fixed when the node starts.
pub const SIM_TIME: &str = "use_sim_time";

impl Ros {
    /// Offers the parameters of a program as those of the node: `ros2 param set /rover mission.near 0.5`. Parameters
    /// whose type has no values of ROS are left out.
    ///
    /// # Errors
    /// The services cannot be declared.
    pub fn serve_params(&self, params: RemoteParams) -> Result<(), Error> {
        let time = self.endpoints.time.clone();
        let events = self.publish("/parameter_events").quiet().open()?;
        let params = Arc::new(Offered { params, time, node: self.name(), events, names: OnceLock::new() });
        let of = || Arc::clone(&params);
        let here = of();
        self.serve::<ListParameters>("~/list_parameters")
            .by(move |request| ListParametersResponse { result: here.list(&request) })?;
        let here = of();
        self.serve::<GetParameters>("~/get_parameters").by(move |request| GetParametersResponse {
            values: request.names.iter().map(|name| here.get(name).unwrap_or_default()).collect(),
        })?;
        let here = of();
        self.serve::<GetParameterTypes>("~/get_parameter_types").by(move |request| GetParameterTypesResponse {
            types: request.names.iter().map(|name| here.get(name).unwrap_or_default().r#type).collect(),
        })?;
        let here = of();
        self.serve::<DescribeParameters>("~/describe_parameters").by(move |request| DescribeParametersResponse {
            descriptors: request.names.iter().map(|name| here.describe(name)).collect(),
        })?;
        let here = of();
        self.serve::<SetParameters>("~/set_parameters").by(move |request| SetParametersResponse {
            results: request.parameters.into_iter().map(|parameter| here.set(vec![parameter])).collect(),
        })?;
        let here = of();
        self.serve::<SetParametersAtomically>("~/set_parameters_atomically")
            .by(move |request| SetParametersAtomicallyResponse { result: here.set(request.parameters) })
    }
}

/// The parameters of a program, offered to others.
struct Offered {
    params: RemoteParams,
    time: RosTime,
    node: String,
    events: Publisher<ParameterEvent>,
    /// Names of the parameters whose values are some of ROS.
    names: OnceLock<Vec<&'static str>>,
}

impl Offered {
    fn list(&self, request: &ListParametersRequest) -> ListParametersResult {
        let all = self.names.get_or_init(|| {
            let all = self.params.all().iter().map(|param| param.name).chain([SIM_TIME]);
            all.filter(|name| self.get(name).is_some()).collect()
        });
        let names: Vec<String> =
            all.iter().filter(|name| is_asked(name, request)).map(|name| (*name).to_owned()).collect();
        let mut prefixes: Vec<String> =
            names.iter().filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned())).collect();
        prefixes.dedup();
        ListParametersResult { names, prefixes }
    }

    /// Value of a parameter; `None` if there is none of this name, or none of ROS.
    fn get(&self, name: &str) -> Option<ParameterValue> {
        if name == SIM_TIME {
            let is_simulated = matches!(self.time, RosTime::Simulated(_));
            return Some(ParameterValue {
                r#type: Kind::PARAMETER_BOOL,
                bool_value: is_simulated,
                ..Default::default()
            });
        }
        self.params.get::<Value>(name).ok().map(|value| value.0)
    }

    fn describe(&self, name: &str) -> ParameterDescriptor {
        let ty = self.get(name).unwrap_or_default().r#type;
        let info = self.params.all().iter().find(|param| param.name == name);
        let descriptor = ParameterDescriptor { name: name.to_owned(), r#type: ty, ..Default::default() };
        info.map_or_else(
            || ParameterDescriptor { read_only: true, ..descriptor.clone() },
            |info| {
                let (floating_point_range, integer_range) = ranges(info, ty);
                let description = info.unit.map_or_else(String::new, |unit| format!("in {unit}"));
                ParameterDescriptor { description, floating_point_range, integer_range, ..descriptor.clone() }
            },
        )
    }

    /// Sets all parameters or none.
    fn set(&self, parameters: Vec<Parameter>) -> SetParametersResult {
        let mut before = vec![];
        for Parameter { name, value } in &parameters {
            let old = self.params.get::<Value>(name);
            let set = old.and_then(|old| self.params.set(name, Value(value.clone())).map(|()| old));
            match set {
                Ok(old) => before.push((name, old)),
                Err(_) if name == SIM_TIME => return refused("`use_sim_time` is fixed when the node starts"),
                Err(error) => {
                    for (name, old) in before {
                        // It had this value, so it can have it again.
                        let _ = self.params.set(name, old);
                    }
                    return refused(&error.to_string());
                }
            }
        }
        let stamp = Time::from_nanos(self.time.now());
        let event =
            ParameterEvent { stamp, node: self.node.clone(), changed_parameters: parameters, ..Default::default() };
        // A node that ends cannot tell.
        drop(self.events.send(&event));
        SetParametersResult { successful: true, reason: String::new() }
    }
}

fn refused(reason: &str) -> SetParametersResult {
    SetParametersResult { successful: false, reason: reason.to_owned() }
}

/// Returns `true` if a list of parameters is to have this one.
fn is_asked(name: &str, ListParametersRequest { prefixes, depth }: &ListParametersRequest) -> bool {
    let is_near = |rest: &str| *depth == 0 || (rest.split('.').count() as u64) <= *depth;
    let is_below = |prefix: &String| {
        let rest = name.strip_prefix(prefix.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.strip_prefix('.').is_some_and(is_near))
    };
    if prefixes.is_empty() { is_near(name) } else { prefixes.iter().any(is_below) }
}

/// Ranges of a parameter, of which one is empty.
fn ranges(info: &ParamInfo, ty: u8) -> (Vec<FloatingPointRange>, Vec<IntegerRange>) {
    let (min, max) = (info.range.min, info.range.max);
    match ty {
        _ if !info.range.is_known() => (vec![], vec![]),
        Kind::PARAMETER_DOUBLE => {
            let (from_value, to_value) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
            (vec![FloatingPointRange { from_value, to_value, step: 0.0 }], vec![])
        }
        Kind::PARAMETER_INTEGER => {
            let (from_value, to_value) =
                (min.map_or(i64::MIN, |min| min as i64), max.map_or(i64::MAX, |max| max as i64));
            (vec![], vec![IntegerRange { from_value, to_value, step: 1 }])
        }
        _ => (vec![], vec![]),
    }
}

/// Value of a parameter in a message.
struct Value(ParameterValue);

/// Numbers in single precision are those that are written, as `0.1`.
fn double(single: f32) -> f64 {
    format!("{single:?}").parse().unwrap_or(f64::from(single))
}

impl ParamValue for Value {
    fn take(given: ParamRef<'_>) -> Result<Self, Rejection> {
        let of = |r#type| ParameterValue { r#type, ..Default::default() };
        let integer = |value: i128| i64::try_from(value).map_err(|_| given.refuse("an integer of 64 bits"));
        Ok(Self(match given {
            ParamRef::Bool(bool_value) => ParameterValue { bool_value, ..of(Kind::PARAMETER_BOOL) },
            ParamRef::Integer(value) => {
                ParameterValue { integer_value: integer(value)?, ..of(Kind::PARAMETER_INTEGER) }
            }
            ParamRef::Float(double_value) => ParameterValue { double_value, ..of(Kind::PARAMETER_DOUBLE) },
            ParamRef::Single(value) => ParameterValue { double_value: double(value), ..of(Kind::PARAMETER_DOUBLE) },
            ParamRef::Text(text) => ParameterValue { string_value: text.to_owned(), ..of(Kind::PARAMETER_STRING) },
            ParamRef::List(list) => of_list(list)?,
            ParamRef::Other(_) => return Err(given.refuse("a value of ROS")),
        }))
    }
}

/// A list whose elements are of one kind.
fn of_list(list: &dyn GivenList) -> Result<ParameterValue, Rejection> {
    let mut value = ParameterValue::default();
    for index in 0..list.count() {
        let Value(one) = Value::take(list.element(index))?;
        match one.r#type {
            Kind::PARAMETER_BOOL => value.bool_array_value.push(one.bool_value),
            Kind::PARAMETER_INTEGER => value.integer_array_value.push(one.integer_value),
            Kind::PARAMETER_DOUBLE => value.double_array_value.push(one.double_value),
            Kind::PARAMETER_STRING => value.string_array_value.push(one.string_value),
            _ => return Err(list.element(index).refuse("an element of a list of ROS")),
        }
        // Kinds of lists come after those of single values, with one for bytes between.
        value.r#type = one.r#type + (Kind::PARAMETER_BOOL_ARRAY - Kind::PARAMETER_BOOL);
    }
    if value.r#type == Kind::PARAMETER_NOT_SET {
        value.r#type = Kind::PARAMETER_DOUBLE_ARRAY;
    }
    Ok(value)
}

impl IntoParam for Value {
    fn give(&self) -> ParamRef<'_> {
        let value = &self.0;
        match value.r#type {
            Kind::PARAMETER_BOOL => ParamRef::Bool(value.bool_value),
            Kind::PARAMETER_INTEGER => ParamRef::Integer(value.integer_value.into()),
            Kind::PARAMETER_DOUBLE => ParamRef::Float(value.double_value),
            Kind::PARAMETER_STRING => ParamRef::Text(&value.string_value),
            Kind::PARAMETER_NOT_SET => ParamRef::Other("no value"),
            _ => ParamRef::List(self),
        }
    }
}

impl GivenList for Value {
    fn count(&self) -> usize {
        let value = &self.0;
        match value.r#type {
            Kind::PARAMETER_BYTE_ARRAY => value.byte_array_value.len(),
            Kind::PARAMETER_BOOL_ARRAY => value.bool_array_value.len(),
            Kind::PARAMETER_INTEGER_ARRAY => value.integer_array_value.len(),
            Kind::PARAMETER_DOUBLE_ARRAY => value.double_array_value.len(),
            _ => value.string_array_value.len(),
        }
    }

    fn element(&self, index: usize) -> ParamRef<'_> {
        let value = &self.0;
        match value.r#type {
            Kind::PARAMETER_BYTE_ARRAY => ParamRef::Integer(value.byte_array_value[index].into()),
            Kind::PARAMETER_BOOL_ARRAY => ParamRef::Bool(value.bool_array_value[index]),
            Kind::PARAMETER_INTEGER_ARRAY => ParamRef::Integer(value.integer_array_value[index].into()),
            Kind::PARAMETER_DOUBLE_ARRAY => ParamRef::Float(value.double_array_value[index]),
            _ => ParamRef::Text(&value.string_array_value[index]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_asked_by_prefix_and_depth() {
        let ask = |prefixes: &[&str], depth| ListParametersRequest {
            prefixes: prefixes.iter().map(|prefix| (*prefix).to_owned()).collect(),
            depth,
        };
        let asked = |request: &ListParametersRequest| ["a.b.c", "a.d", "e"].map(|name| is_asked(name, request));
        assert_eq!(asked(&ask(&[], 0)), [true, true, true]);
        assert_eq!(asked(&ask(&[], 1)), [false, false, true]);
        assert_eq!(asked(&ask(&["a"], 0)), [true, true, false]);
        assert_eq!(asked(&ask(&["a"], 1)), [false, true, false]);
        assert_eq!(asked(&ask(&["a.b", "e"], 5)), [true, false, true]);
    }

    #[test]
    fn values_come_back() {
        struct List<'a>(&'a [ParamRef<'a>]);
        impl GivenList for List<'_> {
            fn count(&self) -> usize {
                self.0.len()
            }
            fn element(&self, index: usize) -> ParamRef<'_> {
                self.0[index]
            }
        }
        let single = Value::take(ParamRef::Single(0.1)).expect("a number");
        assert_eq!((single.0.r#type, single.0.double_value), (Kind::PARAMETER_DOUBLE, 0.1));
        for given in [
            ParamRef::Bool(true),
            ParamRef::Integer(-3),
            ParamRef::Text("a"),
            ParamRef::List(&List(&[ParamRef::Float(0.5), ParamRef::Float(f64::INFINITY)])),
            ParamRef::List(&List(&[ParamRef::Bool(true)])),
            ParamRef::List(&List(&[])),
        ] {
            let value = Value::take(given).expect("a value");
            assert_eq!(value.give().to_string(), given.to_string());
        }
        let mixed = List(&[ParamRef::Float(0.5), ParamRef::List(&List(&[]))]);
        assert!(Value::take(ParamRef::List(&mixed)).is_err() && Value::take(ParamRef::Integer(i128::MAX)).is_err());
    }
}
