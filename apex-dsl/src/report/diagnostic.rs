use crate::source::Span;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// No program comes out of this text.
    Error,
    /// A program comes out, but probably not the one that was meant.
    Warning,
}

/// A place with a remark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The place.
    pub span: Span,
    /// The remark; may be empty.
    pub text: String,
}

/// A change of the text that would mend the error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// What it does.
    pub title: String,
    /// What is replaced.
    pub span: Span,
    /// By what.
    pub replacement: String,
    /// Whether this is what was meant, so that a tool may do it unasked; otherwise it is a guess.
    pub certain: bool,
}

/// One message to the user. Messages are lower case, without a final period, names in back quotes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable name, for example `unknown-port`.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// What is wrong.
    pub message: String,
    /// Where.
    pub primary: Label,
    /// Other places that have to do with it.
    pub secondary: Vec<Label>,
    /// Why, where things were declared, and how to mend it.
    pub notes: Vec<String>,
    /// Changes that would mend it.
    pub fixes: Vec<Fix>,
    /// The path of the nested graph that it is about, if it is not about the text by itself.
    pub instance: String,
    /// The item whose statements would declare what is missing, if it is one that is known.
    pub declared_in: Option<Span>,
}

impl Diagnostic {
    /// An error at `span`.
    pub fn error(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        let primary = Label { span, text: String::new() };
        let message = shortened(message.into());
        debug_assert!(!message.ends_with('.'), "house style: no final period in {message:?}");
        let (secondary, notes, fixes, instance) = (vec![], vec![], vec![], String::new());
        let severity = Severity::Error;
        Self { code, severity, message, primary, secondary, notes, fixes, instance, declared_in: None }
    }

    /// A warning at `span`.
    pub fn warning(code: &'static str, span: Span, message: impl Into<String>) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, span, message) }
    }

    /// Adds a remark at the primary place.
    #[must_use]
    pub fn label(mut self, text: impl Into<String>) -> Self {
        self.primary.text = shortened(text.into());
        self
    }

    /// Adds another place.
    #[must_use]
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Self {
        self.secondary.push(Label { span, text: shortened(text.into()) });
        self
    }

    /// Adds a sentence.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(shortened(text.into()));
        self
    }

    /// Says which nested graph it is about, by its path; it is told once for all of them.
    #[must_use]
    pub fn inside(mut self, instance: impl Into<String>) -> Self {
        self.instance = instance.into();
        self
    }

    /// Adds a change that mends it: nothing else can have been meant.
    #[must_use]
    pub fn fix(self, title: impl Into<String>, span: Span, replacement: impl Into<String>) -> Self {
        self.change(title.into(), span, replacement.into(), true)
    }

    /// Adds a change that may be what was meant: somebody has to look at it.
    #[must_use]
    pub fn guess(self, title: impl Into<String>, span: Span, replacement: impl Into<String>) -> Self {
        self.change(title.into(), span, replacement.into(), false)
    }

    /// All places that it names: the primary one, further ones and those of its changes.
    pub fn places(&self) -> impl Iterator<Item = Span> {
        let labels = std::iter::once(&self.primary).chain(&self.secondary).map(|label| label.span);
        labels.chain(self.fixes.iter().map(|fix| fix.span))
    }

    fn change(mut self, title: String, span: Span, replacement: String, certain: bool) -> Self {
        self.fixes.push(Fix { title: shortened(title), span, replacement, certain });
        self
    }
}

/// Longer than any message that somebody reads to its end: names and lists in it may be of any length.
const MAX_MESSAGE: usize = 1000;

fn shortened(text: String) -> String {
    match text.char_indices().nth(MAX_MESSAGE) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
