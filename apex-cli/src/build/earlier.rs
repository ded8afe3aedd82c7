//! Programs that were built earlier, and of which only source files of Apex have changed since.

use super::{Built, How, Wanted, program_folder};
use std::{
    fs::{self, File},
    io,
    path::{Path, PathBuf},
};

/// File in the package of a program whose time is that of the last build with these settings, before cargo has read
/// anything.
fn stamp(wanted: &Wanted, how: How) -> PathBuf {
    wanted.package.join(if how.release { "built-release" } else { "built-debug" })
}

/// The same of a build that is not complete.
fn begun(wanted: &Wanted, how: How) -> PathBuf {
    stamp(wanted, how).with_extension("begun")
}

/// Takes note of the time before a build.
pub fn begin(wanted: &Wanted, how: How) -> io::Result<()> {
    File::create(begun(wanted, how)).map(drop)
}

/// Takes note that the build which has begun last is complete.
pub fn end(wanted: &Wanted, how: How) -> io::Result<()> {
    fs::rename(begun(wanted, how), stamp(wanted, how))
}

/// The program `name`, if cargo would build it again, but only because of source files of Apex. `manifests` are files
/// on which it depends, too.
pub fn built(wanted: &Wanted, name: &str, how: How, manifests: &[PathBuf]) -> Option<Built> {
    let folder = program_folder(wanted, how);
    let executable = folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let time = |path: &Path| fs::metadata(path).and_then(|file| file.modified()).ok();
    let built = time(&stamp(wanted, how))?;
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
    use std::time::{Duration, SystemTime};

    /// A build with other settings says nothing about a program.
    #[test]
    fn only_source_files_of_apex_may_be_newer_than_the_build_with_the_same_settings() {
        let folder = std::env::temp_dir().join(format!("apex-earlier-{}", std::process::id()));
        let target = folder.join("target");
        let wanted = Wanted {
            select: vec![],
            package: folder.clone(),
            root: folder.clone(),
            target: target.clone(),
            hushed: None,
        };
        let [debug, release] = [false, true].map(|release| How { release, ..How::default() });
        let write = |path: &Path, text: &str, age: u64| {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
            let time = SystemTime::now() - Duration::from_secs(age);
            File::options().append(true).open(path).unwrap().set_modified(time).unwrap();
        };
        let (node, text) = (folder.join("a.rs"), folder.join("x.afg"));
        write(&node, "", 100);
        write(&text, "", 100);
        for how in [debug, release] {
            let built = program_folder(&wanted, how);
            write(&built.join(format!("p{}", std::env::consts::EXE_SUFFIX)), "", 0);
            write(&built.join("p.d"), &format!("p: {} {}\n", node.display(), text.display()), 0);
        }
        let is_built = |how| built(&wanted, "p", how, std::slice::from_ref(&node)).is_some();
        let build = |how| begin(&wanted, how).and_then(|()| end(&wanted, how)).unwrap();
        write(&text, "", 0);
        assert!(!is_built(debug), "it was not built");
        build(debug);
        write(&stamp(&wanted, debug), "", 50);
        assert!(is_built(debug) && !is_built(release));
        write(&node, "", 20);
        build(release);
        write(&stamp(&wanted, release), "", 10);
        assert!(is_built(release) && !is_built(debug), "only the optimised one has the new node");
        write(&text, "", 100);
        assert!(!is_built(release), "cargo is asked if nothing is newer");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn paths_may_have_spaces_and_backslashes() {
        let paths = |list| dependencies(list).iter().map(|path| path.display().to_string()).collect::<Vec<_>>();
        assert_eq!(paths("/a/b: /a/x.rs /my\\ own/y.rs C:\\z.rs\n"), ["/a/x.rs", "/my own/y.rs", "C:\\z.rs"]);
        assert!(paths("").is_empty());
    }
}
