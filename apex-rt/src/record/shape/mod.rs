//! Shape of a type: the structs, fields, variants and numbers that serde reads, as text. A recording contains the
//! shapes of its tokens, because their bytes do not tell that the type has changed since.

mod parts;
mod trace;

use serde::de::DeserializeOwned;

/// Returns the shape of a type: a line for each field and variant, indented below its type.
pub fn shape<T: DeserializeOwned>() -> String {
    let slot = trace::trace::<T>();
    let mut text = slot.head();
    text.push('\n');
    slot.lines(1, &mut text);
    text
}

/// Returns the first lines in which two shapes or definitions of messages differ; `None` if they are the same. A line
/// comes with the names of the fields in which it is; a missing one is `nothing`.
pub fn difference(was: &str, is: &str) -> Option<(String, String)> {
    let (was, is) = (lines(was), lines(is));
    let same = was.iter().zip(&is).take_while(|(was, is)| was == is).count();
    if same == was.len() && same == is.len() {
        return None;
    }
    Some((place(&was, same), place(&is, same)))
}

/// The lines of a text that mean something.
fn lines(text: &str) -> Vec<&str> {
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim_end());
    lines.filter(|line| !line.is_empty()).collect()
}

/// A line with the names of the fields around it.
fn place(lines: &[&str], number: usize) -> String {
    let Some(line) = lines.get(number) else { return "nothing".to_owned() };
    let indent = |line: &str| line.len() - line.trim_start().len();
    let (mut text, mut level) = (line.trim().to_owned(), indent(line));
    for above in lines[..number].iter().rev() {
        if indent(above) < level && indent(above) > 0 {
            level = indent(above);
            let name = above.trim().split(':').next().unwrap_or_default();
            text = format!("{name}.{text}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::{Deserialize, Deserializer, de::Error as _};
    use std::{
        collections::{BTreeMap, HashMap},
        net::IpAddr,
        num::NonZeroU16,
        time::Duration,
    };

    #[derive(Deserialize)]
    #[allow(dead_code, reason = "its shape counts")]
    struct Measured {
        left: f32,
        kind: Kind,
        points: Vec<Point>,
        wait: Option<Duration>,
        names: BTreeMap<String, u8>,
        corners: [(u8, f64); 2],
        many: heapless_like::Many,
    }

    /// An array that is longer than those that serde knows.
    mod heapless_like {
        use serde::{
            Deserialize, Deserializer,
            de::{SeqAccess, Visitor},
        };
        pub struct Many;
        impl<'de> Deserialize<'de> for Many {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct All;
                impl<'de> Visitor<'de> for All {
                    type Value = Many;
                    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        f.write_str("many")
                    }
                    fn visit_seq<A: SeqAccess<'de>>(self, mut all: A) -> Result<Many, A::Error> {
                        while all.next_element::<f32>()?.is_some() {}
                        Ok(Many)
                    }
                }
                deserializer.deserialize_tuple(1081, All)
            }
        }
    }

    #[derive(Deserialize)]
    #[allow(dead_code, reason = "its shape counts")]
    struct Point(f32, f32);

    #[derive(Deserialize)]
    struct Metres(#[allow(dead_code, reason = "its shape counts")] f64);

    #[derive(Deserialize)]
    #[allow(dead_code, reason = "its shape counts")]
    enum Kind {
        Free,
        Blocked { by: Point, far: Metres },
        Two(i8, bool),
        One(char),
    }

    #[test]
    fn all_fields_and_variants_are_shown() {
        let expected = "\
struct Measured
  left: f32
  kind: enum Kind
    Free: ()
    Blocked: struct Blocked
      by: struct Point
        0: f32
        1: f32
      far: Metres of f64
    Two: tuple
      0: i8
      1: bool
    One: char
  points: list of struct Point
    0: f32
    1: f32
  wait: option of struct Duration
    secs: u64
    nanos: u32
  names: map
    key: text
    value: u8
  corners: 2 of tuple
    0: u8
    1: f64
  many: 1081 of f32
";
        assert_eq!(shape::<Measured>(), expected);
        assert_eq!(shape::<Vec<Vec<u64>>>(), "list of list of u64\n");
        assert_eq!(shape::<Result<(), u8>>(), "enum Result\n  Ok: ()\n  Err: u8\n");
    }

    #[derive(Deserialize)]
    #[allow(dead_code, reason = "its shape counts")]
    struct Tree {
        left: Option<Box<Tree>>,
        leaf: u8,
        rest: Vec<Tree>,
    }

    #[derive(Deserialize)]
    #[allow(dead_code, reason = "its shape counts")]
    enum Term {
        Sum(Box<Term>, Box<Term>),
        Product(Box<Term>, Box<Term>),
        Difference(Box<Term>, Box<Term>),
        Quotient(Box<Term>, Box<Term>),
        Negative(Box<Term>),
        Number(f64),
    }

    #[test]
    fn types_that_contain_themselves_have_an_end() {
        let tree = shape::<Tree>();
        assert!(tree.starts_with("struct Tree\n  left: option of struct Tree\n    left: option of "), "{tree}");
        assert!(tree.contains("\n  leaf: u8\n  rest: list of struct Tree\n"), "{tree}");
        let term = shape::<Term>();
        assert!(term.contains("\n  Number: f64\n") && term.lines().count() < 100_000, "{term}");
    }

    /// A share between 0 and 1, read as text.
    struct Picky;

    impl<'de> Deserialize<'de> for Picky {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let text = String::deserialize(deserializer)?;
            if text == "open sesame" { Ok(Self) } else { Err(D::Error::custom("no")) }
        }
    }

    #[derive(Deserialize)]
    #[allow(dead_code, reason = "its shape counts")]
    struct Unusual {
        port: NonZeroU16,
        address: IpAddr,
        maybe: Option<Picky>,
        after: u8,
        word: Picky,
        hidden: u32,
    }

    #[test]
    fn a_type_that_refuses_values_is_shown_as_far_as_it_goes() {
        let text = shape::<Unusual>();
        assert!(text.starts_with("struct Unusual\n  port: u16\n  address: enum IpAddr\n    V4: 4 of u8\n"), "{text}");
        assert!(text.ends_with("  maybe: option of text\n  after: u8\n  word: text\n  hidden: …\n"), "{text}");
    }

    #[test]
    fn the_order_of_a_map_does_not_matter() {
        assert_eq!(shape::<HashMap<u8, f32>>(), shape::<BTreeMap<u8, f32>>());
    }

    #[test]
    fn the_first_difference_is_named() {
        let of = |was, is| difference(was, is).map(|(was, is)| format!("{was} | {is}"));
        assert_eq!(of("struct A\n  x: f32\n", "struct A\n  x: f32\n"), None);
        assert_eq!(of("struct A\n  x: f32\n  y: u8\n", "struct A\n  x: f32\n").unwrap(), "y: u8 | nothing");
        assert_eq!(of("struct A\n  x: f32\n", "struct A\n  y: f32\n").unwrap(), "x: f32 | y: f32");
        let (was, is) = ("struct A\n  at: struct P\n    x: f32\n", "struct A\n  at: struct P\n    x: f64\n");
        assert_eq!(of(was, is).unwrap(), "at.x: f32 | at.x: f64");
        assert_eq!(of("f32\n", "list of f32\n").unwrap(), "f32 | list of f32");
        // Comments in the definition of a message say nothing about its bytes.
        assert_eq!(of("float64 data", "# metres\nfloat64 data # m\n\n"), None);
        assert_eq!(of("float64 data", "float32 data").unwrap(), "float64 data | float32 data");
    }
}
