//! Names that are near an unknown one: the one that was misspelt, and the place at which to report it.

use crate::{
    report::{Diagnostic, nearest, nearest_within},
    source::Span,
    syntax::tree::Ident,
};

/// Largest number of places that one message shows.
const MAX_PLACES: usize = 8;

/// A name that may have been meant.
#[derive(Clone, Copy)]
pub struct Known<'a> {
    /// The name.
    pub name: &'a str,
    /// Place of its declaration in the source files.
    pub declared: Option<Span>,
    /// `true` if it is used.
    pub used: bool,
}

impl<'a> Known<'a> {
    /// A name that is not declared in the source files.
    pub fn elsewhere(name: &'a str) -> Self {
        Self { name, declared: None, used: true }
    }
}

/// An error about an unknown name, for all places where it is used.
pub fn everywhere(code: &'static str, message: String, word: Span, uses: &[Span]) -> Diagnostic {
    let (first, others) = uses.split_first().unwrap_or((&word, &[]));
    let message = match others.len() {
        0 => message,
        1 => format!("{message}, here and in another place"),
        n => format!("{message}, here and in {n} other places"),
    };
    let error = Diagnostic::error(code, *first, message);
    others.iter().take(MAX_PLACES).fold(error, |error, place| error.also(*place, "here too"))
}

/// An error about `word`, which is used at `uses` and resembles a known name; `None` if it resembles none. If that name
/// is not used, but `word` is used in several places, the declaration is considered misspelt.
pub fn unknown(
    code: &'static str,
    message: String,
    word: &Ident,
    uses: &[Span],
    known: &[Known<'_>],
) -> Option<Diagnostic> {
    // A name without uses may be meant even if it is less similar.
    let unused = known.iter().filter(|known| !known.used && known.declared.is_some()).map(|known| known.name);
    let near = nearest(&word.text, known.iter().map(|known| known.name));
    let near = near.or_else(|| nearest_within(&word.text, unused, 2))?;
    let near = known.iter().find(|known| known.name == near)?;
    let title = |name: &str| format!("did you mean `{name}`?");
    Some(match near.declared.filter(|_| !near.used) {
        Some(declared) if uses.len() > 1 => misspelt(code, declared, near.name, &word.text, uses[0]),
        Some(declared) => Diagnostic::error(code, word.span, message)
            .also(declared, format!("`{}` is not used", near.name))
            .guess(title(near.name), word.span, near.name),
        None => Diagnostic::error(code, word.span, message).guess(title(near.name), word.span, near.name),
    })
}

/// An error about a declaration: a name similar to the declared one is used instead.
fn misspelt(code: &'static str, declared: Span, name: &str, word: &str, used: Span) -> Diagnostic {
    let message = format!("`{name}` is declared here, but `{word}` is used");
    Diagnostic::error(code, declared, message).also(used, "for example here").guess(
        format!("did you mean `{word}`?"),
        declared,
        word,
    )
}

/// Adds the nearest of `candidates` as a fix for `word`.
pub fn suggest<'a>(error: Diagnostic, word: &Ident, candidates: impl Iterator<Item = &'a str>) -> Diagnostic {
    match nearest(&word.text, candidates) {
        Some(near) => error.guess(format!("did you mean `{near}`?"), word.span, near),
        None => error,
    }
}
