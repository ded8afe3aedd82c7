//! A robot as Foxglove sees it: the published protocol of its apps, as `foxglove.sdk.v1` and as the older
//! `foxglove.websocket.v1` (<https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md>).

mod channels;
mod messages;
mod parameters;
mod playback;
mod seen;
mod viewer;

pub use seen::Seen;

use crate::{connections::PATIENCE, worker::Worker};
use axum::extract::ws::{Message, WebSocket};
use messages::{Frame, asked};
use std::time::Duration;
use tokio::time;
use viewer::Viewer;

/// The names of the protocol in a handshake, the newer one first.
pub const PROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];

/// Interval at which an app gets news: shorter than the one at which a robot sends tokens, so that none is left out.
const TICK: Duration = Duration::from_millis(25);

/// Talks to an app until it leaves.
pub async fn talk(seen: Seen, mut socket: WebSocket) {
    let (mut viewer, mut tick) = (Worker(Viewer::new(seen)), time::interval(TICK));
    // An app that was slow gets the newest state, not all that it missed.
    tick.set_missed_tick_behavior(time::MissedTickBehavior::Skip);
    loop {
        let worked = tokio::select! {
            _ = tick.tick() => viewer.work(Viewer::news).await,
            message = socket.recv() => match message {
                Some(Ok(Message::Close(_)) | Err(_)) | None => return,
                Some(Ok(message)) => viewer.work(move |viewer| match asked(&message) {
                    Ok(Some(asked)) => viewer.answer(asked),
                    Ok(None) => vec![],
                    Err(why) => vec![Frame::error(why)],
                }).await,
            },
        };
        let Some((worker, frames)) = worked else { return };
        viewer = worker;
        for frame in &frames {
            let sent = time::timeout(PATIENCE, socket.send(frame.message())).await;
            if !matches!(sent, Ok(Ok(()))) {
                return;
            }
        }
    }
}
