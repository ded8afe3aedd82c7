//! Rights of viewers.

use super::socket::Listener;
use std::{
    env, format, io,
    string::{String, ToString as _},
};

/// Environment variable with the rights of viewers: [`READ`] or [`WRITE`].
const ACCESS: &str = "APEX_STUDIO_ACCESS";
const READ: &str = "read";
const WRITE: &str = "write";

/// Rights of the viewers of a robot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Access {
    /// `true` if viewers may only look.
    pub readonly: bool,
    /// Token that admits a viewer, if one is needed.
    pub token: Option<String>,
}

impl Access {
    /// Rights that the environment variables give at a socket. Without them, viewers may only look if other machines
    /// reach the socket; a warning says so.
    ///
    /// # Errors
    /// A variable has another value.
    pub fn of_environment(listener: &Listener) -> io::Result<Self> {
        let text = |name: &str| env::var_os(name).filter(|value| !value.is_empty());
        let access = text(ACCESS).map(|value| value.to_string_lossy().into_owned());
        let token = text(super::socket::TOKEN).map(|value| value.to_string_lossy().into_owned());
        let (access, warning) = Self::new(access.as_deref(), token, listener.is_public(), &listener.address())?;
        if let Some(warning) = warning {
            std::eprintln!("warning: {warning}");
        }
        Ok(access)
    }

    /// Rights at a socket with this address, which is `public` if other machines reach it. Returns a warning, too.
    fn new(
        wanted: Option<&str>,
        token: Option<String>,
        public: bool,
        address: &str,
    ) -> io::Result<(Self, Option<String>)> {
        let readonly = match wanted {
            None => public,
            Some(READ) => true,
            Some(WRITE) => false,
            Some(other) => {
                let why = format!("`{ACCESS}` is `{other}`: expected `{READ}` or `{WRITE}`");
                return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
            }
        };
        let warning = match (public, readonly, &token) {
            (false, ..) | (true, true, Some(_)) => None,
            (true, true, None) => Some(format!(
                "other machines reach {address}, and may look at the robot, but not set its parameters: `{ACCESS}={WRITE}` lets them do that, too, and `{}` keeps out those who do not have the same value",
                super::socket::TOKEN
            )),
            (true, false, None) => Some(format!(
                "everyone who reaches {address} from another machine can set the parameters of the robot: choose a loopback address, or a token in `{}`",
                super::socket::TOKEN
            )),
            (true, false, Some(_)) => Some(format!(
                "viewers at {address} may set the parameters of the robot, and their token travels unencrypted: use a network that you trust, or a tunnel"
            )),
        };
        Ok((Self { readonly, token }, warning))
    }

    /// `true` if `given` is the token. The time for that says nothing about it.
    pub fn admits(&self, given: &str) -> bool {
        let Some(token) = &self.token else { return true };
        let (given, token) = (given.as_bytes(), token.as_bytes());
        given.len() == token.len() && given.iter().zip(token).fold(0, |wrong, (a, b)| wrong | (a ^ b)) == 0
    }

    /// Reason why a viewer without the token is not admitted.
    pub fn refusal() -> String {
        format!("the robot wants a token: give the studio the same `{}` as the robot", super::socket::TOKEN).to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewers_from_other_machines_only_look_by_default() {
        let access = |wanted, token: Option<&str>, public| {
            Access::new(wanted, token.map(String::from), public, "0.0.0.0:7400")
                .map(|(access, warning)| (access.readonly, warning.unwrap_or_default()))
        };
        assert_eq!(access(None, None, false).unwrap(), (false, String::new()));
        assert_eq!(access(Some(READ), None, false).unwrap(), (true, String::new()));
        let (readonly, warning) = access(None, None, true).unwrap();
        assert!(readonly && warning.contains("not set its parameters"), "{warning}");
        let (readonly, warning) = access(Some(WRITE), None, true).unwrap();
        assert!(!readonly && warning.contains("everyone who reaches 0.0.0.0:7400"), "{warning}");
        assert!(access(Some(WRITE), Some("x"), true).unwrap().1.contains("unencrypted"));
        assert!(access(Some("all"), None, true).unwrap_err().to_string().contains("`read` or `write`"));
    }

    #[test]
    fn only_the_same_token_admits() {
        let access = |token: Option<&str>| Access { readonly: false, token: token.map(String::from) };
        assert!(access(None).admits("") && access(Some("secret")).admits("secret"));
        assert!(!["", "secre", "secret ", "sEcret"].iter().any(|token| access(Some("secret")).admits(token)));
    }
}
