//! The cart on a Cortex-M3 with RTIC: it builds, it is small, and it runs in QEMU. Skipped with a message if the target
//! `thumbv7m-none-eabi` or QEMU is not installed.

use object::{Object, ObjectSection, ObjectSymbol, SectionKind};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
    sync::OnceLock,
};

const TARGET: &str = "thumbv7m-none-eabi";

fn package() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("rtic")
}

/// Build directory: the same as for the host, so that both share compiled dependencies.
fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware")
}

/// Cargo command for this package.
fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    // Cargo finds the settings of the package from its folder.
    command
        .args(arguments)
        .arg("--quiet")
        .arg("--target-dir")
        .arg(target())
        .current_dir(package())
        .env_remove("RUSTFLAGS");
    command
}

/// Path of the program, which is built once, or `None` without the library of the target.
fn program() -> Option<&'static Path> {
    static PROGRAM: OnceLock<Option<PathBuf>> = OnceLock::new();
    let built = PROGRAM.get_or_init(|| {
        let rustc = Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output().unwrap();
        let library = String::from_utf8(rustc.stdout).unwrap();
        if !Path::new(library.trim()).exists() {
            println!("skipped: no library for the target; `rustup target add {TARGET}`");
            return None;
        }
        let built = cargo(&["build", "--release"]).output().unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        Some(target().join(TARGET).join("release/cart"))
    });
    built.as_deref()
}

#[test]
fn it_is_small_and_has_no_heap() {
    let Some(program) = program() else { return };
    let bytes = fs::read(program).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    let in_flash = [SectionKind::Text, SectionKind::ReadOnlyData, SectionKind::ReadOnlyString, SectionKind::Data];
    let flash: u64 = file.sections().filter(|s| in_flash.contains(&s.kind())).map(|s| s.size()).sum();
    println!("{flash} bytes of flash");
    assert!((1..13_000).contains(&flash), "{flash} bytes of flash");
    let allocator = file.symbols().filter_map(|s| s.name().ok()).find(|name| name.contains("alloc"));
    assert_eq!(allocator, None, "nothing takes memory from a heap");
}

#[test]
fn it_drives_and_stops() {
    if program().is_none() {
        return;
    }
    if Command::new("qemu-system-arm").arg("--version").output().is_err() {
        println!("skipped: no `qemu-system-arm`; it is in the Debian package of this name");
        return;
    }
    let ran = cargo(&["run", "--release"]).output().unwrap();
    let expected = "\
0 ms: 0 mm/s
500 ms: 0 mm/s
505 ms: starts
1000 ms: 423 mm/s
1500 ms: 485 mm/s
2000 ms: 497 mm/s
2005 ms: stops
2500 ms: 0 mm/s
3000 ms: 0 mm/s
3005 ms: starts
3500 ms: 422 mm/s
4000 ms: 485 mm/s
4500 ms: 497 mm/s
5000 ms: 499 mm/s
5005 ms: stops
5500 ms: 0 mm/s
6000 ms: 0 mm/s
6500 ms: 0 mm/s
7000 ms: 0 mm/s
7500 ms: 0 mm/s
8000 ms: 0 mm/s
";
    let output = String::from_utf8_lossy(&ran.stdout);
    assert_eq!((ran.status.code(), &*output), (Some(0), expected), "{}", String::from_utf8_lossy(&ran.stderr));
}
