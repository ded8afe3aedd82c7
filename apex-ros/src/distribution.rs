//! Distributions of ROS 2.

use std::{env, str::FromStr};

/// A distribution of ROS 2. It decides at run time what a program writes: one binary serves all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Distribution {
    /// ROS 2 Humble (2022): types have no hashes.
    Humble,
    /// ROS 2 Jazzy (2024), and those with the same hashes of types.
    #[default]
    Jazzy,
    /// ROS 2 Kilted (2025).
    Kilted,
    /// ROS 2 Lyrical (2026).
    Lyrical,
    /// ROS 2 Rolling.
    Rolling,
}

/// Word that Humble writes in the place of a hash.
pub const NO_HASH: &str = "TypeHashNotSupported";

impl Distribution {
    /// Returns the distribution in the environment variable `ROS_DISTRO`; Jazzy if there is none.
    ///
    /// # Errors
    /// The distribution is not known.
    pub fn of_environment() -> Result<Self, crate::Error> {
        let wrong = |error| crate::Error::new(format!("`ROS_DISTRO`: {error}"));
        env::var("ROS_DISTRO").map_or(Ok(Self::default()), |name| name.parse().map_err(wrong))
    }

    /// Returns what this distribution writes for a type with this hash.
    pub const fn hash(self, hash: &str) -> &str {
        match self {
            Self::Humble => NO_HASH,
            _ => hash,
        }
    }
}

impl FromStr for Distribution {
    type Err = crate::Error;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Ok(match name {
            "humble" => Self::Humble,
            // Its types have the hashes of Jazzy.
            "iron" | "jazzy" => Self::Jazzy,
            "kilted" => Self::Kilted,
            "lyrical" => Self::Lyrical,
            "rolling" => Self::Rolling,
            _ => {
                return Err(crate::Error::new(format!(
                    "`{name}` is not a distribution of ROS 2 that is known: `humble`, `iron`, `jazzy`, `kilted`, \
                     `lyrical`, `rolling`"
                )));
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn humble_has_no_hashes() {
        assert_eq!("humble".parse::<Distribution>().map(|humble| humble.hash("RIHS01_ab")), Ok(NO_HASH));
        for name in ["iron", "jazzy", "kilted", "lyrical", "rolling"] {
            assert_eq!(name.parse::<Distribution>().map(|it| it.hash("RIHS01_ab")), Ok("RIHS01_ab"));
        }
        assert!("noetic".parse::<Distribution>().is_err());
    }
}
