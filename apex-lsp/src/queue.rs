//! Messages that wait for the worker. Every request in it is about the texts as they are: what a change makes stale,
//! what the editor takes back and what waits for too long is answered at once.

use crate::uri;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::{
    Uri,
    notification::{Cancel, DidChangeTextDocument, DidCloseTextDocument, Notification as _},
};
use serde_json::Value;
use std::{
    collections::{BTreeMap, VecDeque},
    str::FromStr as _,
    sync::{Condvar, Mutex, MutexGuard, PoisonError},
    time::{Duration, Instant},
};

/// Most requests that wait.
const MAX_REQUESTS: usize = 1000;
/// Most messages that wait: beyond, no more are taken until there is room.
const MAX_MESSAGES: usize = 10_000;

/// What the worker does next.
#[derive(Debug)]
pub enum Task {
    /// A message of the editor.
    Message(Message),
    /// Nothing came for a while.
    Quiet,
}

/// The messages that wait, for the thread that receives them and the worker.
#[derive(Default)]
pub struct Queue {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    waiting: VecDeque<Message>,
    /// The requests without an answer, and when each is answered at the latest.
    due: BTreeMap<RequestId, Instant>,
    closed: bool,
}

impl Queue {
    /// Adds a message; a request is to be answered before `due`. Gives the answers to the requests that need no others.
    pub fn put(&self, message: Message, due: Instant) -> Vec<Response> {
        let mut state = self.state();
        while state.waiting.len() >= MAX_MESSAGES && !state.closed {
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        let answers = match &message {
            Message::Request(request) if state.due.len() >= MAX_REQUESTS => {
                let reason = format!("more than {MAX_REQUESTS} requests wait");
                return vec![refused(request.id.clone(), ErrorCode::ServerCancelled, reason)];
            }
            Message::Request(request) => {
                state.due.insert(request.id.clone(), due);
                vec![]
            }
            Message::Notification(n) if n.method == Cancel::METHOD => return state.cancel(&n.params),
            Message::Notification(n) => state.stale(n),
            Message::Response(_) => return vec![],
        };
        state.waiting.push_back(message);
        self.changed.notify_all();
        answers
    }

    /// When the next request is due.
    pub fn next_due(&self) -> Option<Instant> {
        self.state().due.values().min().copied()
    }

    /// The answers to the requests that are due.
    pub fn overdue(&self, now: Instant) -> Vec<Response> {
        let mut state = self.state();
        let late: Vec<RequestId> = state.due.iter().filter(|(_, due)| **due <= now).map(|(id, _)| id.clone()).collect();
        let reason = "the server is busy with another request; try again later";
        late.into_iter().map(|id| state.refuse(id, ErrorCode::ServerCancelled, reason)).collect()
    }

    /// Waits for what comes next; at most for `quiet`, if there is something else to do. `None` at the end.
    pub fn take(&self, quiet: Option<Duration>) -> Option<Task> {
        let mut state = self.state();
        loop {
            if let Some(message) = state.waiting.pop_front() {
                self.changed.notify_all();
                return Some(Task::Message(message));
            }
            if state.closed {
                return None;
            }
            state = match quiet {
                None => self.changed.wait(state).unwrap_or_else(PoisonError::into_inner),
                Some(quiet) => {
                    let waited = self.changed.wait_timeout_while(state, quiet, |s| s.waiting.is_empty() && !s.closed);
                    let (state, waited) = waited.unwrap_or_else(PoisonError::into_inner);
                    if waited.timed_out() {
                        return Some(Task::Quiet);
                    }
                    state
                }
            };
        }
    }

    /// Whether no message waits.
    pub fn is_empty(&self) -> bool {
        self.state().waiting.is_empty()
    }

    /// Whether a request still has no answer; from now on it has one.
    pub fn wants(&self, id: &RequestId) -> bool {
        self.state().due.remove(id).is_some()
    }

    /// Nothing more comes. Requests that wait are still answered.
    pub fn close(&self) {
        self.state().closed = true;
        self.changed.notify_all();
    }

    /// Nothing more comes, and nothing is wanted.
    pub fn abandon(&self) {
        self.state().waiting.clear();
        self.close();
    }

    /// Nothing that could fail happens while the state is locked.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// The editor takes a request back.
    fn cancel(&mut self, params: &Value) -> Vec<Response> {
        let id = params.get("id").and_then(|id| serde_json::from_value::<RequestId>(id.clone()).ok());
        let Some(id) = id.filter(|id| self.due.contains_key(id)) else { return vec![] };
        self.waiting.retain(|message| !matches!(message, Message::Request(r) if r.id == id));
        vec![self.refuse(id, ErrorCode::RequestCanceled, "cancelled")]
    }

    /// Requests about a text that changes before they were looked at: their positions are those of the old text.
    fn stale(&mut self, notification: &Notification) -> Vec<Response> {
        if !matches!(notification.method.as_str(), DidChangeTextDocument::METHOD | DidCloseTextDocument::METHOD) {
            return vec![];
        }
        let Some(changed) = text(&notification.params) else { return vec![] };
        let is_stale = |r: &Request| text(&r.params).is_some_and(|about| about == changed);
        let stale = self.waiting.iter().filter_map(|message| match message {
            Message::Request(request) if is_stale(request) => Some(request.id.clone()),
            _ => None,
        });
        let stale: Vec<RequestId> = stale.collect();
        self.waiting.retain(|message| !matches!(message, Message::Request(r) if stale.contains(&r.id)));
        let reason = "the file has changed since the request";
        stale.into_iter().map(|id| self.refuse(id, ErrorCode::ContentModified, reason)).collect()
    }

    fn refuse(&mut self, id: RequestId, code: ErrorCode, reason: &str) -> Response {
        self.due.remove(&id);
        refused(id, code, reason.to_owned())
    }
}

fn refused(id: RequestId, code: ErrorCode, reason: String) -> Response {
    Response::new_err(id, code as i32, reason)
}

/// The text that a message is about.
fn text(params: &Value) -> Option<std::path::PathBuf> {
    Uri::from_str(params["textDocument"]["uri"].as_str()?).ok().map(|uri| uri::to_path(&uri))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn request(id: i32, uri: &str) -> Message {
        let params = json!({ "textDocument": { "uri": uri } });
        Message::Request(Request { id: id.into(), method: "textDocument/hover".to_owned(), params })
    }

    fn notification(method: &str, params: Value) -> Message {
        Message::Notification(Notification { method: method.to_owned(), params })
    }

    fn changed(uri: &str) -> Message {
        notification("textDocument/didChange", json!({ "textDocument": { "uri": uri } }))
    }

    fn codes(answers: Vec<Response>) -> Vec<(RequestId, i32)> {
        answers.into_iter().map(|a| (a.id, a.response_result.err().map_or(0, |e| e.code))).collect()
    }

    /// The numbers of the requests that the worker takes, until nothing waits.
    fn taken(queue: &Queue) -> Vec<RequestId> {
        let mut ids = vec![];
        while !queue.is_empty() {
            if let Some(Task::Message(Message::Request(request))) = queue.take(None) {
                ids.push(request.id);
            }
        }
        ids
    }

    #[test]
    fn a_change_makes_requests_stale() {
        let (queue, now) = (Queue::default(), Instant::now());
        for (id, uri) in [(1, "file:///a.afg"), (2, "file:///b.afg"), (3, "file:///%61.afg")] {
            assert!(queue.put(request(id, uri), now).is_empty());
        }
        let answers = queue.put(changed("file:///a.afg"), now);
        assert_eq!(codes(answers), [(1.into(), -32801), (3.into(), -32801)]);
        assert!(queue.put(request(4, "file:///a.afg"), now).is_empty());
        assert_eq!(taken(&queue), [2.into(), 4.into()]);
        assert!(queue.wants(&2.into()) && !queue.wants(&2.into()) && !queue.wants(&1.into()));
    }

    #[test]
    fn what_is_taken_back_is_not_done() {
        let (queue, now) = (Queue::default(), Instant::now());
        queue.put(request(1, "file:///a.afg"), now);
        queue.put(request(2, "file:///a.afg"), now);
        let cancel = |id: Value| queue.put(notification("$/cancelRequest", json!({ "id": id })), now);
        assert_eq!(codes(cancel(json!(1))), [(1.into(), -32800)]);
        assert!(cancel(json!(1)).is_empty() && cancel(json!([])).is_empty() && cancel(json!("2")).is_empty());
        assert_eq!(taken(&queue), [2.into()]);
        // One that the worker is busy with.
        assert_eq!(codes(cancel(json!(2))), [(2.into(), -32800)]);
        assert!(!queue.wants(&2.into()));
    }

    #[test]
    fn no_request_waits_for_ever() {
        let (queue, now) = (Queue::default(), Instant::now());
        let at = |seconds| now + Duration::from_secs(seconds);
        assert_eq!(queue.next_due(), None);
        queue.put(request(1, "file:///a.afg"), at(2));
        queue.put(request(2, "file:///a.afg"), at(1));
        assert_eq!(queue.next_due(), Some(at(1)));
        assert!(queue.overdue(now).is_empty());
        assert_eq!(codes(queue.overdue(at(1))), [(2.into(), -32802)]);
        assert_eq!(queue.next_due(), Some(at(2)));
        assert!(queue.wants(&1.into()) && !queue.wants(&2.into()));
        assert_eq!(queue.next_due(), None);
    }

    #[test]
    fn there_is_a_most() {
        let (queue, now) = (Queue::default(), Instant::now());
        for id in 0..MAX_REQUESTS {
            assert!(queue.put(request(id as i32, "file:///a.afg"), now).is_empty());
        }
        assert_eq!(codes(queue.put(request(-1, "file:///a.afg"), now)), [((-1).into(), -32802)]);
    }

    #[test]
    fn the_end() {
        let (queue, now) = (Queue::default(), Instant::now());
        queue.put(request(1, "file:///a.afg"), now);
        queue.close();
        assert!(matches!(queue.take(None), Some(Task::Message(_))));
        assert!(queue.take(None).is_none() && queue.take(Some(Duration::ZERO)).is_none());
    }
}
