//! The cart without the standard library, libc and a heap: it builds, it runs, and it is small.
#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use object::{Object, ObjectSection, ObjectSymbol, SectionKind};
use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Command,
    sync::OnceLock,
};

/// Path of the program, which is built once.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("bare");
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware");
        // The versions of the workspace, which are already downloaded.
        if !package.join("Cargo.lock").exists() {
            fs::copy(package.join("../../../Cargo.lock"), package.join("Cargo.lock")).unwrap();
        }
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let built = Command::new(cargo)
            .args(["build", "--release", "--offline", "--quiet", "--manifest-path"])
            .arg(package.join("Cargo.toml"))
            .arg("--target-dir")
            .arg(&target)
            .env_remove("RUSTFLAGS")
            .output()
            .unwrap();
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        target.join("release/cart")
    })
}

#[test]
fn it_drives_and_stops() {
    let ran = Command::new(program()).output().unwrap();
    let expected = "\
0 ms: 0 mm/s
500 ms: starts
500 ms: 0 mm/s
1000 ms: 423 mm/s
1500 ms: 485 mm/s
2000 ms: stops
2000 ms: 497 mm/s
2500 ms: 0 mm/s
3000 ms: starts
3000 ms: 0 mm/s
3500 ms: 422 mm/s
4000 ms: 485 mm/s
4500 ms: 497 mm/s
5000 ms: stops
5000 ms: 499 mm/s
5500 ms: 0 mm/s
6000 ms: 0 mm/s
6500 ms: 0 mm/s
7000 ms: 0 mm/s
7500 ms: 0 mm/s
";
    let output = String::from_utf8(ran.stdout).unwrap();
    let (lines, last) = output.split_at(expected.len().min(output.len()));
    assert_eq!((ran.status.code(), lines), (Some(0), expected));
    let bytes: usize = last.strip_suffix(" bytes of RAM\n").unwrap().parse().unwrap();
    assert!(bytes < 512, "the cart has {bytes} bytes");
}

#[test]
fn it_is_small_and_has_no_heap() {
    let bytes = fs::read(program()).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    let text: u64 = file.sections().filter(|s| s.kind() == SectionKind::Text).map(|s| s.size()).sum();
    println!("{text} bytes of text");
    println!("{text} bytes of text");
    assert!((1..8000).contains(&text), "{text} bytes of text");

    let names: Vec<&str> = file.symbols().filter_map(|symbol| symbol.name().ok()).collect();
    assert!(names.contains(&"_start"), "it was stripped of its symbols: {names:?}");
    let allocator = names.iter().find(|name| name.contains("alloc"));
    assert_eq!(allocator, None, "nothing takes memory from a heap");
    let unresolved = file.symbols().find(|symbol| symbol.is_undefined() && symbol.name() != Ok(""));
    assert!(unresolved.is_none() && file.dynamic_symbols().next().is_none(), "nothing comes from other libraries");
}
