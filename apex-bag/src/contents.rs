//! Contents of a recording, collected from all its messages.

use crate::{Channel, Recording};
use std::{collections::BTreeMap, io, path::Path, time::Duration};

/// Contents of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Contents {
    /// Name of the recorded program of Apex, if it is one of Apex.
    pub program: Option<String>,
    /// Times of the first and the last message, in ns; `None` without messages.
    pub times: Option<(u64, u64)>,
    /// Topics, in the order of their names.
    pub topics: Vec<Topic>,
    /// Reason why the recording could not be read to its end.
    pub cut: Option<String>,
}

/// Messages of a channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Topic {
    /// The channel.
    pub channel: Channel,
    /// Number of messages.
    pub count: u64,
    /// Number of bytes of all messages.
    pub bytes: u64,
    /// Times of the first and the last message, in ns; `None` without messages.
    pub times: Option<(u64, u64)>,
    /// Longest time without a message from the first to the last message of the recording, and the time in ns at which
    /// it began; `None` with less than two messages.
    pub gap: Option<(Duration, u64)>,
    /// Time between two messages that is exceeded by half of them; `None` with less than two messages.
    pub period: Option<Duration>,
}

impl Contents {
    /// Reads a whole recording.
    ///
    /// # Errors
    /// The file cannot be read, or is not a recording.
    pub fn read(path: &Path) -> io::Result<Self> {
        let mut recording = Recording::open(path)?;
        let mut seen: BTreeMap<u16, (Vec<u64>, u64)> = BTreeMap::new();
        while let Some(message) = recording.next_message()? {
            let (times, bytes) = seen.entry(message.channel).or_default();
            times.push(message.time);
            *bytes += message.data.len() as u64;
        }
        let channels = recording.channels().iter();
        let mut topics: Vec<_> = channels
            .map(|(id, channel)| {
                let (times, bytes) = seen.remove(id).unwrap_or_default();
                Topic::new(channel.clone(), times, bytes)
            })
            .collect();
        topics.sort_by(|a, b| a.channel.name.cmp(&b.channel.name));
        let times = topics.iter().filter_map(|topic| topic.times);
        let times = times.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        times.iter().for_each(|times| topics.iter_mut().for_each(|topic| topic.add_silence(*times)));
        let (program, cut) = (recording.program().map(str::to_owned), recording.cut().map(str::to_owned));
        Ok(Self { program, times, topics, cut })
    }
}

impl Topic {
    fn new(channel: Channel, mut times: Vec<u64>, bytes: u64) -> Self {
        times.sort_unstable();
        let mut steps: Vec<_> =
            times.windows(2).map(|pair| (Duration::from_nanos(pair[1] - pair[0]), pair[0])).collect();
        // The first of gaps of the same length.
        let gap = steps.iter().copied().reduce(|longest, step| if step.0 > longest.0 { step } else { longest });
        steps.sort_unstable();
        let period = steps.get(steps.len() / 2).map(|step| step.0);
        let range = times.first().copied().zip(times.last().copied());
        Self { channel, count: times.len() as u64, bytes, times: range, gap, period }
    }

    /// Adds the time before the first and after the last message in a recording that begins and ends at these times.
    fn add_silence(&mut self, (begin, end): (u64, u64)) {
        let Some(((first, last), gap)) = self.times.zip(self.gap.as_mut()) else { return };
        for (from, to) in [(begin, first), (last, end)] {
            let silence = Duration::from_nanos(to - from);
            if silence > gap.0 {
                *gap = (silence, from);
            }
        }
    }

    /// Mean number of messages per second between the first and the last one; `None` if there are less than two, or all
    /// at one time.
    pub fn rate(&self) -> Option<f64> {
        let (first, last) = self.times?;
        let seconds = Duration::from_nanos(last - first).as_secs_f64();
        (seconds > 0.0).then(|| (self.count - 1) as f64 / seconds)
    }
}
