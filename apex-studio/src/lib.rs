//! `apex studio`: a page on which one sees a robot think, and one of a study that searches its parameters.
//!
//! The robot streams what it does ([`apex_rt::studio`]). This program connects to it, keeps the history, and serves the
//! page to browsers on this machine. It holds no state that a robot needs: it may come and go.

mod condition;
mod connections;
mod detail;
mod drawn;
mod editor;
mod foxglove;
mod journey;
mod kinds;
mod lane;
mod language;
mod live;
mod messages;
mod moment;
mod outbox;
mod passes;
mod picture;
mod pulse;
mod robot;
#[cfg(test)]
mod samples;
mod server;
mod session;
mod shadow;
mod site;
mod steps;
mod store;
mod study;
mod tokens;
mod top;
mod waits;
mod why;
mod words;

pub use robot::{Remote, Robot};
pub use shadow::{Recorded, Shadow};
pub use site::origin;
pub use study::Study;
pub use top::top;

use apex_diagram::Item;
use robot::{Shared, follow};
use server::{Served, Serving};
use session::Beside;
use site::Site;
use std::{fmt::Write as _, io, net::SocketAddr, path::PathBuf, sync::Arc, thread};
use study::Followed;
use tokio::net::TcpListener;

/// The source of a robot.
pub trait Source: Send + Sync + 'static {
    /// The picture of the graph with this name, or `None` if the source does not have it.
    fn picture(&self, name: &str) -> Option<Item>;

    /// Errors of the source, for which a changed robot is not started; `None` if it has none.
    fn errors(&self) -> Option<String>;

    /// Writes parameters, as TOML, to a file that does not exist yet. Returns its path.
    ///
    /// # Errors
    /// The file cannot be written.
    fn save_params(&self, params: &str) -> Result<String, String>;

    /// Writes a parameter into the source. Returns the place of the change.
    ///
    /// # Errors
    /// The value in the source is not a plain one, or the file cannot be written.
    fn write_param(&self, change: &ParamChange<'_>) -> Result<String, String>;

    /// The recording that the robot repeats, if it repeats one.
    ///
    /// # Errors
    /// Reason why a test cannot begin as the robot did.
    fn replayed(&self) -> Result<Option<Replayed>, String>;

    /// Writes a test of the graph `program` to a new file beside the source file. Returns its path.
    ///
    /// # Errors
    /// The file cannot be written, or the compiler finds mistakes in the test.
    fn write_test(&self, program: &str, test: &str) -> Result<String, String>;

    /// Contents of these files; empty for those that cannot be read.
    fn texts(&self, files: &[String]) -> Vec<String>;

    /// Absolute path of a source file of the robot that may be changed; `None` for files elsewhere.
    fn path(&self, file: &str) -> Option<PathBuf>;

    /// Replaces the text of a source file of the robot that may be changed.
    ///
    /// # Errors
    /// The file may not be changed, or cannot be written.
    fn write_text(&self, file: &str, text: &str) -> Result<(), String>;
}

/// A recording that a robot repeats.
#[derive(Debug, Clone)]
pub struct Replayed {
    /// Path of the file, from the folder of the source file.
    pub file: String,
    /// Names of the channels that have tokens.
    pub channels: Vec<String>,
    /// Times in ns of its first and last message, if it has some.
    pub range: Option<(i64, i64)>,
}

/// A new value of a parameter for the source.
#[derive(Debug, Clone, Copy)]
pub struct ParamChange<'a> {
    /// Path of the file with the node, as the compiler was given it.
    pub file: &'a str,
    /// Line of the node, from 1.
    pub line: usize,
    /// Name of the node, without the graphs around it.
    pub node: &'a str,
    /// Name of the parameter, without the node.
    pub param: &'a str,
    /// SI unit of the parameter.
    pub unit: Option<&'a str>,
    /// Value in TOML, in SI.
    pub value: &'a str,
}

/// A studio to be opened.
pub struct Studio {
    /// The robots, of which a page shows one at a time.
    pub robots: Vec<Seat>,
    /// Studies of `apex tune`, each with a page of its own. Without robots, the first page is that of a study.
    pub studies: Vec<Study>,
    /// Address of the page.
    pub address: SocketAddr,
    /// Origins under which proxies show the page, as [`origin`] returns them.
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
