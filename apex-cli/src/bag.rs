//! `apex bag`: topics of a recording with their types, numbers, rates and gaps.

use crate::{answer::Answer, project::counted};
use apex_bag::{Contents, Topic};
use serde_json::{Value, json};
use std::{fmt::Write as _, path::Path, process::ExitCode, time::Duration};

/// Earliest time in ns that is one since 1970, as recorders of ROS have it: the first day of 2000. Times of Apex begin
/// at zero.
const SINCE_1970: u64 = 946_684_800 * 1_000_000_000;
/// Factor of the usual period from which on the longest time between two messages is a gap.
const GAP: u32 = 3;

/// Lists what is in the recording `file`. Exit code 1 if it is not complete.
pub fn run(file: &Path, answer: &mut Answer) -> Result<ExitCode, String> {
    let contents = Contents::read(file).map_err(|error| format!("cannot read `{}`: {error}", file.display()))?;
    answer.give(|| text(file, &contents), || json_of(&contents))?;
    Ok(ExitCode::from(u8::from(contents.cut.is_some())))
}

// Writing into a string cannot fail.
fn text(file: &Path, contents: &Contents) -> String {
    let messages: usize = contents.topics.iter().map(|topic| topic.count as usize).sum();
    let (first, last) = contents.times.unwrap_or_default();
    let lasts = Duration::from_nanos(last - first);
    let mut text = format!("`{}`: {} in {}", file.display(), counted(messages, "message"), seconds(lasts));
    if first >= SINCE_1970 {
        let _ = write!(text, ", from {} UTC", date(first));
    }
    if let Some(program) = &contents.program {
        let _ = write!(text, ", recorded by the program `{program}`");
    }
    text.push_str("\n\n");
    text.push_str(&table(contents, first));
    if let Some(cut) = &contents.cut {
        let _ = write!(text, "\n\nthe recording is incomplete: {cut}");
    }
    text
}

fn table(contents: &Contents, first: u64) -> String {
    let mut rows = vec![["topic", "type", "messages", "rate", "longest gap"].map(str::to_owned)];
    rows.extend(contents.topics.iter().map(|topic| {
        let rate = topic.rate().map_or_else(String::new, |rate| format!("{rate:.1} Hz"));
        let gap =
            gap(topic).map(|(gap, at)| format!("{} at {}", seconds(gap), seconds(Duration::from_nanos(at - first))));
        let channel = &topic.channel;
        [channel.name.clone(), channel.schema.clone(), topic.count.to_string(), rate, gap.unwrap_or_default()]
    }));
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths = [width(0), width(1), width(2), width(3)];
    let lines = rows.iter().map(|[topic, ty, count, rate, gap]| {
        let [w0, w1, w2, w3] = widths;
        format!("{topic:w0$}  {ty:w1$}  {count:>w2$}  {rate:>w3$}  {gap}").trim_end().to_owned()
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Longest time between two messages, if it is much longer than usual.
fn gap(topic: &Topic) -> Option<(Duration, u64)> {
    let period = topic.period?;
    topic.gap.filter(|(gap, _)| *gap > period * GAP)
}

fn seconds(time: Duration) -> String {
    format!("{:.3} s", time.as_secs_f64())
}

/// Date and time of day of a time in ns since 1970: `2023-11-14 22:13:20`.
fn date(time: u64) -> String {
    let (days, second) = (time / 1_000_000_000 / 86_400, time / 1_000_000_000 % 86_400);
    // Years begin in March, so that the day of a leap year is the last one (Hinnant, "chrono-compatible low-level date
    // algorithms").
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    let (hour, minute, second) = (second / 3_600, second / 60 % 60, second % 60);
    format!("{year}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}")
}

fn json_of(contents: &Contents) -> Value {
    let ns = |time: Duration| u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
    let topics = contents.topics.iter().map(|topic| {
        let gap = topic.gap.map(|(gap, at)| json!({ "ns": ns(gap), "at_ns": at }));
        json!({
            "topic": topic.channel.topic, "name": topic.channel.name, "type": topic.channel.schema,
            "encoding": topic.channel.encoding, "messages": topic.count, "bytes": topic.bytes,
            "first_ns": topic.times.map(|times| times.0), "last_ns": topic.times.map(|times| times.1),
            "rate": topic.rate(), "period_ns": topic.period.map(ns), "gap": gap,
        })
    });
    json!({
        "program": contents.program, "first_ns": contents.times.map(|times| times.0),
        "last_ns": contents.times.map(|times| times.1), "incomplete": contents.cut,
        "topics": topics.collect::<Vec<Value>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (second, expected) in [
            (0, "1970-01-01 00:00:00"),
            (951_782_399, "2000-02-28 23:59:59"),
            (951_782_400, "2000-02-29 00:00:00"),
            (1_700_000_000, "2023-11-14 22:13:20"),
            (4_107_542_399, "2100-02-28 23:59:59"),
            (4_107_542_400, "2100-03-01 00:00:00"),
        ] {
            assert_eq!(date(second * 1_000_000_000), expected);
        }
    }
}
