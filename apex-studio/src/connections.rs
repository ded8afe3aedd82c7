//! Connections of browsers and apps: a limited number of them, and a limited time for those that say nothing.

use axum::Router;
use hyper::server::conn::http1;
use hyper_util::{
    rt::{TokioIo, TokioTimer},
    service::TowerToHyperService,
};
use std::{
    collections::VecDeque,
    io,
    pin::Pin,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering::AcqRel},
    },
    task::{Context, Poll},
    time::Duration,
};
use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    net::{TcpListener, TcpStream},
    task::AbortHandle,
    time,
};

/// Time that a browser has for its token, and for taking a message.
pub const PATIENCE: Duration = Duration::from_secs(10);
/// Maximum number of connections. When there are more, the oldest one ends that is not a page.
const MOST: usize = 128;
/// Time in which a browser has to take the files of a page, and may then ask for more.
const LIFE: Duration = Duration::from_secs(60);
/// Pause after an error of the machine, such as too many open files.
const PAUSE: Duration = Duration::from_millis(100);

/// Accepts connections forever.
pub async fn accept(listener: TcpListener, router: Router) {
    let (open, mut strangers) = (Arc::<AtomicUsize>::default(), VecDeque::<AbortHandle>::new());
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            time::sleep(PAUSE).await;
            continue;
        };
        strangers.retain(|stranger| !stranger.is_finished());
        let stream = Counted::new(stream, &open);
        if stream.number > MOST {
            // Pages have shown the token, or will have to soon.
            let Some(oldest) = strangers.pop_front() else { continue };
            oldest.abort();
        }
        let service = TowerToHyperService::new(router.clone());
        let talks = async move {
            let mut http = http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
            // A connection that becomes a page has another task from then on.
            let _ = time::timeout(LIFE, http.serve_connection(TokioIo::new(stream), service).with_upgrades()).await;
        };
        strangers.push_back(tokio::spawn(talks).abort_handle());
    }
}

/// A connection that is counted as long as it lives.
struct Counted {
    stream: TcpStream,
    /// Number of connections with this one.
    number: usize,
    open: Arc<AtomicUsize>,
}

impl Counted {
    fn new(stream: TcpStream, open: &Arc<AtomicUsize>) -> Self {
        Self { stream, number: open.fetch_add(1, AcqRel) + 1, open: Arc::clone(open) }
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        self.open.fetch_sub(1, AcqRel);
    }
}

impl AsyncRead for Counted {
    fn poll_read(mut self: Pin<&mut Self>, cx: &mut Context<'_>, into: &mut ReadBuf<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_read(cx, into)
    }
}

impl AsyncWrite for Counted {
    fn poll_write(mut self: Pin<&mut Self>, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        Pin::new(&mut self.stream).poll_write(cx, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
