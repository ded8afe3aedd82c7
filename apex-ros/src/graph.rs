//! Programs that are there, by their tokens.

use crate::{Endpoint, Kind, Token};
use std::{
    collections::HashMap,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};

/// All nodes and endpoints that are there, those of other domains too.
#[derive(Clone, Default)]
pub struct Graph(Arc<Mutex<HashMap<String, Token>>>);

/// Most tokens that are kept: a network that makes up more of them cannot use up the memory.
const MOST: usize = 100_000;

impl Graph {
    /// Adds the token of a program, or changes it.
    pub fn add(&self, key: &str, token: Token) {
        let mut tokens = self.tokens();
        if tokens.len() < MOST || tokens.contains_key(key) {
            tokens.insert(key.to_owned(), token);
        }
    }

    /// Removes a token that has gone.
    pub fn remove(&self, key: &str) {
        self.tokens().remove(key);
    }

    /// Returns the endpoints of a kind of the other programs.
    pub fn others(&self, kind: Kind, session: &str) -> Vec<Token> {
        let is_one = |token: &&Token| {
            token.session != session && token.endpoint.as_ref().is_some_and(|endpoint| endpoint.kind == kind)
        };
        self.tokens().values().filter(is_one).cloned().collect()
    }

    /// Returns `true` if there is an endpoint with this kind, name and type in a domain, in any program.
    pub fn has(&self, domain: u32, wanted: &Endpoint) -> bool {
        let is_wanted = |it: &Endpoint| Endpoint { qos: wanted.qos, ..it.clone() } == *wanted;
        let is_one = |token: &Token| token.domain == domain && token.endpoint.as_ref().is_some_and(is_wanted);
        self.tokens().values().any(is_one)
    }

    fn tokens(&self) -> MutexGuard<'_, HashMap<String, Token>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
