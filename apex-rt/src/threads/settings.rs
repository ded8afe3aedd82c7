//! Settings of the thread of a group.

use crate::{Info, info::GroupInfo};

/// Applies the cores and the priority of its group to the current thread.
///
/// # Errors
/// The settings cannot be applied, for example because rights are missing, and the group has `rights = strict`.
pub fn apply(info: &Info, group: &GroupInfo) -> Result<(), String> {
    let Err(reason) = set(group) else { return Ok(()) };
    let message = format!("{}: thread `{}` {reason}", info.name, group.name);
    if group.strict {
        return Err(format!("{message}; the program ends because of `rights = strict`"));
    }
    eprintln!("{message}; it runs without these settings");
    Ok(())
}

#[cfg(all(feature = "realtime", target_os = "linux"))]
fn set(group: &GroupInfo) -> Result<(), String> {
    if !group.cores.is_empty() {
        set_cores(group.cores).map_err(|error| format!("cannot run on the cores {:?}: {error}", group.cores))?;
    }
    match group.priority {
        Some(priority) => {
            let policy = if group.round_robin { "rr" } else { "fifo" };
            set_priority(priority, group.round_robin)
                .map_err(|error| format!("cannot have priority {priority} ({policy}): {error}"))?;
            lock_memory()
        }
        None => Ok(()),
    }
}

/// Keeps all memory of the process from being paged out: a page fault would cost a real-time thread milliseconds. With
/// a limit, later allocations could fail, so that nothing is locked then.
#[cfg(all(feature = "realtime", target_os = "linux"))]
fn lock_memory() -> Result<(), String> {
    use nix::sys::{
        mman::{MlockAllFlags, mlockall},
        resource::{RLIM_INFINITY, Resource, getrlimit},
    };
    let is_limited = getrlimit(Resource::RLIMIT_MEMLOCK).map_or(true, |(soft, _)| soft != RLIM_INFINITY);
    if is_limited && !nix::unistd::geteuid().is_root() {
        return Err("cannot lock its memory: the limit of locked memory (`ulimit -l`) is not `unlimited`".to_owned());
    }
    mlockall(MlockAllFlags::MCL_CURRENT | MlockAllFlags::MCL_FUTURE)
        .map_err(|error| format!("cannot lock its memory: {error}"))
}

#[cfg(all(feature = "realtime", target_os = "linux"))]
fn set_cores(cores: &[usize]) -> nix::Result<()> {
    let mut set = nix::sched::CpuSet::new();
    cores.iter().try_for_each(|core| set.set(*core))?;
    nix::sched::sched_setaffinity(nix::unistd::Pid::from_raw(0), &set)
}

#[cfg(all(feature = "realtime", target_os = "linux"))]
fn set_priority(priority: u8, round_robin: bool) -> Result<(), String> {
    use thread_priority::{
        RealtimeThreadSchedulePolicy::{Fifo, RoundRobin},
        ThreadPriority, ThreadPriorityValue, ThreadSchedulePolicy, set_thread_priority_and_policy, thread_native_id,
    };
    let policy = ThreadSchedulePolicy::Realtime(if round_robin { RoundRobin } else { Fifo });
    let value = ThreadPriorityValue::try_from(priority).map_err(|error| format!("{error:?}"))?;
    set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), policy).map_err(|error| {
        match error {
            thread_priority::Error::OS(code) => std::io::Error::from_raw_os_error(code).to_string(),
            other => format!("{other:?}"),
        }
    })
}

#[cfg(not(all(feature = "realtime", target_os = "linux")))]
fn set(group: &GroupInfo) -> Result<(), String> {
    match group.cores.is_empty() && group.priority.is_none() {
        true => Ok(()),
        false => Err("has cores or a priority, which need Linux and the feature `realtime` of apex-rt".to_owned()),
    }
}
