//! Tokens that a delay holds.

/// A delay by as many iterations as it has places: what is put in comes out that much later.
#[derive(Debug, Clone)]
pub struct Delay<T> {
    places: Vec<Option<T>>,
    at: usize,
}

impl<T> Delay<T> {
    /// Returns a delay that sends the tokens of `initial` first.
    pub fn new(initial: Vec<Option<T>>) -> Self {
        Self { places: initial, at: 0 }
    }

    /// Takes out the token that is `ahead` iterations younger than the oldest.
    pub fn take_at(&mut self, ahead: usize) -> Option<T> {
        let place = (self.at + ahead) % self.places.len().max(1);
        self.places.get_mut(place).and_then(Option::take)
    }

    /// Puts the token of this iteration in.
    pub fn put(&mut self, token: Option<T>) {
        if let Some(place) = self.places.get_mut(self.at) {
            *place = token;
            self.at = (self.at + 1) % self.places.len();
        }
    }

    /// Returns `true` if the delay holds a token.
    pub fn holds_any(&self) -> bool {
        self.places.iter().any(Option::is_some)
    }

    /// Takes all tokens out.
    pub fn clear(&mut self) {
        self.places.iter_mut().for_each(|place| *place = None);
    }
}
