//! Tokens of one channel of a recording, for tests.

use super::{
    Codec,
    source::{FileChannel, Source},
    types::{TypeMatch, compare},
};
use core::time::Duration;
use std::{
    env,
    path::{Path, PathBuf},
};

/// Returns the tokens of the channel `channel` of a recording, with their times. The path `file` is relative to the
/// folder of the source file `text`.
///
/// # Panics
/// The file cannot be read, or has no such tokens.
pub fn tokens<T>(text: &str, file: &str, channel: &str, codec: Option<Codec<T>>) -> Vec<(Duration, T)> {
    try_tokens(&find(text, file), channel, codec).unwrap_or_else(|message| panic!("{message}"))
}

fn try_tokens<T>(path: &Path, channel: &str, codec: Option<Codec<T>>) -> Result<Vec<(Duration, T)>, String> {
    let codec =
        codec.ok_or("the tokens of the port cannot be read from a recording: their type is not known to serde")?;
    let cannot_read = |error| format!("cannot read `{}`: {error}", path.display());
    let mut source = Source::open(path).map_err(cannot_read)?;
    let (mut tokens, mut compared, mut start) = (vec![], None, None);
    while let Some(message) = source.next().map_err(cannot_read)? {
        // A later file of a recording that is divided begins in the middle of its run, and the times of other programs
        // may begin in 1970.
        let begins_late = source.program.is_none() || matches!(source.files, Some((2.., _)));
        let start = *start.get_or_insert(if begins_late { message.time } else { 0 });
        let found = source.channels.get(&message.channel);
        let Some(found) = found.filter(|c| c.name == channel || c.topic == channel) else { continue };
        if compared != Some(message.channel) {
            check(path, found, codec)?;
            compared = Some(message.channel);
        }
        let token = (codec.read)(&message.data);
        let token = token.map_err(|reason| {
            let (ty, file) = (codec.schema.name, path.display());
            format!("a token of `{channel}` in `{file}` is not one of `{ty}`: {reason}")
        })?;
        tokens.push((Duration::from_nanos(message.time.saturating_sub(start)), token));
    }
    if let Some(cut) = source.cut {
        return Err(format!("`{}` is incomplete: {cut}", path.display()));
    }
    if tokens.is_empty() {
        let names: Vec<String> = source.channels.values().map(|c| format!("`{}`", c.name)).collect();
        return Err(format!("`{}` has no tokens of `{channel}`; it has {}", path.display(), names.join(", ")));
    }
    Ok(tokens)
}

/// Checks that the recorded tokens are of the type of the port.
fn check<T>(path: &Path, channel: &FileChannel, codec: Codec<T>) -> Result<(), String> {
    match compare(channel, codec.schema, codec.shape) {
        TypeMatch::Same => {}
        TypeMatch::Undescribed => {
            let (name, file) = (&channel.name, path.display());
            eprintln!("warning: `{file}` does not describe the type of `{name}`: if it has changed, nothing tells");
        }
        TypeMatch::Changed(change) => {
            return Err(format!("`{}` cannot be fed: {change}\n  record it again", path.display()));
        }
    }
    Ok(())
}

/// Returns the path of `file`. Tests run in the folder of their package, but paths of source files begin at the
/// workspace.
fn find(text: &str, file: &str) -> PathBuf {
    let from_text = Path::new(text).parent().unwrap_or(Path::new("")).join(file);
    let here = env::current_dir().unwrap_or_default();
    let places = here.ancestors().map(|folder| folder.join(&from_text));
    places.into_iter().find(|path| path.exists()).unwrap_or(from_text)
}
