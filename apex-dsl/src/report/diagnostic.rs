use crate::source::Span;

/// Severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// No program is generated.
    Error,
    /// A program is generated, but probably not the intended one.
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

/// A change of the source file that would fix the error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// Description of the change.
    pub title: String,
    /// Range that is replaced.
    pub span: Span,
    /// Replacement text.
    pub replacement: String,
    /// `true` if the change is certainly the intended one, so that a tool may apply it without asking. Otherwise it is
    /// a guess.
    pub certain: bool,
}

/// One message to the user. Messages are lower case, without a final period, names in back quotes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Stable name, for example `unknown-port`.
    pub code: &'static str,
    /// Severity of the message.
    pub severity: Severity,
    /// Description of the problem.
    pub message: String,
    /// Primary place.
    pub primary: Label,
    /// Other relevant places.
    pub secondary: Vec<Label>,
    /// Reasons, declarations and advice.
    pub notes: Vec<String>,
    /// Changes that would fix the problem.
    pub fixes: Vec<Fix>,
    /// Path of the instance in which the problem occurs; empty if the problem does not depend on an instance.
    pub instance: String,
    /// Item in which the missing name would be declared, if the item is known.
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

    /// Moves the message to `span`, where its cause is. Fixes at its former place would not remove the cause.
    #[must_use]
    pub fn moved_to(mut self, span: Span) -> Self {
        if self.primary.span != span {
            let primary = std::mem::replace(&mut self.primary, Label { span, text: String::new() });
            let text = if primary.text.is_empty() { "needed here".to_owned() } else { primary.text };
            self.secondary.insert(0, Label { span: primary.span, text });
            self.fixes.clear();
        }
        self
    }

    /// Adds a note.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Self {
        self.notes.push(shortened(text.into()));
        self
    }

    /// Names the instance that the message is about, by its path. Equal messages about several instances become one.
    #[must_use]
    pub fn inside(mut self, instance: impl Into<String>) -> Self {
        self.instance = instance.into();
        self
    }

    /// Adds a fix that is certain: nothing else can have been meant.
    #[must_use]
    pub fn fix(self, title: impl Into<String>, span: Span, replacement: impl Into<String>) -> Self {
        self.change(title.into(), span, replacement.into(), true)
    }

    /// Adds a fix that is a guess, to be confirmed by the user.
    #[must_use]
    pub fn guess(self, title: impl Into<String>, span: Span, replacement: impl Into<String>) -> Self {
        self.change(title.into(), span, replacement.into(), false)
    }

    /// All places of the message: the primary one, the further ones and those of its fixes.
    pub fn places(&self) -> impl Iterator<Item = Span> {
        let labels = std::iter::once(&self.primary).chain(&self.secondary).map(|label| label.span);
        labels.chain(self.fixes.iter().map(|fix| fix.span))
    }

    fn change(mut self, title: String, span: Span, replacement: String, certain: bool) -> Self {
        self.fixes.push(Fix { title: shortened(title), span, replacement, certain });
        self
    }
}

/// Largest length of a message, in characters: names and lists in it may be of any length.
const MAX_MESSAGE: usize = 1000;

fn shortened(text: String) -> String {
    match text.char_indices().nth(MAX_MESSAGE) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
