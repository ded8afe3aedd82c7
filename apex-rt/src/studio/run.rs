use super::{
    Stream,
    access::Access,
    asking::Asking,
    checkpoint::Checkpoints,
    message::{self, About},
    robot::Robot,
    server::Server,
    serving::Serving,
    shared::{Pace, Shared},
    socket::Listener,
    times::Times,
};
use crate::{
    Info, Program, RemoteParams,
    requests::{Requests, ServedRequests},
};
use rtrb::{Producer, RingBuffer};
use std::{
    env, io,
    string::String,
    sync::{Arc, Mutex, PoisonError, atomic::Ordering},
    vec,
    vec::Vec,
};

/// Environment variable with the address.
const ADDRESS: &str = "APEX_STUDIO";
/// Environment variable of programs that wait for a viewer.
const WAIT: &str = "APEX_STUDIO_WAIT";

/// Number of bytes of each thread group that may wait to be sent.
const ROOM: usize = 1 << 20;

/// A streamed run. When it is dropped, the viewers get the last messages.
///
/// ```
/// use apex_rt::{
///     drive_with,
///     prelude::*,
///     studio::{StreamedTime, Studio},
/// };
///
/// apex_macros::graph!("examples/blink.afg");
///
/// # fn main() -> std::io::Result<()> {
/// let studio = Studio::open::<Blink>("127.0.0.1:0", StreamedTime::Simulated)?;
/// assert!(studio.address().starts_with("127.0.0.1:"));
/// // `apex studio --connect` shows it meanwhile.
/// drive_with(Blink::new(), SimClock::until(Time::from_secs(1)), studio.stream(0));
/// # Ok(())
/// # }
/// ```
pub struct Studio {
    info: &'static Info,
    shared: Arc<Shared>,
    serving: Arc<Serving>,
    requests: Arc<Requests>,
    /// Rings of the groups that have no stream yet.
    rings: Mutex<Vec<Producer<u8>>>,
    address: String,
}

/// Time of a streamed program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StreamedTime {
    /// The machine's.
    Real,
    /// Simulated: viewers can halt the program.
    Simulated,
    /// Simulated, and the program waits until a viewer lets it run.
    Waiting,
}

impl Studio {
    /// Opens a socket at `address` for viewers of a program of type `P` that runs in a loop of its own. Call
    /// [`before_reaction`](crate::Observer::before_reaction) of its [stream](Self::stream) there.
    ///
    /// # Errors
    /// The socket cannot be opened.
    pub fn open<P: Program>(address: &str, time: StreamedTime) -> io::Result<Self> {
        Self::serving::<P>(address, time, Arc::new(Requests::new(P::PARAMS)))
    }

    /// Opens a socket as the environment variables say, if they do.
    ///
    /// # Errors
    /// The socket cannot be opened.
    pub fn of_environment<P: Program>(simulated: bool) -> io::Result<Option<Self>> {
        Self::wanted::<P>(simulated, Arc::new(Requests::new(P::PARAMS)))
    }

    /// Opens a socket if the environment asks for it. The program serves `requests`.
    pub(crate) fn wanted<P: Program>(simulated: bool, requests: Arc<Requests>) -> io::Result<Option<Self>> {
        let Some(address) = env::var_os(ADDRESS) else { return Ok(None) };
        let time = match (simulated, env::var_os(WAIT)) {
            (false, _) => StreamedTime::Real,
            (true, None) => StreamedTime::Simulated,
            (true, Some(_)) => StreamedTime::Waiting,
        };
        let address = address.into_string().map_err(|_| io::Error::new(io::ErrorKind::InvalidInput, "no UTF-8"))?;
        Self::serving::<P>(&address, time, requests).map(Some)
    }

    fn serving<P: Program>(address: &str, time: StreamedTime, requests: Arc<Requests>) -> io::Result<Self> {
        let listener = Listener::open(address)?;
        let access = Access::of_environment(&listener)?;
        let (info, channels) = (const { &P::INFO }, P::channels());
        // One ring for each group, and one for the watchdog.
        let (near, far): (Vec<_>, Vec<_>) = (0..info.groups.len().max(1) + 1).map(|_| RingBuffer::new(ROOM)).unzip();
        let pace = (time != StreamedTime::Real).then(|| Pace::new(time == StreamedTime::Waiting));
        let shared = Arc::new(Shared::new(info.nodes.len(), channels.len(), info.groups.len().max(1), pace));
        let mut about = vec![];
        let description = About::new(info, &channels, P::PARAMS, time != StreamedTime::Real);
        message::write(&message::Report::About(description), &mut about);
        let (address, params) = (listener.address(), RemoteParams::new(Arc::clone(&requests), P::PARAMS));
        let asking = Asking::new(params, Arc::clone(&shared));
        let robot = Robot { access, shared: Arc::clone(&shared), asking, about };
        let serving = Serving::of(Arc::clone(&shared), Server::new(listener, robot, far, channels))?;
        Ok(Self { info, shared, serving: Arc::new(serving), requests, rings: Mutex::new(near), address })
    }

    /// Address of the socket, with the port that the system has chosen if the given one was 0.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Returns the observer of a thread group. There is one for each group, and one more.
    pub fn stream(&self, group: usize) -> Option<Stream> {
        let info = self.info;
        let ring = self.rings.lock().unwrap_or_else(PoisonError::into_inner).pop()?;
        let requests = ServedRequests::new(Arc::clone(&self.requests));
        Some(Stream {
            ring,
            info,
            shared: Arc::clone(&self.shared),
            serving: Arc::clone(&self.serving),
            group: group as u32,
            requests,
            frame: vec![],
            now: 0,
            times: Times::default(),
            checkpoints: Checkpoints::default(),
        })
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        self.requests.end();
        self.shared.over.store(true, Ordering::Release);
        drop(self.serving.stop());
    }
}
