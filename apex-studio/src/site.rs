//! Addresses of the studio in a browser. Pages of other sites may not talk to it, even if they name its address.

use axum::http::{HeaderMap, header};
use std::net::{IpAddr, SocketAddr};

/// Checks an origin under which a proxy shows the studio: `https://HOST` or `https://HOST:PORT`, as browsers write it.
///
/// # Errors
/// The text is not an origin.
pub fn origin(text: &str) -> Result<String, String> {
    let text = text.trim_end_matches('/').to_ascii_lowercase();
    let authority = text.strip_prefix("https://").or_else(|| text.strip_prefix("http://"));
    let is_part = |c: char| c.is_ascii_alphanumeric() || "-._:[]".contains(c);
    match authority {
        Some(authority) if !authority.is_empty() && authority.chars().all(is_part) => Ok(text),
        _ => Err("expected an origin as a browser shows it: `https://robot.example` or `https://robot.example:8443`"
            .to_owned()),
    }
}

/// The addresses of a studio.
pub struct Site {
    /// Its own.
    pub address: SocketAddr,
    /// Origins under which proxies show it.
    pub origins: Vec<String>,
}

/// Returns the text of a header.
fn text(headers: &HeaderMap, name: header::HeaderName) -> &str {
    headers.get(name).and_then(|value| value.to_str().ok()).unwrap_or_default()
}

/// `true` for a loopback address, or its name, with any port.
fn is_loopback(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if !port.ends_with(']') => name,
        _ => host,
    };
    let name = name.trim_start_matches('[').trim_end_matches(']');
    name == "localhost" || name.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
}

impl Site {
    /// `true` if a request names this studio: a page of another site may have given its own name to this address. To a
    /// loopback address a tunnel may lead (`ssh -L`), which has another port at its beginning.
    pub fn is_own_host(&self, headers: &HeaderMap) -> bool {
        let (host, ip) = (text(headers, header::HOST), self.address.ip());
        let own = [self.address.to_string(), format!("localhost:{}", self.address.port())];
        let is_of_proxy = |origin: &String| origin.split_once("://").is_some_and(|(_, authority)| authority == host);
        own.iter().any(|own| own == host)
            || ip.is_unspecified()
            || (ip.is_loopback() && is_loopback(host))
            || self.origins.iter().any(is_of_proxy)
    }

    /// Refuses other sites: their pages may not talk to a robot through the browser of its user.
    ///
    /// # Errors
    /// The reason why.
    pub fn admits(&self, headers: &HeaderMap) -> Result<(), &'static str> {
        if !self.is_own_host(headers) {
            return Err("this is not the host of the studio: behind a proxy, start it with `--origin`");
        }
        let origin = text(headers, header::ORIGIN);
        // The page comes from where the request goes to: no other site has had a part in it.
        let is_own = origin.strip_prefix("http://") == Some(text(headers, header::HOST));
        if is_own || self.origins.iter().any(|own| own == origin) {
            return Ok(());
        }
        Err("this is not a page of the studio: behind a proxy, start it with `--origin`")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn admits(address: &str, origins: &[&str], host: &str, from: &str) -> bool {
        let origins = origins.iter().map(|text| origin(text).unwrap()).collect();
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, host.parse().unwrap());
        headers.insert(header::ORIGIN, from.parse().unwrap());
        Site { address: address.parse().unwrap(), origins }.admits(&headers).is_ok()
    }

    #[test]
    fn tunnels_and_proxies_lead_to_the_studio() {
        let own = "127.0.0.1:7410";
        for host in ["127.0.0.1:7410", "localhost:7410", "localhost:8888", "127.0.0.1", "[::1]:99", "127.1.2.3:5"] {
            assert!(admits(own, &[], host, &format!("http://{host}")), "{host}");
        }
        let proxy = &["https://Robot.example/"][..];
        assert!(admits(own, proxy, "robot.example", "https://robot.example"));
        // A proxy that names the address to which it sends.
        assert!(admits(own, proxy, own, "https://robot.example"));
        assert!(admits("10.0.0.7:7410", proxy, "10.0.0.7:7410", "https://robot.example"));
    }

    #[test]
    fn other_sites_do_not() {
        let own = "127.0.0.1:7410";
        let others = [
            // A page that has given its name to this address.
            ("evil.example:7410", "http://evil.example:7410"),
            ("localhost.evil.example:7410", "http://localhost.evil.example:7410"),
            // Another server on this machine.
            ("localhost:7410", "http://localhost:3000"),
            ("127.0.0.1:7410", "http://localhost:7410"),
            ("localhost:7410", "https://localhost:7410"),
            ("localhost:7410", "http://evil.example"),
            ("localhost:7410", "null"),
            ("", "http://"),
            ("robot.example", "https://robot.example"),
        ];
        for (host, from) in others {
            assert!(!admits(own, &[], host, from), "{host} {from}");
        }
        assert!(!admits(own, &["https://robot.example"], "robot.example", "https://evil.example"));
        assert!(!admits("10.0.0.7:7410", &[], "localhost:7411", "http://localhost:7411"), "it is not reached so");
    }

    #[test]
    fn only_origins_are_origins() {
        assert_eq!(origin("HTTPS://robot.example:8443/").as_deref(), Ok("https://robot.example:8443"));
        for text in
            ["", "robot.example", "https://", "https://a/b", "https://a b", "ftp://a", "https://a?x", "*", "null"]
        {
            assert!(origin(text).is_err(), "{text}");
        }
    }
}
