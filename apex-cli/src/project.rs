//! A source file with its package, checked.

use apex_dsl::{
    catalog::Catalog,
    checked::CheckedProgram,
    claims::MAX_STATES,
    graph::Graph,
    machine::Machine,
    passes,
    report::{Diagnostics, Severity, render},
    resolve::{Link, SourceSet},
    source::{Sources, World as _},
    syntax::MAX_BYTES,
};
use apex_host::{Disk, Workspace, read_from};
use std::{
    env,
    io::{self, ErrorKind, IsTerminal as _, Write as _},
    path::{Path, PathBuf},
    sync::{Arc, OnceLock},
};

/// A checked source file.
pub struct Checked {
    /// All files that were read.
    pub sources: Sources,
    /// Errors and warnings.
    pub diagnostics: Diagnostics,
    /// Programs in the source file.
    pub programs: Vec<CheckedProgram>,
    /// Graphs in the source file that are not programs.
    pub parts: Vec<Graph>,
    /// Connections of the source file, as written.
    pub links: Vec<Link>,
    /// It and the texts that it imports.
    pub texts: SourceSet,
    /// The node types it can use.
    pub catalog: Catalog,
}

/// Folder of the package that a file belongs to.
pub fn package_of(file: &Path) -> Option<PathBuf> {
    let absolute = env::current_dir().ok()?.join(file);
    absolute.ancestors().skip(1).find(|folder| folder.join("Cargo.toml").is_file()).map(Path::to_owned)
}

/// Name of standard input on the command line.
const INPUT: &str = "-";

/// Returns `true` if `file` is standard input.
pub fn is_input(file: &Path) -> bool {
    file.as_os_str() == INPUT
}

/// Reads and checks `file`, or standard input as a file of the current folder. A source file outside of any package
/// can use the nodes of the library.
pub fn check_text(file: &Path) -> Result<Checked, String> {
    if !is_input(file) {
        return check(file);
    }
    check_as(Path::new("<stdin>"), |_| read_input().map(Into::into))
}

/// Reads and checks `file`.
pub fn check(file: &Path) -> Result<Checked, String> {
    check_as(file, |checker| checker.read(file))
}

/// Text on standard input.
pub fn read_input() -> Result<String, String> {
    read_from(io::stdin().lock(), MAX_BYTES).map_err(|reason| format!("cannot read standard input: {reason}"))
}

/// Checks the text that `read` returns as the content of `file`.
fn check_as(file: &Path, read: impl FnOnce(&mut Checker) -> Result<Arc<str>, String>) -> Result<Checked, String> {
    let mut checker = Checker::new(file)?;
    let text = read(&mut checker)?;
    let (sources, diagnostics, checked) = checker.check(file, text);
    checker.save();
    let passes::Checked { texts, programs, parts, links } = checked;
    Ok(Checked { sources, diagnostics, programs, parts, links, texts, catalog: checker.catalog })
}

/// Checker for the source files of one package, also with contents that differ from the disk.
pub struct Checker {
    /// Node types that the source files can use.
    pub catalog: Catalog,
    /// Workspace of the package, or `None` outside of any package.
    pub workspace: Option<Workspace>,
    disk: Disk,
}

impl Checker {
    /// Checker for source files in the package that `file` belongs to.
    pub fn new(file: &Path) -> Result<Self, String> {
        let folder = package_of(file);
        let workspace = folder.as_deref().map(Workspace::load).transpose()?;
        let (crates, mut disk) = apex_library::crates_of(workspace.as_ref());
        let catalog = Catalog::load(crates, &mut disk);
        Ok(Self { catalog, workspace, disk })
    }

    /// Checker for source files in a package for which cargo was not run, with this root file. It knows the library.
    pub fn alone(package: &str, root: &Path) -> Self {
        let (crates, mut disk) = apex_library::around(package, root);
        let catalog = Catalog::load(crates, &mut disk);
        Self { catalog, workspace: None, disk }
    }

    /// Content of `file`.
    pub fn read(&mut self, file: &Path) -> Result<Arc<str>, String> {
        self.disk.read(file).map_err(|reason| format!("cannot read `{}`: {reason}", file.display()))
    }

    /// Saves the signatures that were found in Rust files to the cache.
    pub fn save(&mut self) {
        self.disk.save();
    }

    /// Checks `text` as the content of `file`.
    pub fn check(&mut self, file: &Path, text: Arc<str>) -> (Sources, Diagnostics, passes::Checked) {
        let mut sources = Sources::default();
        let root = sources.add(file, text);
        let mut diagnostics = Diagnostics::default();
        let (catalog, disk) = (&mut self.catalog, &mut self.disk);
        let checked = passes::check_all(root, catalog, &mut sources, disk, MAX_STATES, &mut diagnostics);
        (sources, diagnostics, checked)
    }
}

impl Checked {
    /// State machines of the first source file, in its order.
    pub fn machines(&self) -> Vec<&Machine> {
        let Some((_, tree)) = self.texts.files.first() else { return vec![] };
        tree.machines.iter().filter_map(|item| self.texts.machine_named(0, &item.name.text)).collect()
    }

    /// Prints all messages to standard error.
    pub fn print_diagnostics(&self) {
        print_diagnostics(&self.diagnostics, &self.sources);
    }

    /// All messages, without colours.
    pub fn rendered(&self) -> String {
        let sorted = self.diagnostics.sorted();
        let texts: Vec<String> = sorted.iter().map(|diagnostic| render(diagnostic, &self.sources, false)).collect();
        texts.join("\n\n")
    }
}

/// Prints all messages to standard error.
pub fn print_diagnostics(diagnostics: &Diagnostics, sources: &Sources) {
    let color = io::stderr().is_terminal();
    for diagnostic in diagnostics.sorted() {
        if diagnostic.severity == Severity::Error {
            FIRST_ERROR.get_or_init(|| diagnostic.code);
        }
        print_error(&format!("{}\n", render(diagnostic, sources, color)));
    }
    if diagnostics.left_out() > 0 {
        print_error(&format!("… and {} more\n", diagnostics.left_out()));
    }
}

/// Code of the first error that was printed.
static FIRST_ERROR: OnceLock<&str> = OnceLock::new();

/// Prints once, after all errors, how to read more about them.
pub fn print_where_to_read_on() {
    if let Some(code) = FIRST_ERROR.get() {
        print_error(&format!("for more about an error, try `apex explain {code}`"));
    }
}

/// Prints a line to standard output.
pub fn print(text: &str) -> Result<(), String> {
    write(&format!("{text}\n"))
}

/// Writes to standard output. A closed pipe is not an error.
pub fn write(text: &str) -> Result<(), String> {
    write_bytes(text.as_bytes())
}

/// Writes bytes to standard output. A closed pipe is not an error.
pub fn write_bytes(bytes: &[u8]) -> Result<(), String> {
    let mut output = io::stdout().lock();
    match output.write_all(bytes).and_then(|()| output.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(format!("cannot write to standard output: {e}")),
        _ => Ok(()),
    }
}

/// Number of things in words: `1 message`, `2 messages`.
pub fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}

/// Prints a line to standard error.
pub fn print_error(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}
