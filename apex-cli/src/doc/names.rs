//! File names of the pages.

use super::book::{Book, Key};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum length of a name; file systems allow 255 bytes.
const LONGEST: usize = 150;
/// Suffix of all pages.
const SUFFIX: &str = ".html";

/// File names of all pages.
pub struct Names<'a> {
    pages: BTreeMap<&'a Key, String>,
    /// Items by their bare names, or `None` if several have the same name.
    words: BTreeMap<&'a str, Option<&'a Key>>,
}

impl<'a> Names<'a> {
    /// Name of the start page.
    pub const INDEX: &'static str = "index.html";

    /// Assigns names to all pages of a book.
    pub fn new(book: &'a Book) -> Self {
        let mut names = Self { pages: BTreeMap::new(), words: BTreeMap::new() };
        let mut taken = BTreeSet::from([Self::INDEX.to_owned()]);
        for text in &book.texts {
            let path = text.path.strip_suffix(".afg").unwrap_or(&text.path);
            names.pages.insert(&text.key, free(path, &mut taken));
            for item in &text.items {
                names.pages.insert(&item.key, free(&format!("{path}.{}", item.key.name), &mut taken));
            }
        }
        for node in &book.nodes {
            let path = node.module.replace("::", ".");
            names.pages.insert(&node.key, free(&format!("{path}.{}", node.key.name), &mut taken));
        }
        for item in book.items() {
            let known = names.words.entry(&item.key.name).or_insert(Some(&item.key));
            *known = known.filter(|known| **known == item.key);
        }
        names
    }

    /// Page of a source file or an item.
    pub fn page(&self, key: &Key) -> Option<&str> {
        self.pages.get(key).map(String::as_str)
    }

    /// Page of the only item with this name.
    pub fn of_word(&self, name: &str) -> Option<&str> {
        self.page(self.words.get(name).copied().flatten()?)
    }
}

/// `true` for the name of a page: a file directly in the folder.
pub fn is_page(name: &str) -> bool {
    name.strip_suffix(SUFFIX).is_some_and(|stem| !stem.starts_with('.') && stem.chars().all(is_plain))
}

/// A name that no other page has, also on file systems that do not distinguish upper and lower case.
fn free(wanted: &str, taken: &mut BTreeSet<String>) -> String {
    let plain = wanted.chars().map(|c| match c {
        '/' => '.',
        c if is_plain(c) => c,
        _ => '_',
    });
    let stem: String = plain.take(LONGEST).collect();
    let stem = stem.trim_start_matches('.');
    let numbered = (2..).map(|number| format!("{stem}-{number}{SUFFIX}"));
    let mut names = std::iter::once(format!("{stem}{SUFFIX}")).chain(numbered);
    names.find(|name| taken.insert(name.to_lowercase())).unwrap_or_default()
}

fn is_plain(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-')
}

#[cfg(test)]
mod tests {
    use super::{free, is_page};
    use std::collections::BTreeSet;

    #[test]
    fn names_are_plain_and_differ() {
        let mut taken = BTreeSet::from(["index.html".to_owned()]);
        for (wanted, name) in [
            ("patsy/eyes.Find", "patsy.eyes.Find.html"),
            ("patsy.eyes/find", "patsy.eyes.find-2.html"),
            ("Index", "Index-2.html"),
            ("../a b/ü", "a_b._.html"),
            ("..", ".html"),
        ] {
            assert_eq!(free(wanted, &mut taken), name);
        }
        assert_eq!(free(&"x".repeat(1000), &mut taken).len(), 155);
    }

    #[test]
    fn pages_stand_in_the_folder() {
        for name in ["index.html", "a.b-2.html"] {
            assert!(is_page(name), "{name}");
        }
        for name in ["../a.html", "/a.html", "a/b.html", "a", ".apex-doc", "..html", "C:a.html", "a\\b.html", ""] {
            assert!(!is_page(name), "{name}");
        }
    }
}
