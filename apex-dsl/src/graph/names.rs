//! Names that are derived from other names.

/// Converts a name to camel case: `fetch_cube` → `FetchCube`.
pub fn camel(word: &str) -> String {
    word.split('_')
        .map(|part| {
            let mut chars = part.chars();
            chars.next().map(|c| c.to_uppercase().collect::<String>() + chars.as_str()).unwrap_or_default()
        })
        .collect()
}
