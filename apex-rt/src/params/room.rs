//! Lengths of the texts of values, by their types.

use super::MAX_VALUE;
use std::string::String;

/// Length in bytes beyond which a number has no more digits that matter, in any spelling.
const NUMBER: usize = 64;

/// Returns the length in bytes beyond which no text in TOML is a value of a type, at most [`MAX_VALUE`]. `ty` is the
/// type as written in its declaration. A type that says nothing about its size has the maximum.
pub fn room(ty: &str) -> usize {
    let ty: String = ty.split_whitespace().collect();
    room_of(&ty).unwrap_or(MAX_VALUE).min(MAX_VALUE)
}

fn room_of(ty: &str) -> Option<usize> {
    let name = ty.rsplit_once("::").filter(|(path, _)| !path.contains(['<', '['])).map_or(ty, |(_, name)| name);
    let numbers =
        ["bool", "i8", "i16", "i32", "i64", "isize", "u8", "u16", "u32", "u64", "usize", "f32", "f64", "Duration"];
    if numbers.contains(&name) {
        return Some(NUMBER);
    }
    if let Some(inner) = ty.strip_prefix('[').and_then(|ty| ty.strip_suffix(']')) {
        let (element, count) = inner.rsplit_once(';')?;
        return list(element, count);
    }
    let open = ty.find('<')?;
    let (outer, inner) = (&ty[..open], ty[open + 1..].strip_suffix('>')?);
    match outer.rsplit("::").next()? {
        "Vec" => inner.rsplit_once(',').and_then(|(element, count)| list(element, count)),
        // Each byte may be written as `\U00000041`.
        "String" => Some(inner.parse::<usize>().ok()?.saturating_mul(10).saturating_add(NUMBER)),
        _ => None,
    }
}

/// The length of a list of so many elements, each with a comma and a space.
fn list(element: &str, count: &str) -> Option<usize> {
    let count: usize = count.parse().ok()?;
    Some((room_of(element)? + 2).saturating_mul(count).saturating_add(NUMBER))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_as_long_as_its_type_allows() {
        assert_eq!((room("f64"), room("core::time::Duration"), room("bool")), (64, 64, 64));
        assert_eq!((room("[f64; 3]"), room("heapless::Vec<[u8; 2], 4>")), (3 * 66 + 64, 4 * (2 * 66 + 66) + 64));
        assert_eq!(room("heapless::String<16>"), 224);
        for ty in ["String", "Vec<f64>", "[f64; N]", "[f64; 100000]", "Shape", "", "<", "[", "Vec<", "Vec<é,3"] {
            assert_eq!(room(ty), MAX_VALUE, "{ty}");
        }
    }
}
