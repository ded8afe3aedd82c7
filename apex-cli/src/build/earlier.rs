//! Programs that were built earlier, and of which only source files of Apex have changed since.

use super::{Built, How, Wanted, program_folder};
use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

/// File in the package of a program whose time is that of the last build, before cargo has read anything.
const STAMP: &str = "built";
/// The same of a build that is not complete.
const BEGUN: &str = "building";

/// Takes note of the time before a build.
pub fn begin(wanted: &Wanted) -> io::Result<()> {
    File::create(wanted.package.join(BEGUN)).map(drop)
}

/// Takes note that the build which has begun last is complete.
pub fn end(wanted: &Wanted) -> io::Result<()> {
    fs::rename(wanted.package.join(BEGUN), wanted.package.join(STAMP))
}

/// The program `name`, if cargo would build it again, but only because of source files of Apex. `manifests` are files
/// on which it depends, too.
pub fn built(wanted: &Wanted, name: &str, how: How, manifests: &[PathBuf]) -> Option<Built> {
    let folder = program_folder(wanted, how);
    let executable = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let time = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
    let built = time(&wanted.package.join(STAMP))?;
    time(&executable)?;
    let list = fs::read_to_string(folder.join(format!("{name}.d"))).ok()?;
    let (texts, others): (Vec<PathBuf>, Vec<PathBuf>) =
        dependencies(&list).into_iter().partition(|path| path.extension().is_some_and(|e| e == "afg"));
    let is_older = |path: &PathBuf| time(path).is_some_and(|time| time < built);
    (others.iter().chain(manifests).all(is_older) && !texts.iter().all(is_older)).then(|| {
        let libraries = vec![folder.join("deps"), folder.clone()];
        Built { executable, package: wanted.package.clone(), libraries }
    })
}

/// The files in a list of dependencies in the form of make: `program: a.rs folder\ of\ b/b.rs`.
fn dependencies(list: &str) -> Vec<PathBuf> {
    let Some((_, files)) = list.lines().next().unwrap_or_default().split_once(": ") else { return vec![] };
    let (mut paths, mut path) = (vec![], String::new());
    let mut escaped = false;
    for c in files.chars() {
        match c {
            ' ' if !escaped => paths.push(std::mem::take(&mut path)),
            '\\' if !escaped => {
                escaped = true;
                continue;
            }
            ' ' => path.push(' '),
            // Only spaces are escaped: paths of Windows have backslashes.
            c if escaped => path.extend(['\\', c]),
            c => path.push(c),
        }
        escaped = false;
    }
    paths.push(path);
    paths.into_iter().filter(|path| !path.is_empty()).map(PathBuf::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_may_have_spaces_and_backslashes() {
        let paths = |list| dependencies(list).iter().map(|path| path.display().to_string()).collect::<Vec<_>>();
        assert_eq!(paths("/a/b: /a/x.rs /my\\ own/y.rs C:\\z.rs\n"), ["/a/x.rs", "/my own/y.rs", "C:\\z.rs"]);
        assert!(paths("").is_empty());
    }
}
