//! The two threads of the server. One receives messages and ensures that every request is answered in time. The worker
//! checks source files and answers.

use crate::{
    capabilities::{Client, capabilities},
    queue::Queue,
    server::Server,
};
use lsp_server::{Connection, ErrorCode, Message, Request, Response};
use lsp_types::{
    InitializeParams, InitializeResult, ServerInfo,
    notification::{self, Notification as _},
    request::{self, Request as _},
};
use std::{
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

/// Usual time limit for an answer. If a check takes longer, the request is answered with an error.
pub const PATIENCE: Duration = Duration::from_secs(5);
/// Stack size of the worker in bytes: Rust code may be nested more deeply than source files.
const STACK: usize = 64 << 20;

/// Serves an editor until it disconnects, and answers every request within `patience`. Returns `false` if the editor
/// sends `exit` without `shutdown`.
pub fn serve(connection: &Connection, patience: Duration) -> bool {
    let Some(client) = initialize(connection) else { return true };
    let queue = Arc::new(Queue::default());
    let mut server = Server::new(connection.sender.clone(), queue.clone(), client);
    let worker = thread::Builder::new().name("apex-check".to_owned()).stack_size(STACK);
    let Ok(worker) = worker.spawn(move || server.run()) else { return false };
    let mut is_shut_down = false;
    loop {
        // Without a request there is no deadline to wake up for.
        let message = match queue.next_due() {
            None => connection.receiver.recv().map_err(|_| true),
            Some(due) => connection.receiver.recv_deadline(due).map_err(|e| e.is_disconnected()),
        };
        let answers = match message {
            Ok(Message::Notification(n)) if n.method == notification::Exit::METHOD => {
                queue.abandon();
                return is_shut_down;
            }
            Ok(Message::Request(request)) if is_shut_down || request.method == request::Shutdown::METHOD => {
                vec![shut_down(request, &mut is_shut_down)]
            }
            Ok(message) => {
                let now = Instant::now();
                queue.put(message, now.checked_add(patience).unwrap_or(now))
            }
            Err(false) => queue.overdue(Instant::now()),
            Err(true) => {
                queue.close();
                let _ = worker.join();
                return true;
            }
        };
        for answer in answers {
            // A closed connection is detected by the receiver.
            let _ = connection.sender.send(answer.into());
        }
    }
}

/// Initializes the connection. Returns `None` if the client disconnects.
fn initialize(connection: &Connection) -> Option<Client> {
    while let Ok(message) = connection.receiver.recv() {
        let answer = match message {
            Message::Request(Request { id, method, params }) if method == request::Initialize::METHOD => {
                let params: InitializeParams = serde_json::from_value(params).unwrap_or_default();
                let client = Client::new(&params.capabilities);
                let info = ServerInfo { name: "apex".to_owned(), version: Some(env!("CARGO_PKG_VERSION").to_owned()) };
                let result = InitializeResult { capabilities: capabilities(client.encoding), server_info: Some(info) };
                connection.sender.send(Response::new_ok(id, result).into()).ok()?;
                return Some(client);
            }
            Message::Request(request) => {
                let message = "the first request must be `initialize`".to_owned();
                Response::new_err(request.id, ErrorCode::ServerNotInitialized as i32, message)
            }
            Message::Notification(n) if n.method == notification::Exit::METHOD => return None,
            _ => continue,
        };
        connection.sender.send(answer.into()).ok()?;
    }
    None
}

/// Answer to `shutdown`, and to every later request.
fn shut_down(request: Request, is_shut_down: &mut bool) -> Response {
    if std::mem::replace(is_shut_down, true) {
        let message = "the server is shut down".to_owned();
        return Response::new_err(request.id, ErrorCode::InvalidRequest as i32, message);
    }
    Response::new_ok(request.id, ())
}
