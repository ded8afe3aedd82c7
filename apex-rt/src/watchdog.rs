//! Watchdogs outside of the process: systemd (`sd_notify`) and a device such as `/dev/watchdog`. They are fed as long
//! as every thread group is well: none is in the same reaction for too long, and all reactions meet their deadlines. A
//! robot whose program hangs is then restarted by something that does not depend on the program.
//!
//! The control threads only count: a thread of its own looks at the counts and feeds.

use core::time::Duration;
use std::{
    env,
    ffi::OsString,
    fs::{File, OpenOptions},
    io::Write as _,
    process,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError, Weak,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
    thread,
};

/// Environment variable with the socket of systemd.
const SOCKET: &str = "NOTIFY_SOCKET";
/// Environment variable with the time after which systemd takes the program for dead, in µs.
const INTERVAL: &str = "WATCHDOG_USEC";
/// Environment variable with the process that is meant, if it is not that of all.
const PROCESS: &str = "WATCHDOG_PID";
/// Environment variable with a device that is fed.
const DEVICE: &str = "APEX_WATCHDOG";
/// Time between two looks if only a device is fed. Devices wait for a minute, mostly.
const PAUSE: Duration = Duration::from_secs(1);

/// Counts of a thread group.
#[derive(Debug, Default)]
pub(crate) struct Health {
    /// Number of reactions that have begun and ended: odd within a reaction.
    beats: AtomicUsize,
    /// `true` if a reaction missed a deadline since the last look.
    is_late: AtomicBool,
}

impl Health {
    /// Counts the beginning of a reaction.
    pub fn begin(&self) {
        self.beats.fetch_add(1, Ordering::Relaxed);
    }

    /// Counts the end of a reaction, which may have missed a deadline.
    pub fn end(&self, is_late: bool) {
        if is_late {
            self.is_late.store(true, Ordering::Relaxed);
        }
        self.beats.fetch_add(1, Ordering::Release);
    }
}

/// Thread groups that are driven, and what is fed.
struct Fed {
    groups: Vec<(Weak<Health>, usize)>,
    outside: Option<Outside>,
    is_started: bool,
}

static FED: Mutex<Fed> = Mutex::new(Fed { groups: vec![], outside: None, is_started: false });

fn fed() -> MutexGuard<'static, Fed> {
    FED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the counts of a thread group, if the environment asks for a watchdog. The first group starts it.
pub(crate) fn register() -> Option<Arc<Health>> {
    let mut fed = fed();
    if !fed.is_started {
        fed.is_started = true;
        if let Some((mut outside, pause)) = Outside::of_environment() {
            outside.tell("READY=1");
            fed.outside = Some(outside);
            let feeds = thread::Builder::new().name("apex-watchdog".to_owned()).spawn(move || feed(pause));
            if let Err(error) = feeds {
                eprintln!("the watchdog is not fed: {error}");
            }
        }
    }
    fed.outside.as_ref()?;
    let health = Arc::new(Health::default());
    fed.groups.push((Arc::downgrade(&health), 0));
    Some(health)
}

/// Takes leave of the watchdogs when the last thread group has stopped: the program has ended as it should.
pub(crate) fn leave() {
    let mut fed = fed();
    fed.groups.retain(|(health, _)| health.strong_count() > 0);
    if fed.groups.is_empty()
        && let Some(outside) = &mut fed.outside
    {
        outside.leave();
    }
}

/// Feeds the watchdogs while all groups are well.
fn feed(pause: Duration) {
    loop {
        thread::sleep(pause);
        let Fed { groups, outside: Some(outside), .. } = &mut *fed() else { return };
        groups.retain(|(health, _)| health.strong_count() > 0);
        if !groups.is_empty() && groups.iter_mut().all(is_well) {
            outside.feed();
        }
    }
}

/// Returns `true` if a group is not in the reaction in which it was at the last look, and has met its deadlines since.
fn is_well((health, seen): &mut (Weak<Health>, usize)) -> bool {
    let Some(health) = health.upgrade() else { return true };
    let beats = health.beats.load(Ordering::Acquire);
    let hangs = beats % 2 == 1 && beats == *seen;
    *seen = beats;
    let is_late = health.is_late.swap(false, Ordering::Relaxed);
    !hangs && !is_late
}

/// The watchdogs of the environment.
struct Outside {
    #[cfg_attr(not(target_os = "linux"), expect(dead_code, reason = "systemd is on Linux alone"))]
    socket: Option<OsString>,
    device: Option<File>,
}

impl Outside {
    /// Returns the watchdogs that the environment asks for, and the time between two looks.
    fn of_environment() -> Option<(Self, Duration)> {
        let is_meant = env::var(PROCESS).is_ok_and(|id| id != process::id().to_string());
        let interval = env::var(INTERVAL).ok().filter(|_| !is_meant).and_then(|text| text.parse().ok());
        let interval = interval.map(Duration::from_micros);
        let device = env::var_os(DEVICE).and_then(|path| match OpenOptions::new().write(true).open(&path) {
            Ok(device) => Some(device),
            Err(error) => {
                eprintln!("the watchdog {} is not fed: {error}", path.display());
                None
            }
        });
        let socket = env::var_os(SOCKET).filter(|_| interval.is_some());
        // A group that hangs is noticed at the second look: long before the third one is due.
        let pause = interval.map_or(PAUSE, |interval| (interval / 4).min(PAUSE));
        (socket.is_some() || device.is_some()).then_some((Self { socket, device }, pause))
    }

    fn feed(&mut self) {
        self.tell("WATCHDOG=1");
        self.write(b"1");
    }

    /// Ends the watch: systemd waits for the end of the process, and the device is switched off (`V`).
    fn leave(&mut self) {
        self.tell("STOPPING=1");
        self.write(b"V");
    }

    fn write(&mut self, what: &[u8]) {
        if let Some(device) = &mut self.device {
            // A watchdog that cannot be fed does what it is there for.
            let _ = device.write_all(what);
        }
    }

    #[cfg(target_os = "linux")]
    fn tell(&mut self, what: &str) {
        use std::os::{
            linux::net::SocketAddrExt as _,
            unix::{
                ffi::OsStrExt as _,
                net::{SocketAddr, UnixDatagram},
            },
        };
        let Some(socket) = &self.socket else { return };
        let address = match socket.as_bytes().strip_prefix(b"@") {
            Some(name) => SocketAddr::from_abstract_name(name),
            None => SocketAddr::from_pathname(socket),
        };
        // As above: without news systemd acts.
        let _ = address.and_then(|address| UnixDatagram::unbound()?.send_to_addr(what.as_bytes(), &address));
    }

    #[cfg(not(target_os = "linux"))]
    fn tell(&mut self, _what: &str) {}
}
