use super::Options;
use crate::say;
use std::{env, ffi::OsString, process::ExitCode};

/// Command of a program.
#[derive(Debug, Clone, Copy)]
pub struct Command {
    /// Name. The first command may have none.
    pub name: &'static str,
    /// Text that `--help` prints.
    pub help: &'static str,
    /// Function that reads the options and does the work. An error is the reason why this was not possible.
    pub run: fn(&mut Options) -> Result<ExitCode, String>,
}

/// Runs the command that the arguments of the program name, or the first one if they do not name any. An error is
/// printed, and gives the exit code 2.
pub fn run_commands(commands: &[Command]) -> ExitCode {
    run_with(commands, env::args_os().skip(1)).unwrap_or_else(|message| {
        eprintln!("error: {message}");
        ExitCode::from(2)
    })
}

fn run_with(commands: &[Command], args: impl Iterator<Item = OsString>) -> Result<ExitCode, String> {
    let mut args = args.peekable();
    let named = args.next_if(|arg| !arg.as_encoded_bytes().starts_with(b"-"));
    let command = match &named {
        None => commands.first(),
        Some(name) => commands.iter().find(|command| name == command.name),
    };
    let rest: Vec<OsString> = args.collect();
    let wants_help = rest.iter().any(|arg| arg == "--help" || arg == "-h");
    match command {
        Some(command) if wants_help => say(command.help).map(|()| ExitCode::SUCCESS),
        Some(command) => (command.run)(&mut Options::of(rest)),
        None => Err(unknown(commands, &named.unwrap_or_default())),
    }
}

fn unknown(commands: &[Command], name: &OsString) -> String {
    let known = commands.iter().filter(|command| !command.name.is_empty());
    let known: Vec<String> = known.map(|command| format!("`{}`", command.name)).collect();
    format!("`{}` is not a command; there are {}, and `--help`", name.display(), known.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(args: &[&str]) -> Result<ExitCode, String> {
        let quiet = Command { name: "stand", help: "", run: |options| options.end().map(|()| ExitCode::SUCCESS) };
        let failing = Command { name: "fly", help: "", run: |_| Err("it has no wings".to_owned()) };
        run_with(&[quiet, failing], args.iter().map(OsString::from))
    }

    #[test]
    fn the_first_command_is_meant_without_a_name() {
        assert_eq!(run(&[]), Ok(ExitCode::SUCCESS));
        assert_eq!(run(&["fly"]), Err("it has no wings".to_owned()));
        assert_eq!(run(&["fly", "-h"]), Ok(ExitCode::SUCCESS));
        assert_eq!(run(&["-x"]), Err("invalid option '-x'; `--help` lists the options".to_owned()));
        let error = "`swim` is not a command; there are `stand`, `fly`, and `--help`";
        assert_eq!(run(&["swim", "--help"]), Err(error.to_owned()));
    }
}
