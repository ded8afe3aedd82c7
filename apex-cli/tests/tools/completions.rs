use crate::common::apex;

#[test]
fn every_shell_gets_a_script_that_names_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = apex().args(["completions", shell]).output().unwrap();
        assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0), "{shell}");
        let script = String::from_utf8(output.stdout).unwrap();
        for word in ["check", "completions", "--save-params", "pnml"] {
            let word = if shell == "fish" { word.trim_start_matches("--") } else { word };
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert_eq!(apex().args(["completions", "cmd"]).output().unwrap().status.code(), Some(2));
}

/// bash itself runs the script and completes a command.
#[test]
fn bash_completes_a_command() {
    let script = apex().args(["completions", "bash"]).output().unwrap().stdout;
    let asked = "\nCOMP_WORDS=(apex ex); COMP_CWORD=1; _apex apex ex apex; echo \"${COMPREPLY[@]}\"\n";
    let script = String::from_utf8(script).unwrap() + asked;
    let Ok(output) = std::process::Command::new("bash").args(["--norc", "-c", &script]).output() else {
        return eprintln!("skipped: there is no bash");
    };
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "expand explain\n");
}
