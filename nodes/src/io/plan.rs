use crate::map::VectorMap;
use std::collections::BTreeMap;

/// Options of [`read_plan`](super::read_plan).
#[derive(Debug, Clone, PartialEq)]
pub struct PlanOptions {
    /// Length of a unit of the file, in m. The unit that a DXF file declares is often wrong and is ignored.
    pub scale: f64,
    /// Names of the used layers of a DXF file; empty for all.
    pub layers: Vec<String>,
}

/// Metres, and all layers.
impl Default for PlanOptions {
    fn default() -> Self {
        Self { scale: 1.0, layers: Vec::new() }
    }
}

impl PlanOptions {
    /// Options with the layers of a list that is separated by commas; empty for all.
    pub fn of_layers(list: &str, scale: f64) -> Self {
        let layers = list.split(',').map(str::trim).filter(|layer| !layer.is_empty());
        Self { scale, layers: layers.map(str::to_owned).collect() }
    }
}

/// Plan of a file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plan {
    /// Line segments, in m.
    pub map: VectorMap,
    /// Types of the entities of a DXF file that may be walls but are not read, with their numbers.
    pub left_out: BTreeMap<String, usize>,
}

impl Plan {
    /// Message about what was left out; `None` if nothing was.
    pub fn note(&self) -> Option<String> {
        (!self.left_out.is_empty()).then(|| format!("left out: {}", Self::counts(&self.left_out)))
    }

    /// Prints a warning if something was left out, for nodes that read a plan.
    pub(crate) fn warn(&self, file: &str) {
        if let Some(note) = self.note() {
            eprintln!("warning: {file}: {note}");
        }
    }

    /// Numbers of things as words.
    pub(super) fn counts(counts: &BTreeMap<String, usize>) -> String {
        counts.iter().map(|(name, count)| format!("{count} `{name}`")).collect::<Vec<_>>().join(", ")
    }
}
