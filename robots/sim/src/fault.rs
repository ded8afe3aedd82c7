use crate::Outage;
use apex_rt::Time;
use std::{fmt, str::FromStr, time::Duration};

/// Temporary fault of a device of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fault<K> {
    /// Kind of the fault.
    pub kind: K,
    /// Start of the fault.
    pub from: Time,
    /// End of the fault.
    pub until: Time,
}

impl<K: Copy + PartialEq> Fault<K> {
    /// Fault of an outage, whose kind is the number of one of `kinds`.
    pub fn of(outage: &Outage, kinds: &[K]) -> Self {
        Self { kind: kinds[outage.kind], from: outage.from, until: outage.until }
    }

    /// Returns `true` if this is a fault of a kind, at this time.
    pub fn is_on(&self, kind: K, now: Time) -> bool {
        self.kind == kind && self.from <= now && now < self.until
    }
}

impl<K: FromStr<Err = String>> FromStr for Fault<K> {
    type Err = String;

    /// Parses a fault such as `laser-frozen@100s..103s`.
    fn from_str(text: &str) -> Result<Self, String> {
        let cannot = |why: &str| format!("`{text}` is no fault: {why}; write one as `laser-frozen@100s..103s`");
        let (kind, times) = text.split_once('@').ok_or_else(|| cannot("there is no `@`"))?;
        let kind = kind.parse()?;
        let (from, until) = times.split_once("..").ok_or_else(|| cannot("there is no `..` between its times"))?;
        let time = |text: &str| read_time(text).ok_or_else(|| cannot(&format!("`{text}` is no time in `s`")));
        let fault = Self { kind, from: time(from)?, until: time(until)? };
        if fault.from < fault.until { Ok(fault) } else { Err(cannot("it ends before it begins")) }
    }
}

/// Declares the kinds of faults of a robot: an `enum` with the name of each kind on the command line and in tables. The
/// type has `ALL` kinds and their `name`, and is read and written by its name.
///
/// ```
/// apex_sim::fault_kinds! {
///     /// Kind of a fault.
///     pub enum FaultKind {
///         /// The scanner sends nothing.
///         LaserSilent = "laser-silent",
///         /// The images of the camera are black.
///         EyeBlack = "eye-black",
///     }
/// }
///
/// assert_eq!("eye-black".parse(), Ok(FaultKind::EyeBlack));
/// assert_eq!(FaultKind::ALL.map(FaultKind::name), ["laser-silent", "eye-black"]);
/// ```
#[macro_export]
macro_rules! fault_kinds {
    (
        $(#[doc = $docs:literal])*
        pub enum $Kind:ident {
            $($(#[doc = $doc:literal])* $kind:ident = $name:literal,)*
        }
    ) => {
        $(#[doc = $docs])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $Kind {
            $($(#[doc = $doc])* $kind,)*
        }

        impl $Kind {
            /// All kinds of faults.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$kind),*];

            /// Name of the kind.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => $name,)*
                }
            }
        }

        impl ::std::str::FromStr for $Kind {
            type Err = ::std::string::String;

            fn from_str(text: &str) -> ::std::result::Result<Self, Self::Err> {
                $crate::fault_named(text, &Self::ALL, Self::name)
            }
        }

        impl ::std::fmt::Display for $Kind {
            fn fmt(&self, f: &mut ::std::fmt::Formatter<'_>) -> ::std::fmt::Result {
                f.pad(self.name())
            }
        }
    };
}

/// The kind of fault with this name, among `all` kinds.
///
/// # Errors
/// None of them has this name: a message with all names.
pub fn fault_named<K: Copy>(text: &str, all: &[K], name: fn(K) -> &'static str) -> Result<K, String> {
    let known = all.iter().copied().find(|known| name(*known) == text);
    let names = || all.iter().map(|known| name(*known)).collect::<Vec<_>>().join(", ");
    known.ok_or_else(|| format!("`{text}` is no kind of fault; there are {}", names()))
}

/// Parses a time such as `1.5s`.
fn read_time(text: &str) -> Option<Time> {
    let seconds: f64 = text.strip_suffix('s')?.parse().ok()?;
    Duration::try_from_secs_f64(seconds).ok().filter(|time| time.as_secs() < 1_000_000).map(|time| Time::ZERO + time)
}

impl<K: fmt::Display> fmt::Display for Fault<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}@{}s..{}s", self.kind, self.from.as_secs_f64(), self.until.as_secs_f64())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_on_from_its_start_to_its_end() {
        let outage = Outage { kind: 1, from: Time::from_secs(2), until: Time::from_secs(3) };
        let fault = Fault::of(&outage, &["laser", "camera"]);
        let at = [1999, 2000, 2999, 3000].map(|ms| fault.is_on("camera", Time::from_millis(ms)));
        assert_eq!(at, [false, true, true, false]);
        assert!(!fault.is_on("laser", outage.from));
    }
}
