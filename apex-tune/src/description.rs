//! Description of a study in one line, with which its journal begins.

use crate::{Axis, Parameter, Study};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of this crate: another one may search in another way.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Form of the lines of a journal: a run, its values, and a checksum.
const FORM: u32 = 2;

/// A study, and the version that runs it.
#[derive(Serialize, Deserialize)]
struct Description<S> {
    apex: String,
    /// Form of the lines.
    #[serde(default)]
    journal: u32,
    study: S,
}

impl Study {
    /// Description in one line: equal for equal studies.
    pub fn description(&self) -> String {
        let described = Description { apex: VERSION.to_owned(), journal: FORM, study: self };
        serde_json::to_string(&described).expect("names and numbers can be written")
    }

    /// The study with this description.
    ///
    /// # Errors
    /// Reason why the line does not describe a study of this version.
    pub fn from_description(line: &str) -> Result<Self, String> {
        let described: Description<serde_json::Value> =
            serde_json::from_str(line).map_err(|error| format!("it does not describe a study: {error}"))?;
        if described.apex != VERSION {
            return Err(format!(
                "it is of version {}, and this is {VERSION}: its candidates may differ",
                described.apex
            ));
        }
        if described.journal != FORM {
            return Err("its lines have another form, without checksums".to_owned());
        }
        let study: Self = serde_json::from_value(described.study)
            .map_err(|error| format!("it does not describe a study: {error}"))?;
        if study.parameters.is_empty() || study.goals.is_empty() || study.seeds.is_empty() {
            return Err("the study has no parameters, no goals or no seeds".to_owned());
        }
        study.parameters.iter().try_for_each(Parameter::check)?;
        Ok(study)
    }

    /// File with these values of the parameters (TOML), for `apex run --params`.
    pub fn params(&self, values: &[f64]) -> String {
        let mut nodes: BTreeMap<&str, String> = BTreeMap::new();
        for (parameter, value) in self.parameters.iter().zip(values) {
            for (node, name) in parameter.targets.iter().filter_map(|target| target.rsplit_once('.')) {
                nodes.entry(node).or_default().push_str(&format!("{name} = {}\n", parameter.number(*value)));
            }
        }
        let tables: Vec<String> = nodes.into_iter().map(|(node, lines)| format!("[{node}]\n{lines}")).collect();
        tables.join("\n")
    }
}

impl Parameter {
    /// Value as TOML.
    pub fn number(&self, value: f64) -> String {
        match self {
            Self { axis, .. } if axis.is_integer() => format!("{value:.0}"),
            // The shortest form from which the parameter gets the same value.
            Self { single: true, .. } => format!("{:?}", value as f32),
            _ => format!("{value:?}"),
        }
    }

    fn check(&self) -> Result<(), String> {
        let (name, axis) = (&self.name, &self.axis);
        Axis::new(axis.low(), axis.high(), axis.scale(), axis.is_integer()).map_err(|e| format!("`{name}`: {e}"))?;
        let is_name = |target: &String| target.chars().all(|c| c.is_alphanumeric() || "_.".contains(c));
        match self.targets.iter().find(|target| !is_name(target)) {
            Some(wrong) => Err(format!("`{name}`: {wrong:?} is not the name of a parameter")),
            None => Ok(()),
        }
    }
}
