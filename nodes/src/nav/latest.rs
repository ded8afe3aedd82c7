use apex_rt::Time;

/// Last token of an input that is ⊥ from time to time, and the time at which it came.
#[derive(Debug, Clone)]
pub(super) struct Latest<T>(Option<(Time, T)>);

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T: Clone> Latest<T> {
    /// Keeps a copy of the token, if there is one. The memory of the last copy is used again.
    pub fn update(&mut self, now: Time, token: Option<&T>) {
        match (&mut self.0, token) {
            (Some((at, last)), Some(token)) => {
                *at = now;
                last.clone_from(token);
            }
            (last, Some(token)) => *last = Some((now, token.clone())),
            _ => {}
        }
    }

    /// Returns the token if it came at most `max_age` s ago.
    pub fn young(&self, now: Time, max_age: f32) -> Option<&T> {
        self.0.as_ref().filter(|(at, _)| now.since(*at).as_secs_f32() <= max_age).map(|(_, token)| token)
    }
}
