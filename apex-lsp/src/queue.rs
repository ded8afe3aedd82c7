//! Queue of messages for the worker. All requests in it refer to the current texts. A request is answered at once if a
//! change makes it stale, if the editor cancels it, or if it waits too long.

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

/// Maximum number of requests in the queue.
const MAX_REQUESTS: usize = 1000;
/// Maximum number of messages in the queue. When it is full, the receiving thread waits.
const MAX_MESSAGES: usize = 10_000;

/// Next task of the worker.
#[derive(Debug)]
pub enum Task {
    /// A message from the editor.
    Message(Message),
    /// No message arrived for some time.
    Quiet,
}

/// Messages between the receiving thread and the worker.
#[derive(Default)]
pub struct Queue {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    waiting: VecDeque<Message>,
    /// Requests without an answer, each with the deadline for its answer.
    due: BTreeMap<RequestId, Instant>,
    closed: bool,
}

impl Queue {
    /// Adds a message; a request must be answered before `due`. Returns the answers to all requests that are rejected.
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

    /// Earliest deadline of a request.
    pub fn next_due(&self) -> Option<Instant> {
        self.state().due.values().min().copied()
    }

    /// Answers to the requests whose deadline has passed.
    pub fn overdue(&self, now: Instant) -> Vec<Response> {
        let mut state = self.state();
        let late: Vec<RequestId> = state.due.iter().filter(|(_, due)| **due <= now).map(|(id, _)| id.clone()).collect();
        let reason = "the server is busy with another request; try again later";
        state.refuse(late, ErrorCode::ServerCancelled, reason)
    }

    /// Waits for the next task. With `quiet`, returns `Task::Quiet` after this time without a message. Returns `None`
    /// at the end.
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

    /// `true` if the queue contains no message.
    pub fn is_empty(&self) -> bool {
        self.state().waiting.is_empty()
    }

    /// Marks a request as answered. Returns `true` if it had no answer before.
    pub fn wants(&self, id: &RequestId) -> bool {
        self.state().due.remove(id).is_some()
    }

    /// Closes the queue: no more messages arrive. Requests in it are still answered.
    pub fn close(&self) {
        self.state().closed = true;
        self.changed.notify_all();
    }

    /// Closes the queue and removes all messages.
    pub fn abandon(&self) {
        self.state().waiting.clear();
        self.close();
    }

    /// A poisoned lock is harmless: no code that holds it can leave the state inconsistent.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Cancels a request of the editor.
    fn cancel(&mut self, params: &Value) -> Vec<Response> {
        let id = params.get("id").and_then(|id| serde_json::from_value::<RequestId>(id.clone()).ok());
        let Some(id) = id.filter(|id| self.due.contains_key(id)) else { return vec![] };
        self.refuse(vec![id], ErrorCode::RequestCanceled, "cancelled")
    }

    /// Answers to the requests about a changed text that are still in the queue: their positions refer to the old text.
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
        let stale = stale.collect();
        self.refuse(stale, ErrorCode::ContentModified, "the file has changed since the request")
    }

    /// Takes requests out of the queue and returns their answers.
    fn refuse(&mut self, ids: Vec<RequestId>, code: ErrorCode, reason: &str) -> Vec<Response> {
        self.waiting.retain(|message| !matches!(message, Message::Request(r) if ids.contains(&r.id)));
        self.due.retain(|id, _| !ids.contains(id));
        ids.into_iter().map(|id| refused(id, code, reason.to_owned())).collect()
    }
}

fn refused(id: RequestId, code: ErrorCode, reason: String) -> Response {
    Response::new_err(id, code as i32, reason)
}

/// Path of the source file that a message refers to.
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

    /// Numbers of the requests that the worker takes until the queue is empty.
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
        // A request that the worker is processing.
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
        // What was answered is not answered again.
        assert_eq!(codes(queue.put(changed("file:///a.afg"), now)), [(1.into(), -32801)]);
        assert!(!queue.wants(&1.into()) && !queue.wants(&2.into()));
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
