use apex_rt::{Event, node};
use core::marker::PhantomData;

/// Sends a text for each received token, for example to the `note` of a [`LiveView`](crate::LiveView).
#[node]
#[derive(Debug, Clone)]
pub struct Note<T> {
    /// Text to send.
    #[param]
    text: &'static str,
    _value: PhantomData<fn() -> T>,
}

#[node]
impl<T> Note<T> {
    /// Sends the text.
    #[slot]
    fn put(&mut self, _value: &T, note: Event<String>) {
        note.emit(self.text.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn each_token_is_a_text() {
        let mut sent = None;
        Note::construct(("turns",)).put(&(), apex_rt::event(&mut sent));
        assert_eq!(sent.as_deref(), Some("turns"));
    }
}
