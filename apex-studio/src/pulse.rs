//! Signs of life of a robot: a message each second, whatever its program does, which says whether that reacts.

use std::time::{Duration, Instant};

/// Time without a message after which a robot stands still, or the connection to it does.
const SILENCE: Duration = Duration::from_millis(2500);

/// Signs of life of a robot.
#[derive(Debug, Default)]
pub struct Pulse {
    /// Time of the last message.
    heard: Option<Instant>,
    /// Reactions of each thread group: their number, `true` within one, and the time since which that is so. Empty for
    /// robots that give no signs of life.
    groups: Vec<(u64, bool, Instant)>,
}

impl Pulse {
    /// A message has come.
    pub fn hear(&mut self, now: Instant) {
        self.heard = Some(now);
    }

    /// A sign of life has come.
    pub fn beat(&mut self, groups: Vec<(u64, bool)>, now: Instant) {
        let known = std::mem::take(&mut self.groups);
        self.groups = groups
            .into_iter()
            .enumerate()
            .map(|(at, (count, within))| match known.get(at) {
                Some((last, was, since)) if (*last, *was) == (count, within) => (count, within, *since),
                _ => (count, within, now),
            })
            .collect();
    }

    /// Says for how long nothing has come, or a reaction has lasted; `None` for a robot that is well.
    pub fn silence(&self, names: &[String], now: Instant) -> Option<String> {
        let heard = now.saturating_duration_since(self.heard.filter(|_| !self.groups.is_empty())?);
        if heard >= SILENCE {
            return Some(format!("no news for {} s", heard.as_secs_f64().round()));
        }
        let stuck = self.groups.iter().enumerate().filter(|(_, (_, within, _))| *within);
        let (at, since) =
            stuck.map(|(at, (.., since))| (at, now.saturating_duration_since(*since))).max_by_key(|s| s.1)?;
        let of = names.get(at).map_or_else(String::new, |name| format!(" of `{name}`"));
        (since >= SILENCE).then(|| format!("in one reaction{of} for {} s", since.as_secs_f64().round()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_that_stands_still_is_told_from_one_that_has_nothing_to_do() {
        let (start, names) = (Instant::now(), ["main".to_owned(), "arm".to_owned()]);
        let at = |seconds: u64| start + Duration::from_secs(seconds);
        let mut pulse = Pulse::default();
        pulse.hear(start);
        assert_eq!(pulse.silence(&names, at(100)), None, "one that gives no signs of life");
        for second in 0..=10 {
            pulse.hear(at(second));
            pulse.beat(vec![(7, false), (second.min(4), true)], at(second));
            let stuck = (second > 6).then(|| format!("in one reaction of `arm` for {} s", second - 4));
            assert_eq!(pulse.silence(&names, at(second)), stuck, "{second}");
        }
        assert_eq!(pulse.silence(&names, at(13)).as_deref(), Some("no news for 3 s"));
    }
}
