//! The graphs in `graphs/` are those that the generator writes.

#[path = "../src/text.rs"]
mod text;

#[test]
fn generated_graphs_are_up_to_date() {
    for (name, text) in text::all() {
        let path = format!("{}/graphs/{name}", env!("CARGO_MANIFEST_DIR"));
        let file = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(file == text, "{name} is not up to date: run `cargo run -p apex-bench --bin generate`");
    }
}
