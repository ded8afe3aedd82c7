//! Pretty-printing of Rust with little memory: the syntax tree of a large program takes several times as much as its
//! tokens, so only that of one item exists at a time.

use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree, token_stream};
use quote::quote;

/// The text of `code`, as of a whole file.
pub fn print(code: TokenStream) -> syn::Result<String> {
    let mut printer = Printer { text: String::new(), around: vec![] };
    printer.items(code)?;
    Ok(printer.text)
}

struct Printer {
    text: String,
    /// Blocks around the items, from the outside: they decide how items are parsed and indented.
    around: Vec<Block>,
}

/// An item whose items are printed one by one.
#[derive(Clone, Copy, PartialEq)]
enum Block {
    Mod,
    Impl,
}

impl Printer {
    fn items(&mut self, code: TokenStream) -> syn::Result<()> {
        let mut rest = code.into_iter();
        while let Some(item) = Item::next(&mut rest) {
            let Item { head, kind, body } = item;
            match (kind, body) {
                (Some(Kind::Block(block)), Some(body)) => {
                    let inner = body.stream();
                    // Tokens that have one owner are moved, not copied.
                    drop(body);
                    self.block(&head, block, inner)?;
                }
                (_, body) => {
                    let lines = self.lines(&quote!(#head #body))?;
                    self.text += &lines;
                }
            }
        }
        Ok(())
    }

    fn block(&mut self, head: &TokenStream, block: Block, body: TokenStream) -> syn::Result<()> {
        let empty = self.lines(&quote!(#head {}))?;
        if body.is_empty() {
            self.text += &empty;
            return Ok(());
        }
        self.text += empty.trim_end().strip_suffix('}').unwrap_or(&empty);
        self.text.push('\n');
        self.around.push(block);
        self.items(body)?;
        self.around.pop();
        self.text += &"    ".repeat(self.around.len());
        self.text += "}\n";
        Ok(())
    }

    /// The lines of an item, indented as it stands.
    fn lines(&self, item: &TokenStream) -> syn::Result<String> {
        let depth = self.around.len();
        let file = self.around.iter().rev().fold(item.clone(), |inner, block| match block {
            Block::Mod => quote!(mod m { #inner }),
            Block::Impl => quote!(impl T { #inner }),
        });
        let text = prettyplease::unparse(&syn::parse2(file)?);
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        Ok(lines[depth..lines.len() - depth].concat())
    }
}

/// An item, cut before the braces at its end.
struct Item {
    head: TokenStream,
    kind: Option<Kind>,
    body: Option<Group>,
}

/// The kind of an item, as far as it decides where the item ends and how it is printed.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Block(Block),
    /// Ends with a semicolon, after any number of braces.
    Value,
    Other,
}

impl Item {
    /// Takes the next item from `rest`.
    fn next(rest: &mut token_stream::IntoIter) -> Option<Self> {
        let (mut head, mut kind, mut is_const) = (TokenStream::new(), None, false);
        for token in rest {
            match token {
                TokenTree::Group(body) if body.delimiter() == Delimiter::Brace && kind != Some(Kind::Value) => {
                    return Some(Self { head, kind, body: Some(body) });
                }
                TokenTree::Punct(end) if end.as_char() == ';' => {
                    head.extend([TokenTree::Punct(end)]);
                    return Some(Self { head, kind, body: None });
                }
                TokenTree::Ident(word) => {
                    if kind.is_none() || word == "fn" && is_const {
                        kind = Kind::of(&word);
                    }
                    is_const = word == "const";
                    head.extend([TokenTree::Ident(word)]);
                }
                other => head.extend([other]),
            }
        }
        (!head.is_empty()).then_some(Self { head, kind, body: None })
    }
}

impl Kind {
    /// The kind of an item that begins with `word`; `None` if words follow that decide.
    fn of(word: &Ident) -> Option<Self> {
        match word.to_string().as_str() {
            "pub" | "unsafe" | "async" => None,
            "mod" => Some(Self::Block(Block::Mod)),
            "impl" => Some(Self::Block(Block::Impl)),
            "const" | "static" | "type" | "use" => Some(Self::Value),
            _ => Some(Self::Other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All that the cutting has to tell apart, in and outside modules.
    const ITEMS: &str = "
        use core::{fmt, mem::{self, take}};
        /// A constant.
        pub(crate) const WHOLE: Whole = Whole { part: Part { value: 1 } };
        const fn constant() -> u8 { 1 }
        pub const unsafe fn raw() {}
        static TABLE: [u8; { 1 + 1 }] = { [0; 2] };
        type Short = [u8; 2];
        #[derive(Debug)] pub struct Unit;
        struct Tuple(u8, u8);
        enum Choice { One, Two { value: u8 } }
        trait Empty {}
        const _: () = { assert!(1 + 1 == 2); };
        unsafe impl Empty for Unit {}
        macro_rules! none { () => {}; }
        none! {}
        none!();
    ";

    /// The text of the whole, and that of the pieces.
    fn both(text: &str) -> (String, String) {
        let code: TokenStream = text.parse().unwrap();
        (prettyplease::unparse(&syn::parse2(code.clone()).unwrap()), print(code).unwrap())
    }

    #[test]
    fn pieces_are_printed_as_the_whole() {
        let long =
            "fn long(&self, first: Vec<Vec<u8>>, second: Vec<Vec<u8>>) -> Option<Vec<u8>> { self.take(first)?; None }";
        let inner = format!(
            "//! About it.
            impl<T: Clone> Holder<T> where T: Send {{ {long} const ONE: One = One {{ value: 1 }}; type Of = u8; }}
            #[cfg(test)] pub mod inside {{ impl super::Holder {{}} mod within {{ {long_free} }} {ITEMS} }}
            mod elsewhere; mod empty {{}}",
            long_free = long.replace("&self, ", "").replace("self.", ""),
        );
        let outer = format!("#![allow(unused)] {ITEMS} /// A module.\n mod outer {{ {inner} }}");
        for text in ["", ITEMS, &outer] {
            let (whole, pieces) = both(text);
            assert_eq!(whole, pieces);
        }
    }

    #[test]
    fn text_that_is_not_rust_is_an_error() {
        for text in ["struct", "mod a { fn }", "impl A { let x = 1; }", "x y z"] {
            assert!(print(text.parse().unwrap()).is_err(), "{text}");
        }
    }
}
