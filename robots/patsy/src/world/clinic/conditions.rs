use std::{fs, path::Path, time::Duration};
use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

/// Conditions that make a clinic harder than a simulation usually is: the values of a world file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// The camera sees the container on the lift. The scanners always see its castors.
    pub load_in_view: bool,
    /// Time from the end of a turn of a scanner to the arrival of its scan, which has the stamp of that end.
    pub scan_latency: Duration,
    /// Time in which the mirror of a scanner turns once: the vehicle moves on in the meantime, which bends the scan.
    pub scan_turn: Duration,
    /// Share of the wanted motion that the wheels measure while something holds the vehicle.
    pub slip: f32,
    /// Time for which a container that is bumped into rolls on at the speed of the bump; it also turns. Without it, it
    /// stands like a wall.
    pub container_roll: Duration,
    /// Number of pieces of furniture that are tried to be placed at the walls of the corridors.
    pub corridor_furniture: usize,
    /// Number of people who push a trolley.
    pub trolleys: usize,
}

/// The kind ones.
impl Default for Conditions {
    fn default() -> Self {
        Self::KIND
    }
}

/// Value of a world file.
#[derive(Debug, Clone, Copy)]
pub struct Value {
    /// Key in the file.
    pub name: &'static str,
    /// Kind and range in messages.
    wanted: &'static str,
    kind: Kind,
}

/// Type of a value, with the greatest number, and its place in the conditions.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Flag(fn(&mut Conditions) -> &mut bool),
    Count(i64, fn(&mut Conditions) -> &mut usize),
    Share(fn(&mut Conditions) -> &mut f32),
    /// In s.
    Time(f64, fn(&mut Conditions) -> &mut Duration),
}

impl Conditions {
    /// Scans come at once and undistorted, containers stand like walls, and the corridors are empty.
    pub const KIND: Self = Self {
        load_in_view: false,
        scan_latency: Duration::ZERO,
        scan_turn: Duration::ZERO,
        slip: 0.0,
        container_roll: Duration::ZERO,
        corridor_furniture: 0,
        trolleys: 0,
    };

    /// The conditions of `harder.toml`. The turn is that of an S300 with 25 scans per second.
    pub const HARDER: Self = Self {
        load_in_view: true,
        scan_latency: Duration::from_millis(80),
        scan_turn: Duration::from_millis(40),
        slip: 0.5,
        container_roll: Duration::from_millis(200),
        corridor_furniture: 12,
        trolleys: 1,
    };

    /// Values of a world file, in the order of their documentation.
    pub const VALUES: [Value; 7] = [
        Value { name: "load_in_view", wanted: "`true` or `false`", kind: Kind::Flag(|c| &mut c.load_in_view) },
        Value {
            name: "scan_latency",
            wanted: "a time in s from 0 to 1",
            kind: Kind::Time(1.0, |c| &mut c.scan_latency),
        },
        Value { name: "scan_turn", wanted: "a time in s from 0 to 0.2", kind: Kind::Time(0.2, |c| &mut c.scan_turn) },
        Value { name: "slip", wanted: "a share from 0 to 1", kind: Kind::Share(|c| &mut c.slip) },
        Value {
            name: "container_roll",
            wanted: "a time in s from 0 to 2",
            kind: Kind::Time(2.0, |c| &mut c.container_roll),
        },
        Value {
            name: "corridor_furniture",
            wanted: "a whole number from 0 to 1000",
            kind: Kind::Count(1000, |c| &mut c.corridor_furniture),
        },
        Value { name: "trolleys", wanted: "a whole number from 0 to 100", kind: Kind::Count(100, |c| &mut c.trolleys) },
    ];

    /// The conditions of this name, `kind` or `harder`, or else those of a world file.
    ///
    /// # Errors
    /// The file cannot be read, or [`parse`](Self::parse) refuses its text.
    pub fn named(text: &str) -> Result<Self, String> {
        match text {
            "kind" => Ok(Self::KIND),
            "harder" => Ok(Self::HARDER),
            _ => Self::read(Path::new(text)),
        }
    }

    fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| {
            let path = path.display();
            format!("the world file `{path}` cannot be read: {error}; there are also the worlds `kind` and `harder`")
        })?;
        Self::parse(&text).map_err(|(line, message)| format!("{}:{line}: {message}", path.display()))
    }

    /// Reads the text of a world file. Values that it does not have are those of [`KIND`](Self::KIND).
    ///
    /// # Errors
    /// The number of the line, and what is wrong in it: it is not TOML, it has an unknown key, or a value that its key
    /// cannot have.
    pub fn parse(text: &str) -> Result<Self, (usize, String)> {
        let line = |at: usize| 1 + text[..at.min(text.len())].matches('\n').count();
        let table = DeTable::parse(text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            (line(at), format!("{}; write a value as `scan_latency = 0.08`", error.message()))
        })?;
        let mut conditions = Self::KIND;
        // In the order of the file, so that the first mistake is reported.
        let mut entries: Vec<_> = table.get_ref().iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        for (key, value) in entries {
            let name: &str = key.get_ref();
            let known = Self::VALUES.iter().find(|value| value.name == name);
            let known = known.ok_or_else(|| (line(key.span().start), unknown(name)))?;
            known.set(&mut conditions, value).ok_or_else(|| {
                let is = &text[value.span()];
                (line(value.span().start), format!("`{name}` is {}, not `{is}`", known.wanted))
            })?;
        }
        Ok(conditions)
    }

    /// These conditions with one value of others.
    #[must_use]
    pub fn with(mut self, value: &Value, mut other: Self) -> Self {
        match value.kind {
            Kind::Flag(place) => *place(&mut self) = *place(&mut other),
            Kind::Count(_, place) => *place(&mut self) = *place(&mut other),
            Kind::Share(place) => *place(&mut self) = *place(&mut other),
            Kind::Time(_, place) => *place(&mut self) = *place(&mut other),
        }
        self
    }
}

impl Value {
    /// Sets the value in the conditions. `None` if it has another type, or is out of range.
    fn set(&self, conditions: &mut Conditions, value: &Spanned<DeValue<'_>>) -> Option<()> {
        let value = value.get_ref();
        match self.kind {
            Kind::Flag(place) => *place(conditions) = value.as_bool()?,
            Kind::Count(most, place) => {
                let number = whole(value).filter(|number| *number <= most)?;
                *place(conditions) = usize::try_from(number).ok()?;
            }
            Kind::Share(place) => *place(conditions) = number(value, 1.0)? as f32,
            Kind::Time(most, place) => *place(conditions) = Duration::from_secs_f64(number(value, most)?),
        }
        Some(())
    }
}

/// Whole number.
fn whole(value: &DeValue<'_>) -> Option<i64> {
    let number = value.as_integer()?;
    i64::from_str_radix(number.as_str(), number.radix()).ok()
}

/// Number from 0 to `most`.
fn number(value: &DeValue<'_>, most: f64) -> Option<f64> {
    let number = match value {
        DeValue::Float(number) => number.as_str().parse().ok()?,
        _ => whole(value)? as f64,
    };
    (0.0..=most).contains(&number).then_some(number)
}

fn unknown(name: &str) -> String {
    let names = Conditions::VALUES.map(|value| format!("`{}`", value.name)).join(", ");
    format!("`{name}` is no value of a world; there are {names}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_has_the_harder_conditions() {
        assert_eq!(Conditions::parse(include_str!("../../../harder.toml")), Ok(Conditions::HARDER));
    }

    #[test]
    fn what_a_file_does_not_have_is_kind() {
        let text = "# one value\n\nscan_latency = 0.08";
        let one = Conditions { scan_latency: Duration::from_millis(80), ..Conditions::KIND };
        assert_eq!([Conditions::parse(""), Conditions::parse(text)], [Ok(Conditions::KIND), Ok(one)]);
    }

    #[test]
    fn mistakes_are_named_with_their_lines() {
        for (text, line, part) in [
            ("slip = 0.1\nsliip = 0.2", 2, "`sliip` is no value of a world; there are `load_in_view`, "),
            ("\n\nslip = 1.5", 3, "`slip` is a share from 0 to 1, not `1.5`"),
            ("slip = nan", 1, "not `nan`"),
            ("scan_latency = -0.1", 1, "`scan_latency` is a time in s from 0 to 1, not `-0.1`"),
            ("scan_latency = \"80ms\"", 1, "not `\"80ms\"`"),
            ("trolleys = 1\ntrolleys = 2", 2, "duplicate key"),
            ("trolleys = 1.5", 1, "`trolleys` is a whole number from 0 to 100, not `1.5`"),
            ("trolleys = -1", 1, "not `-1`"),
            ("load_in_view = 1", 1, "`load_in_view` is `true` or `false`, not `1`"),
            ("slip = 0.1\ntrolleys", 2, "write a value as `scan_latency = 0.08`"),
        ] {
            let (at, message) = Conditions::parse(text).expect_err(text);
            assert!(at == line && message.contains(part), "{text}: {at}: {message}");
        }
    }

    #[test]
    fn each_value_can_be_taken_alone() {
        let alone = Conditions::VALUES.map(|value| Conditions::KIND.with(&value, Conditions::HARDER));
        assert!(alone.iter().all(|one| *one != Conditions::KIND && *one != Conditions::HARDER));
        let all = Conditions::VALUES.iter().fold(Conditions::KIND, |sum, value| sum.with(value, Conditions::HARDER));
        assert_eq!(all, Conditions::HARDER);
    }
}
