//! Shadows: replays beside the run that they repeat.

/// Environment variable of a replay that waits at the end of a file which is still being written.
const FOLLOW: &str = "APEX_REPLAY_FOLLOW";

/// Returns `true` in a program that repeats a run while that goes on, as the second robot of `apex studio --shadow`
/// does. A node that writes files writes none then: they would take the place of those of the first robot.
///
/// ```
/// use apex_rt::{is_shadow, prelude::*};
/// use std::{fs, io};
///
/// /// Writes a map into a file.
/// #[node]
/// fn save_map(map: &Vec<u8>) -> io::Result<()> {
///     if is_shadow() { Ok(()) } else { fs::write("map.png", map) }
/// }
///
/// assert!(!is_shadow());
/// ```
#[must_use]
pub fn is_shadow() -> bool {
    std::env::var_os(FOLLOW).is_some()
}
