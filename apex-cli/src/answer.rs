//! Answers of commands: text for humans, or one JSON value for programs, which has the same form for all commands
//! (docs/json.md).

use crate::{
    Format,
    project::{self, print_error},
};
use apex_dsl::{
    report::{Diagnostics, json},
    source::Sources,
};
use serde_json::{Value, json};
use std::process::ExitCode;

/// Version of the form. It is increased if a field is removed, renamed, or gets another meaning.
const VERSION: u32 = 1;

/// Answer of a command.
pub struct Answer {
    command: &'static str,
    format: Format,
    messages: Vec<Value>,
    result: Value,
}

impl Answer {
    /// Empty answer of a command.
    pub fn new(command: &'static str, format: Format) -> Self {
        Self { command, format, messages: vec![], result: Value::Null }
    }

    /// `true` if the answer is for programs: only [`Answer::finish`] prints to standard output then.
    pub fn is_json(&self) -> bool {
        self.format == Format::Json
    }

    /// Prints messages of the compiler to standard error, or adds them to the answer for programs.
    pub fn messages(&mut self, diagnostics: &Diagnostics, sources: &Sources) {
        match self.format {
            Format::Text => project::print_diagnostics(diagnostics, sources),
            Format::Json => self.messages.extend(diagnostics.sorted().into_iter().map(|d| json(d, sources))),
        }
    }

    /// Gives the result: prints `text`, or keeps `value` for programs.
    pub fn give(&mut self, text: impl FnOnce() -> String, value: impl FnOnce() -> Value) -> Result<(), String> {
        match self.format {
            Format::Text => project::print(text().trim_end()),
            Format::Json => {
                self.result = value();
                Ok(())
            }
        }
    }

    /// Ends a command whose program could not be built. The messages of cargo are on standard error.
    pub fn not_built(&self) -> Result<ExitCode, String> {
        match self.format {
            Format::Text => Ok(ExitCode::from(2)),
            Format::Json => Err("the program could not be built".to_owned()),
        }
    }

    /// Ends the command: prints its error, and the answer for programs. Returns the exit code.
    pub fn finish(self, ended: Result<ExitCode, String>) -> ExitCode {
        let error = ended.as_ref().err();
        if let Some(message) = error {
            print_error(&format!("error: {message}"));
        }
        if self.format == Format::Json {
            let Self { command, messages, result, .. } = &self;
            let apex = env!("CARGO_PKG_VERSION");
            let answer = json!({
                "form": VERSION, "apex": apex, "command": command, "error": error, "messages": messages, "result": result,
            });
            if let Err(message) = project::print(&format!("{answer:#}")) {
                print_error(&format!("error: {message}"));
                return ExitCode::from(2);
            }
        }
        ended.unwrap_or(ExitCode::from(2))
    }
}
