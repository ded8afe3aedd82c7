//! The generated files are up to date.

#[path = "../src/text.rs"]
mod text;

#[test]
fn generated_files_are_up_to_date() {
    for (name, text) in text::files() {
        let path = format!("{}/{name}", env!("CARGO_MANIFEST_DIR"));
        let file = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(file == text, "{name} is not up to date: run `cargo run -p apex-bench --bin generate`");
    }
}
