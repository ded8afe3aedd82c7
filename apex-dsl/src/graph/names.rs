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

/// Converts a name to snake case: `JumpDistance` → `jump_distance`.
pub fn snake(word: &str) -> String {
    let mut text = String::new();
    for (i, c) in word.chars().enumerate() {
        if c.is_uppercase() && i > 0 && !text.ends_with('_') {
            text.push('_');
        }
        text.extend(c.to_lowercase());
    }
    text
}
