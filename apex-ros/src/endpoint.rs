//! The endpoints of a node: their declaration, and everything that they share.

use crate::{
    Args, Carrier, Distribution, Endpoint, Error, Kind, NO_HASH, Qos, Token,
    name::{Scope, wire_type},
    silence::{Ours, Watch},
    time::RosTime,
    voice::Voice,
};
use std::{
    any::Any,
    hash::{BuildHasher as _, RandomState},
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicU64, Ordering},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

/// Function that is told reasons for silence, and of messages that cannot be read.
pub type Tell = Arc<dyn Fn(&str) + Send + Sync>;

/// The endpoints of a node, and what they share.
pub struct Endpoints {
    pub carrier: Arc<dyn Carrier>,
    pub domain: u32,
    pub scope: Scope,
    pub args: Args,
    pub distribution: Distribution,
    pub time: RosTime,
    pub watch: Arc<Watch>,
    pub tell: Tell,
    /// Seed of the identifications of goals.
    pub seed: u64,
    /// Leave to publish the events of the program.
    pub voice: Arc<Voice>,
    next: AtomicU64,
    /// Subscribers, servers and tokens, which end when they are dropped.
    kept: Mutex<Vec<Box<dyn Any + Send>>>,
    threads: Mutex<Vec<JoinHandle<()>>>,
}

/// An endpoint that is declared.
pub struct Declared {
    /// The endpoint, and what it has heard.
    pub ours: Arc<Ours>,
    /// Its token.
    pub token: Token,
}

/// Time that threads have to end when a node ends: a publisher sends its last message.
const END: Duration = Duration::from_secs(1);

impl Endpoints {
    pub fn new(
        carrier: Arc<dyn Carrier>,
        domain: u32,
        scope: Scope,
        args: Args,
        distribution: Distribution,
        tell: Tell,
        is_simulated: bool,
    ) -> Self {
        let seed = RandomState::new().hash_one(carrier.session());
        Self {
            seed,
            voice: Arc::default(),
            carrier,
            domain,
            scope,
            args,
            distribution,
            time: if is_simulated { RosTime::simulated() } else { RosTime::wall() },
            watch: Arc::default(),
            tell,
            next: AtomicU64::new(1),
            kept: Mutex::default(),
            threads: Mutex::default(),
        }
    }

    /// Identification of the session in tokens.
    pub fn session_id(&self) -> String {
        self.carrier.session()
    }

    /// Full name of a topic or service, after remapping.
    pub fn resolve(&self, name: &str) -> Result<String, Error> {
        self.args.resolve(name, &self.scope)
    }

    /// Returns an endpoint of this node.
    pub fn endpoint(&self, kind: Kind, full_name: &str, ty: &str, hash: &str, qos: Qos) -> Endpoint {
        let hash = if self.carrier.rules().hashes { self.distribution.hash(hash) } else { NO_HASH }.to_owned();
        Endpoint { kind, name: full_name.to_owned(), wire_type: wire_type(ty), hash, qos }
    }

    /// Declares an endpoint, so that others see it. Nothing is said about a `quiet` one that meets no other.
    pub fn add(
        &self,
        kind: Kind,
        name: &str,
        (ty, hash): (&str, &str),
        qos: Qos,
        quiet: bool,
    ) -> Result<Declared, Error> {
        if hash.is_empty() {
            return Err(Error::new(format!("`{name}`: `{ty}` is not a message of ROS 2: its hash is not known")));
        }
        let endpoint = self.endpoint(kind, &self.resolve(name)?, ty, hash, qos);
        let Scope { namespace, node } = self.scope.clone();
        let token = Token {
            domain: self.domain,
            session: self.session_id(),
            node_id: 0,
            id: self.next.fetch_add(1, Ordering::Relaxed),
            enclave: self.args.enclave.clone().unwrap_or_default(),
            namespace,
            node,
            endpoint: Some(endpoint.clone()),
        };
        self.keep(self.carrier.show(&token)?);
        let ours = Arc::new(Ours::new(endpoint, quiet));
        self.watch.add(Arc::clone(&ours));
        Ok(Declared { ours, token })
    }

    /// Returns the number of endpoints so far: the same in each run of a program.
    pub fn count(&self) -> u64 {
        self.next.load(Ordering::Relaxed)
    }

    /// Keeps something until the node ends.
    pub fn keep(&self, it: impl Any + Send) {
        locked(&self.kept).push(Box::new(it));
    }

    /// Starts a thread that ends by itself when the program or the node does.
    pub fn spawn(&self, name: &str, run: impl FnOnce() + Send + 'static) -> Result<(), Error> {
        let thread = thread::Builder::new().name(name.to_owned()).spawn(run);
        let thread = thread.map_err(|error| Error::new(format!("the thread `{name}` cannot be started: {error}")))?;
        locked(&self.threads).push(thread);
        Ok(())
    }

    /// Ends all endpoints. Publishers of a program that has ended send their last message before.
    pub fn close(&self) {
        self.watch.end();
        self.time.close();
        let kept = std::mem::take(&mut *locked(&self.kept));
        drop(kept);
        let (threads, start) = (std::mem::take(&mut *locked(&self.threads)), Instant::now());
        while threads.iter().any(|thread| !thread.is_finished()) && start.elapsed() < END {
            thread::sleep(Duration::from_millis(1));
        }
        self.carrier.close();
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
