//! The studio: robots and studies that are served until Ctrl-C.

use crate::{
    robot::{Robot, Shared, follow},
    server::{self, Served, Serving},
    session::Beside,
    site::Site,
    source::Source,
    study::{Followed, Study},
};
use std::{fmt::Write as _, io, net::SocketAddr, sync::Arc, thread};
use tokio::net::TcpListener;

/// A studio to be opened.
pub struct Studio {
    /// The robots, of which a page shows one at a time.
    pub robots: Vec<Seat>,
    /// Studies of `apex tune`, each with a page of its own. Without robots, the first page is that of a study.
    pub studies: Vec<Study>,
    /// Address of the page.
    pub address: SocketAddr,
    /// Origins under which proxies show the page, as [`crate::origin`] returns them.
    pub origins: Vec<String>,
    /// `true` if the page may only look.
    pub readonly: bool,
    /// Speed at which a simulated robot starts, in simulated seconds per second.
    pub speed: Option<f64>,
}

/// Addresses of an open studio. Each contains its token.
#[derive(Debug, Clone)]
pub struct Addresses {
    /// The page, for a browser.
    pub page: String,
    /// The page under each of the origins of proxies.
    pub proxied: Vec<String>,
    /// The first robot, for an app that knows the protocol of Foxglove. That of robot number `n`, from 0, follows after
    /// `/`.
    pub foxglove: String,
}

/// A robot with its place in the studio.
pub struct Seat {
    /// Name that distinguishes it from others of the same kind, such as its address.
    pub name: String,
    /// The robot.
    pub robot: Box<dyn Robot>,
    /// Its source.
    pub source: Arc<dyn Source>,
    /// Number of the robot before it whose shadow it is: a second one of the same kind that gets its inputs.
    pub shadow_of: Option<usize>,
}

impl Studio {
    /// Opens the studio, calls `opened` with the addresses, and serves them until Ctrl-C.
    ///
    /// # Errors
    /// The address is in use, or there are no random numbers for the token.
    pub fn serve(self, opened: impl FnOnce(&Addresses)) -> io::Result<()> {
        let token = token()?;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
        let served = runtime.block_on(async {
            let listener = TcpListener::bind(self.address).await?;
            let address = listener.local_addr()?;
            opened(&Addresses {
                page: format!("http://{address}/#{token}"),
                proxied: self.origins.iter().map(|origin| format!("{origin}/#{token}")).collect(),
                foxglove: format!("ws://{address}/foxglove/{token}"),
            });
            let (mut robots, mut threads) = (Vec::<Served>::new(), vec![]);
            for Seat { name, mut robot, source, shadow_of } in self.robots {
                let (shared, travels) = (Arc::<Shared>::default(), robot.repeats());
                // A shadow is as fast as the robot.
                let speed = if shadow_of.is_some() { Some(f64::INFINITY) } else { self.speed };
                let following = Arc::clone(&shared);
                let thread = thread::Builder::new().name("robot".to_owned());
                let comes_back = robot.comes_back();
                let thread = thread.spawn(move || follow(&mut *robot, &following, speed))?;
                // Robots that others have started are left alone at the end, also if they say nothing any more.
                threads.extend((!comes_back).then_some(thread));
                let own = shadow_of.and_then(|of| robots.get_mut(of));
                let beside = own.map(|of| {
                    of.beside = Some(Beside { shared: Arc::clone(&shared), is_shadow: true });
                    Beside { shared: Arc::clone(&of.shared), is_shadow: false }
                });
                robots.push(Served { name, shared, source, travels, beside });
            }
            let robots: Arc<[Served]> = robots.into();
            let serving = Serving {
                robots: Arc::clone(&robots),
                studies: self.studies.into_iter().map(|study| Arc::new(Followed::new(study))).collect(),
                token: token.into(),
                site: Arc::new(Site { address, origins: self.origins }),
                readonly: self.readonly,
            };
            server::serve(serving, listener, stopped()).await;
            robots.iter().for_each(|robot| robot.shared.end());
            for thread in threads {
                // It has ended its robot then.
                let _ = thread.join();
            }
            Ok(())
        });
        // What a page still waits for ends with the process.
        runtime.shutdown_background();
        served
    }
}

/// Waits for Ctrl-C, or for the end of the session.
async fn stopped() {
    #[cfg(unix)]
    if let Ok(mut ended) = tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()) {
        tokio::select! {
            _ = tokio::signal::ctrl_c() => {}
            _ = ended.recv() => {}
        }
        return;
    }
    // Without signals, the process ends at once.
    let _ = tokio::signal::ctrl_c().await;
}

/// Returns a random token.
fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| io::Error::other(error.to_string()))?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
