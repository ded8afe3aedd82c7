//! Threads that may wait, for pages and apps.

use tokio::task;

/// A page or an app that works on threads which may wait: for the compiler, a file, or a robot. Meanwhile all others
/// are served.
pub struct Worker<P>(pub P);

impl<P: Send + 'static> Worker<P> {
    /// Lets it do something. Returns `None` after a panic, which ends this page only.
    pub async fn work<T: Send + 'static>(self, act: impl FnOnce(&mut P) -> T + Send + 'static) -> Option<(Self, T)> {
        let Self(mut page) = self;
        let worked = task::spawn_blocking(move || {
            let told = act(&mut page);
            (Self(page), told)
        });
        worked.await.ok()
    }
}
