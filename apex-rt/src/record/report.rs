use super::{Channel, Reason, Role, TypeChange};
use crate::Time;
use core::fmt::{self, Display, Formatter};
use std::collections::BTreeMap;

/// Report on a replay.
///
/// ```
/// use apex_rt::record::Report;
///
/// let report = Report { dropped: vec![("camera.image".to_owned(), 2)], ..Report::default() };
/// // Nothing differs, but two images could not be repeated.
/// assert!(report.is_same() && !report.is_whole());
/// ```
#[derive(Debug, Default)]
pub struct Report {
    /// Number of repeated reactions.
    pub reactions: u64,
    /// Time of the last one.
    pub last: Option<Time>,
    /// Number of the file with which the replay began, in a recording that is divided: before a later one than the
    /// first there were reactions.
    pub file: u64,
    /// Number of reactions that are missing between others.
    pub skipped: u64,
    /// Results of comparison, by port.
    pub compared: Vec<Compared>,
    /// Channels of the program that the recording does not have.
    pub missing: Vec<(&'static str, Role)>,
    /// Channels of the recording that the program does not have.
    pub gone: Vec<String>,
    /// Messages on parameters whose values differ from the recorded ones.
    pub params: Vec<String>,
    /// Nodes whose tokens come from the recording, although connections lead to their slots.
    pub not_called: Vec<&'static str>,
    /// Numbers of messages that were lost during the recording, by channel.
    pub dropped: Vec<(String, u64)>,
    /// Numbers of recorded tokens that are not values of their types, by channel, with the reason for the first one.
    pub unreadable: BTreeMap<&'static str, (u64, Reason)>,
    /// Ports of the `record` statement that cannot be compared, because their types have changed.
    pub changed: Vec<TypeChange>,
    /// Channels for which the recording has no description of the type, as it is of an earlier version.
    pub undescribed: Vec<&'static str>,
    /// Number of times that a source which always sends had no recorded token, and sent its last one again.
    pub repeated: u64,
    /// Number of times that a thread waited in vain for a token that it had found in the recorded run.
    pub missed: u64,
    /// Reason why the recording ends before the run did.
    pub cut: Option<String>,
}

/// Comparison of the tokens of a port.
#[derive(Debug)]
pub struct Compared {
    /// Name of the port.
    pub name: &'static str,
    /// Number of tokens that were the same, bit by bit, in the same reaction.
    pub equal: u64,
    /// Number of tokens that differed, or existed in only one of the runs.
    pub different: u64,
    /// The first difference.
    pub first: Option<Difference>,
}

/// Two tokens that should be the same.
#[derive(Debug)]
pub struct Difference {
    /// Number of tokens of the port before this one.
    pub index: u64,
    /// The time of the reaction.
    pub time: Time,
    /// The recorded token; `None` if there was none.
    pub was: Option<String>,
    /// The token of the replay; `None` if there was none.
    pub is: Option<String>,
}

impl Compared {
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, equal: 0, different: 0, first: None }
    }
}

impl Report {
    /// Returns `true` if all tokens that could be compared were the same.
    pub fn is_same(&self) -> bool {
        self.missed == 0 && self.changed.is_empty() && self.compared.iter().all(|c| c.different == 0)
    }

    /// Returns `true` if the whole run was repeated: nothing in the recording is missing, lost or unreadable.
    pub fn is_whole(&self) -> bool {
        self.cut.is_none() && self.skipped == 0 && self.dropped.is_empty() && self.unreadable.is_empty()
    }

    /// Merges the reports of all groups of a program, of which that of the main group is the first.
    pub(super) fn of_groups(reports: Vec<Self>, channels: &[Channel]) -> Self {
        let mut all = Self::default();
        for (group, report) in reports.into_iter().enumerate() {
            all.reactions += report.reactions;
            all.last = all.last.max(report.last);
            all.skipped += report.skipped;
            all.unreadable.extend(report.unreadable);
            all.changed.extend(report.changed);
            all.undescribed.extend(report.undescribed);
            all.repeated += report.repeated;
            all.missed += report.missed;
            all.compared.extend(report.compared);
            all.missing.extend(report.missing);
            // Facts on the whole file are the same in all reports, except that a group that ended early may not know
            // them.
            all.cut = all.cut.or(report.cut);
            if all.dropped.is_empty() {
                all.dropped = report.dropped;
            }
            all.params.extend(report.params);
            all.not_called.extend(report.not_called);
            if group == 0 {
                all.file = report.file;
                all.gone = report.gone;
            }
        }
        let place = |name: &str| channels.iter().position(|c| c.name == name);
        all.compared.sort_by_key(|c| place(c.name));
        all.missing.sort_by_key(|(name, _)| place(name));
        all
    }
}

impl Report {
    /// Report as JSON, for programs. Times are in ns.
    pub(super) fn json(&self) -> String {
        let notes = format!("{}", Notes(self));
        let notes: Vec<String> = notes.lines().map(quoted).collect();
        let ports: Vec<String> = self.compared.iter().map(Compared::json).collect();
        let last = self.last.map_or("null".to_owned(), |last| last.as_nanos().to_string());
        format!(
            "{{\"reactions\": {}, \"last_ns\": {last}, \"same\": {}, \"whole\": {}, \"notes\": [{}], \"ports\": [{}]}}\n",
            self.reactions,
            self.is_same(),
            self.is_whole(),
            notes.join(", "),
            ports.join(", ")
        )
    }
}

/// The parts of a report that are not about the tokens of single ports.
struct Notes<'a>(&'a Report);

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Notes(self))?;
        for compared in &self.compared {
            write!(f, "{compared}")?;
        }
        let reactions = self.reactions;
        match (self.compared.is_empty(), self.is_same()) {
            (true, _) => {
                writeln!(f, "{reactions} reactions; nothing to compare: name connections in a `record` statement")
            }
            (false, true) => writeln!(f, "{reactions} reactions, all the same"),
            (false, false) => writeln!(f, "{reactions} reactions, with differences"),
        }
    }
}

impl Display for Notes<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self(report) = self;
        if report.file > 1 {
            let number = report.file;
            writeln!(f, "the recording begins with file {number} of a run: the program was in another state than now")?;
        }
        if let Some(cut) = &report.cut {
            write!(f, "the recording is incomplete: {cut}; only the part before that is compared")?;
            match report.last {
                Some(last) => writeln!(f, ", up to the reaction at {last}")?,
                None => writeln!(f)?,
            }
        }
        if report.skipped > 0 && report.dropped.is_empty() {
            writeln!(f, "{} reactions are missing in between: later tokens may differ", report.skipped)?;
        }
        for (channel, count) in &report.dropped {
            writeln!(f, "{count} messages of `{channel}` were lost during the recording: later tokens may differ")?;
        }
        if !report.undescribed.is_empty() {
            let names = report.undescribed.join("`, `");
            writeln!(
                f,
                "warning: the recording does not describe the types of `{names}`: if one has changed, nothing tells"
            )?;
        }
        for (channel, (count, reason)) in &report.unreadable {
            writeln!(f, "{count} recorded tokens of `{channel}` are not values of its type: {reason}")?;
        }
        for change in &report.changed {
            writeln!(f, "cannot compare: {change}")?;
        }
        if report.missed > 0 {
            writeln!(
                f,
                "{} times a thread waited in vain for another one, unlike during the recording",
                report.missed
            )?;
        }
        if report.repeated > 0 {
            let count = report.repeated;
            writeln!(
                f,
                "{count} times a source was due that was not due during the recording, and sent its last token again"
            )?;
        }
        for line in &report.params {
            writeln!(f, "parameter {line}")?;
        }
        if !report.not_called.is_empty() {
            let names = report.not_called.join("`, `");
            writeln!(f, "the tokens of `{names}` come from the recording, whatever reaches the slots")?;
        }
        for (name, role) in &report.missing {
            let why = match role {
                Role::Source => "is not in the recording: its node runs as usual",
                Role::Mailbox | Role::Event => "is not in the recording: it receives no tokens",
                Role::Chosen | Role::Port => "is not in the recording: nothing to compare it with",
            };
            writeln!(f, "`{name}` {why}")?;
        }
        for name in &report.gone {
            writeln!(f, "`{name}` is in the recording, but is not a recorded port of the program")?;
        }
        Ok(())
    }
}

impl Compared {
    fn json(&self) -> String {
        let token = |token: &Option<String>| token.as_deref().map_or("null".to_owned(), quoted);
        let first = self.first.as_ref().map_or("null".to_owned(), |first| {
            let (time, was, is) = (first.time.as_nanos(), token(&first.was), token(&first.is));
            format!("{{\"index\": {}, \"time_ns\": {time}, \"recorded\": {was}, \"replayed\": {is}}}", first.index)
        });
        let name = quoted(self.name);
        format!(
            "{{\"name\": {name}, \"equal\": {}, \"different\": {}, \"first\": {first}}}",
            self.equal, self.different
        )
    }
}

/// Text as a string of JSON.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c < ' ' => quoted += &format!("\\u{:04x}", u32::from(c)),
            c => quoted.push(c),
        }
    }
    quoted + "\""
}

impl Display for Compared {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let total = self.equal + self.different;
        writeln!(f, "`{}`: {} of {total} tokens the same", self.name, self.equal)?;
        let Some(first) = &self.first else { return Ok(()) };
        let (was, is) = around(first.was.as_deref().unwrap_or("nothing"), first.is.as_deref().unwrap_or("nothing"));
        writeln!(f, "  the first difference is token {}, at {}", first.index + 1, first.time)?;
        writeln!(f, "    recorded: {was}")?;
        writeln!(f, "    replayed: {is}")
    }
}

/// Numbers of characters shown before the first difference of two texts, and from it on.
const BEFORE: usize = 40;
const AFTER: usize = 60;

/// Shortens two texts to the surroundings of their first difference.
fn around(a: &str, b: &str) -> (String, String) {
    let same = a.chars().zip(b.chars()).take_while(|(a, b)| a == b).count();
    let start = same.saturating_sub(BEFORE);
    let part = |text: &str| {
        let mut shown: String = text.chars().skip(start).take(BEFORE + AFTER).collect();
        if start > 0 {
            shown.insert(0, '…');
        }
        if text.chars().nth(start + BEFORE + AFTER).is_some() {
            shown.push('…');
        }
        shown
    };
    (part(a), part(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_values_are_shown_where_they_differ() {
        let (a, b) = (format!("{}1{}", "x".repeat(100), "y".repeat(100)), format!("{}2", "x".repeat(100)));
        let (a, b) = around(&a, &b);
        assert_eq!(a, format!("…{}1{}…", "x".repeat(40), "y".repeat(59)));
        assert_eq!(b, format!("…{}2", "x".repeat(40)));
        assert_eq!(around("1.0", "nothing"), ("1.0".to_owned(), "nothing".to_owned()));
    }
}
