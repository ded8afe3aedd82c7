//! Processes that are copies of a program: the only place of the studio with `unsafe`.
#![cfg_attr(target_os = "linux", allow(unsafe_code))]

use std::{io, string::String};

#[cfg(target_os = "linux")]
pub use linux::{Control, Copied, Lifeline, adopt, alone, copy, end, ends_with_its_signals, is_scarce, outlive, reap};
#[cfg(not(target_os = "linux"))]
pub use other::{Control, Copied, Lifeline, adopt, alone, copy, end, ends_with_its_signals, is_scarce, outlive, reap};

/// Words between a process and its checkpoints.
pub const WAKE: u8 = b'w';
pub const DONE: u8 = b'd';
pub const FAILED: u8 = b'f';

#[cfg(target_os = "linux")]
mod linux {
    use super::{String, io};
    use nix::{
        errno::Errno,
        sys::{
            prctl,
            signal::{SigHandler, Signal, kill, signal},
            wait::{WaitPidFlag, waitpid},
        },
        unistd::{ForkResult, Pid, close, fork},
    };
    use std::{
        format, fs,
        io::{ErrorKind, Read as _, Write as _},
        os::{fd::IntoRawFd as _, unix::net::UnixStream},
        path::Path,
        string::ToString as _,
        sync::atomic::{AtomicI32, Ordering},
        thread,
        time::Duration,
        vec::Vec,
    };

    /// The two processes after a copy.
    pub enum Copied {
        /// This is the original; the copy has this number.
        Original(i32),
        /// This is the copy.
        Copy,
    }

    /// One end of a connection between a process and one of its checkpoints.
    pub struct Control(UnixStream);

    /// Time that a checkpoint has for an answer.
    const PATIENCE: Duration = Duration::from_secs(5);

    impl Control {
        /// Returns both ends of a new connection.
        pub fn pair() -> io::Result<(Self, Self)> {
            UnixStream::pair().map(|(one, other)| (Self(one), Self(other)))
        }

        /// Sends a word. Returns `false` if the other end is closed.
        pub fn say(&mut self, word: u8) -> bool {
            self.0.write_all(&[word]).is_ok()
        }

        /// Waits for a word; `None` if the other end is closed.
        pub fn hear(&mut self) -> Option<u8> {
            let mut word = [0];
            self.0.read_exact(&mut word).is_ok().then_some(word[0])
        }

        /// Waits for an answer for a limited time.
        pub fn answer(&mut self) -> Option<u8> {
            self.0.set_read_timeout(Some(PATIENCE)).ok()?;
            self.hear()
        }

        /// `true` if there is a process at the other end.
        pub fn is_alive(&mut self) -> bool {
            let (mut word, open) = ([0], self.0.set_nonblocking(true));
            let read = self.0.read(&mut word);
            let open = open.and_then(|()| self.0.set_nonblocking(false));
            open.is_ok() && matches!(read, Err(error) if error.kind() == ErrorKind::WouldBlock)
        }
    }

    /// The end of a connection to the first process.
    pub struct Lifeline(Control);

    impl Lifeline {
        /// Returns a lifeline, and the end that the first process keeps.
        pub fn new() -> io::Result<(Self, Control)> {
            let (far, near) = Control::pair()?;
            far.0.set_nonblocking(true)?;
            Ok((Self(far), near))
        }

        /// Returns another lifeline to the same process.
        pub fn share(&self) -> io::Result<Self> {
            self.0.0.try_clone().map(|shared| Self(Control(shared)))
        }

        /// Ends this process if the first one has ended.
        pub fn check(&self) {
            if matches!((&self.0.0).read(&mut [0]), Ok(0)) {
                end();
            }
        }
    }

    /// Name of the thread of the crate `ctrlc`: it waits in a system call for a signal, and holds no lock meanwhile.
    const HARMLESS: &str = "ctrl-c";
    /// Number and interval of looks at the threads: one that has ended is visible for a moment.
    const LOOKS: u32 = 50;
    const LOOK: Duration = Duration::from_micros(200);

    /// Checks that a copy of this process can go on in its place: it has no other threads, as they would be missing in
    /// the copy, and has read no file, as both would have one position in it. `own` are files that are read with a
    /// position of their own.
    ///
    /// # Errors
    /// The reason why it cannot.
    pub fn alone(own: &[&Path]) -> Result<(), String> {
        for _ in 1..LOOKS {
            if threads().is_empty() {
                break;
            }
            thread::sleep(LOOK);
        }
        if let Some(name) = threads().first() {
            return Err(format!("the program has threads of its own (`{name}`)"));
        }
        match files(own).first() {
            Some(file) => Err(format!("the program has read or written `{file}`")),
            None => Ok(()),
        }
    }

    /// Names of the other threads of this process.
    fn threads() -> Vec<String> {
        let own = nix::unistd::gettid().to_string();
        let Ok(all) = fs::read_dir("/proc/self/task") else { return [String::from("unknown")].into() };
        let others = all.flatten().filter(|task| task.file_name().to_str() != Some(&own));
        // One that has ended in the meantime has no name any more.
        let names = others.filter_map(|task| fs::read_to_string(task.path().join("comm")).ok());
        names.map(|name| name.trim_end().to_string()).filter(|name| name != HARMLESS).collect()
    }

    /// Open files with a position other than their beginning. The standard streams are those of all copies.
    fn files(own: &[&Path]) -> Vec<String> {
        let Ok(all) = fs::read_dir("/proc/self/fd") else { return [String::from("/proc")].into() };
        let is_moved = |number: &str| {
            let info = fs::read_to_string(format!("/proc/self/fdinfo/{number}")).unwrap_or_default();
            !info.lines().any(|line| line.strip_prefix("pos:").is_some_and(|at| at.trim() == "0"))
        };
        let mut found = Vec::new();
        for file in all.flatten() {
            let (number, Ok(path)) = (file.file_name(), fs::read_link(file.path())) else { continue };
            let number = number.to_string_lossy();
            let is_device = path.starts_with("/dev") || path.starts_with("/proc");
            let is_own = own.contains(&&*path) || number.parse::<i32>().is_ok_and(|number| number <= 2);
            if path.is_absolute() && !is_device && !is_own && is_moved(&number) {
                found.push(path.display().to_string());
            }
        }
        found
    }

    /// Copies this process.
    ///
    /// # Errors
    /// The machine has no room for another process.
    pub fn copy() -> io::Result<Copied> {
        // What is in the buffers would be written twice.
        io::stdout().flush()?;
        // SAFETY: `alone` was called before. So the copy lacks no thread that could hold a lock or would be waited for,
        // and may do everything that this process may.
        match unsafe { fork() }? {
            ForkResult::Parent { child } => Ok(Copied::Original(child.as_raw())),
            ForkResult::Child => Ok(Copied::Copy),
        }
    }

    /// Lets this process end at once at a signal, and its children disappear when they end (`as_checkpoint`), or wait
    /// to be waited for.
    pub fn ends_with_its_signals(as_checkpoint: bool) {
        let children = if as_checkpoint { SigHandler::SigIgn } else { SigHandler::SigDfl };
        // The thread that handled them may be missing here.
        let ends = ENDS.map(|signal| (signal, SigHandler::SigDfl));
        for (number, handler) in ends.into_iter().chain([(Signal::SIGCHLD, children)]) {
            // SAFETY: no handler is installed, only the two dispositions of the system.
            let _ = unsafe { signal(number, handler) };
        }
    }

    /// Signals at which a process ends.
    const ENDS: [Signal; 3] = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP];

    /// File descriptor of the first process's end of the lifeline, after another process has taken its place.
    static NEAR: AtomicI32 = AtomicI32::new(-1);

    /// Cuts the lifeline.
    extern "C" fn let_go(_signal: i32) {
        let near = NEAR.swap(-1, Ordering::AcqRel);
        if near >= 0 {
            let _ = close(near);
        }
    }

    /// Waits until all copies of this process have ended. A signal ends them before it ends this process, so that they
    /// hold nothing any more, such as a socket, when this process is gone. `near` is its end of their lifeline.
    pub fn outlive(near: Control) {
        NEAR.store(near.0.into_raw_fd(), Ordering::Release);
        for number in ENDS {
            // SAFETY: `let_go` does what a handler may: it swaps an atomic number and closes a file descriptor.
            let _ = unsafe { signal(number, SigHandler::Handler(let_go)) };
        }
        adopt();
        while waitpid(None, None::<WaitPidFlag>) != Err(Errno::ECHILD) {}
    }

    /// Ends this process at once: destructors belong to the original.
    pub fn end() -> ! {
        loop {
            let _ = kill(Pid::this(), Signal::SIGKILL);
        }
    }

    /// Takes note of the end of a child that has been told to end.
    pub fn reap(child: i32) {
        // A child of another process is none of ours.
        let _ = waitpid(Pid::from_raw(child), None);
    }

    /// Becomes the parent of all orphans among the checkpoints.
    pub fn adopt() {
        let _ = prctl::set_child_subreaper(true);
    }

    /// `true` if less than a quarter of the machine's memory is available.
    pub fn is_scarce() -> bool {
        let text = fs::read_to_string("/proc/meminfo").unwrap_or_default();
        let value = |name: &str| -> Option<u64> {
            text.lines().find_map(|line| line.strip_prefix(name)?.split_whitespace().next()?.parse().ok())
        };
        value("MemTotal:").zip(value("MemAvailable:")).is_none_or(|(all, left)| left < all / 4)
    }
}

#[cfg(not(target_os = "linux"))]
mod other {
    use super::{String, io};
    use std::path::Path;

    pub enum Copied {
        Original(i32),
        Copy,
    }

    pub struct Control;

    impl Control {
        pub fn pair() -> io::Result<(Self, Self)> {
            Err(io::ErrorKind::Unsupported.into())
        }
        pub fn say(&mut self, _word: u8) -> bool {
            false
        }
        pub fn hear(&mut self) -> Option<u8> {
            None
        }
        pub fn answer(&mut self) -> Option<u8> {
            None
        }
        pub fn is_alive(&mut self) -> bool {
            false
        }
    }

    pub struct Lifeline;

    impl Lifeline {
        pub fn new() -> io::Result<(Self, Control)> {
            Err(io::ErrorKind::Unsupported.into())
        }
        pub fn share(&self) -> io::Result<Self> {
            Err(io::ErrorKind::Unsupported.into())
        }
        pub fn check(&self) {}
    }

    pub fn alone(_own: &[&Path]) -> Result<(), String> {
        Err("this system cannot copy a process".into())
    }
    pub fn copy() -> io::Result<Copied> {
        Err(io::ErrorKind::Unsupported.into())
    }
    pub fn ends_with_its_signals(_as_checkpoint: bool) {}
    pub fn end() -> ! {
        std::process::exit(1)
    }
    pub fn reap(_child: i32) {}
    pub fn adopt() {}
    pub fn outlive(_near: Control) {}
    pub fn is_scarce() -> bool {
        true
    }
}
