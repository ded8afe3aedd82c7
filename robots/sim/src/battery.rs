use apex_rt::{Ctx, Event, Time, node};

/// Simulated battery, which loses its charge evenly while it is not connected to a charger, and gains it evenly while
/// it is. Needs a period, for example `every 50ms`.
#[node]
#[derive(Debug, Clone)]
pub struct Battery {
    /// Time in which a full battery is empty.
    #[param(unit = "s", default = 3600.0, range = 1.0..=1e9)]
    life: f32,
    /// Time in which an empty battery is full.
    #[param(unit = "s", default = 1800.0, range = 1.0..=1e9)]
    charging: f32,
    /// Charge at the beginning, from 0 (empty) to 1 (full).
    #[param(default = 1.0, range = 0.0..=1.0)]
    first: f32,
    /// Charge at the time of the last firing.
    last: Option<(f64, Time)>,
    is_connected: bool,
    /// `true` if the present end of the scale was reported.
    is_told: bool,
}

#[node]
impl Battery {
    /// Sends the charge, from 1 (full) to 0 (empty). `full` comes when a connected battery is full, `empty` when it is
    /// empty otherwise: each of them once.
    fn process(&mut self, ctx: &Ctx, full: Event<()>, empty: Event<()>) -> f32 {
        let (before, then) = self.last.unwrap_or((f64::from(self.first), ctx.now()));
        let passed = ctx.now().since(then).as_secs_f64();
        let gain = if self.is_connected { passed / f64::from(self.charging) } else { -passed / f64::from(self.life) };
        let charge = (before + gain).clamp(0.0, 1.0);
        self.last = Some((charge, ctx.now()));
        let end = if self.is_connected { 1.0 } else { 0.0 };
        if charge == end && !self.is_told {
            self.is_told = true;
            if self.is_connected { full.emit(()) } else { empty.emit(()) }
        }
        charge as f32
    }

    /// Connects the charger.
    #[slot]
    fn connect(&mut self) {
        self.is_told &= self.is_connected;
        self.is_connected = true;
    }

    /// Disconnects the charger.
    #[slot]
    fn disconnect(&mut self) {
        self.is_told &= !self.is_connected;
        self.is_connected = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct as _;

    /// Charge at this time in s, and `f`ull or `e`mpty.
    fn at(battery: &mut Battery, seconds: i64) -> (f32, char) {
        let (mut full, mut empty) = (None, None);
        let ctx = Ctx::new(Time::from_secs(seconds));
        let charge = battery.process(&ctx, apex_rt::event(&mut full), apex_rt::event(&mut empty));
        (
            charge,
            if full.is_some() {
                'f'
            } else if empty.is_some() {
                'e'
            } else {
                '-'
            },
        )
    }

    #[test]
    fn a_battery_is_emptied_and_charged() {
        let mut battery = Battery::construct((100.0, 50.0, 1.0));
        assert_eq!([0, 50, 75].map(|time| at(&mut battery, time)), [(1.0, '-'), (0.5, '-'), (0.25, '-')]);
        battery.connect();
        assert_eq!([100, 120, 130].map(|time| at(&mut battery, time)), [(0.75, '-'), (1.0, 'f'), (1.0, '-')]);
        battery.disconnect();
        assert_eq!(
            [140, 230, 240, 250].map(|time| at(&mut battery, time)),
            [(0.9, '-'), (0.0, 'e'), (0.0, '-'), (0.0, '-')]
        );
        battery.connect();
        battery.connect();
        assert_eq!([275, 300, 301].map(|time| at(&mut battery, time)), [(0.5, '-'), (1.0, 'f'), (1.0, '-')]);
    }

    #[test]
    fn a_small_period_loses_nothing() {
        let mut battery = Battery::construct((36_000.0, 1.0, 1.0));
        let mut charge = 1.0;
        for ms in (0..=18_000_000).step_by(50) {
            let (mut full, mut empty) = (None, None);
            let ctx = Ctx::new(Time::from_millis(ms));
            charge = battery.process(&ctx, apex_rt::event(&mut full), apex_rt::event(&mut empty));
        }
        assert!((charge - 0.5).abs() < 1e-6, "{charge}");
    }
}
