//! The source of a robot, as pages read and change it.

use apex_diagram::Item;
use std::path::PathBuf;

/// The source of a robot.
pub trait Source: Send + Sync + 'static {
    /// The picture of the graph with this name, or `None` if the source does not have it.
    fn picture(&self, name: &str) -> Option<Item>;

    /// Errors of the source, for which a changed robot is not started; `None` if it has none.
    fn errors(&self) -> Option<String>;

    /// Writes parameters, as TOML, to a file that does not exist yet. Returns its path.
    ///
    /// # Errors
    /// The file cannot be written.
    fn save_params(&self, params: &str) -> Result<String, String>;

    /// Writes a parameter into the source. Returns the place of the change.
    ///
    /// # Errors
    /// The value in the source is not a plain one, or the file cannot be written.
    fn write_param(&self, change: &ParamChange<'_>) -> Result<String, String>;

    /// The recording that the robot repeats, if it repeats one.
    ///
    /// # Errors
    /// Reason why a test cannot begin as the robot did.
    fn replayed(&self) -> Result<Option<Replayed>, String>;

    /// Writes a test of the graph `program` to a new file beside the source file. Returns its path.
    ///
    /// # Errors
    /// The file cannot be written, or the compiler finds mistakes in the test.
    fn write_test(&self, program: &str, test: &str) -> Result<String, String>;

    /// Contents of these files; empty for those that cannot be read.
    fn texts(&self, files: &[String]) -> Vec<String>;

    /// Absolute path of a source file of the robot that may be changed; `None` for files elsewhere.
    fn path(&self, file: &str) -> Option<PathBuf>;

    /// Replaces the text of a source file of the robot that may be changed.
    ///
    /// # Errors
    /// The file may not be changed, or cannot be written.
    fn write_text(&self, file: &str, text: &str) -> Result<(), String>;
}

/// A recording that a robot repeats.
#[derive(Debug, Clone)]
pub struct Replayed {
    /// Path of the file, from the folder of the source file.
    pub file: String,
    /// Names of the channels that have tokens.
    pub channels: Vec<String>,
    /// Times in ns of its first and last message, if it has some.
    pub range: Option<(i64, i64)>,
}

/// A new value of a parameter for the source.
#[derive(Debug, Clone, Copy)]
pub struct ParamChange<'a> {
    /// Path of the file with the node, as the compiler was given it.
    pub file: &'a str,
    /// Line of the node, from 1.
    pub line: usize,
    /// Name of the node, without the graphs around it.
    pub node: &'a str,
    /// Name of the parameter, without the node.
    pub param: &'a str,
    /// SI unit of the parameter.
    pub unit: Option<&'a str>,
    /// Value in TOML, in SI.
    pub value: &'a str,
}
