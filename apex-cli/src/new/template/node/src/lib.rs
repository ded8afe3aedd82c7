//! Nodes for robots in Apex.
#![no_std]

use apex_rt::prelude::*;

/// Converts a measurement of an analogue-to-digital converter with 10 bits to V; `reference` is the voltage of its
/// largest value.
#[node]
pub fn volts(raw: &u16, #[param(unit = "V", default = 5.0, range = 0.0..=100.0)] reference: f64) -> f64 {
    f64::from(*raw) * reference / 1023.0
}

/// Sends `true` if a value is larger than a level.
#[node]
pub fn exceeds(raw: &u16, #[param] level: u16) -> bool {
    *raw > level
}

/// Passes a value on when it has changed and then stayed the same for a while: debounces a button.
#[node]
#[derive(Debug, Default)]
pub struct Debounce {
    /// Time for which a new value has to stay the same.
    #[param(unit = "s", default = 0.05, range = 0.0..=10.0)]
    hold: f32,
    seen: Option<(bool, Time)>,
    sent: Option<bool>,
}

#[node]
impl Debounce {
    fn process(&mut self, ctx: &Ctx, value: &bool) -> Option<bool> {
        let since = match self.seen {
            Some((seen, since)) if seen == *value => since,
            _ => ctx.now(),
        };
        self.seen = Some((*value, since));
        let stays = ctx.now().since(since).as_secs_f32() >= self.hold;
        if !stays || self.sent == Some(*value) {
            return None;
        }
        self.sent = Some(*value);
        self.sent
    }

    /// Sends the next value again, even if it is the same.
    #[slot]
    fn reset(&mut self) {
        self.sent = None;
    }
}

#[cfg(test)]
mod graphs {
    apex_macros::graph!("tests.afg");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_value_is_the_reference() {
        assert_eq!([volts(&0, 5.0), volts(&1023, 5.0)], [0.0, 5.0]);
    }

    #[test]
    fn what_bounces_is_held_back() {
        let mut node = Debounce { hold: 0.05, ..Debounce::default() };
        let values = [true, false, true, true, true, true, true];
        let sent = [0, 10, 20, 40, 60, 80, 100].map(Time::from_millis).into_iter().zip(values);
        let sent = sent.filter_map(|(now, value)| node.process(&Ctx::new(now), &value).map(|_| now));
        assert!(sent.eq([Time::from_millis(80)]));
    }
}
