//! Sessions of Zenoh as those of `rmw_zenoh`: peers that find one another by a router.

use crate::Error;
use std::{env, net::IpAddr};
use zenoh::{Config, Session, Wait as _};

/// Address of the router by default: that at which `rmw_zenohd` listens. Not `localhost`, which may be `::1` first.
pub const ROUTER: &str = "tcp/127.0.0.1:7447";

/// Environment variable with settings of Zenoh, as for `rmw_zenoh`: `KEY=VALUE;KEY=VALUE`.
const OVERRIDE: &str = "ZENOH_CONFIG_OVERRIDE";

/// Opens a session with the router at `router`.
///
/// # Errors
/// A setting is not one of Zenoh, or the session cannot be opened.
pub fn open(router: Option<&str>) -> Result<Session, Error> {
    let config = config(router, env::var(OVERRIDE).ok().as_deref())?;
    zenoh::open(config).wait().map_err(Error::zenoh("the session cannot be opened"))
}

/// Settings, and those of the environment. A router that the program names comes before that of the environment.
fn config(router: Option<&str>, overrides: Option<&str>) -> Result<Config, Error> {
    let address = router.unwrap_or(ROUTER);
    let mode = mode(address);
    let mut config = Config::default();
    let mut set = |key: &str, value: &str| {
        let why = |error| Error::new(format!("`{key}={value}` is not a setting of Zenoh: {error}"));
        config.insert_json5(key, value).map_err(why)
    };
    set("mode", &format!("{mode:?}"))?;
    set("connect/endpoints", &format!("[{address:?}]"))?;
    // A router that is not there yet, or not any more, is tried again for ever.
    set("connect/timeout_ms", "-1")?;
    set("connect/exit_on_failure", "false")?;
    set("connect/retry", "{ period_init_ms: 200, period_max_ms: 2000, period_increase_factor: 2 }")?;
    set("listen/endpoints", r#"["tcp/127.0.0.1:0"]"#)?;
    set("scouting/multicast/enabled", "false")?;
    set("scouting/gossip/enabled", "true")?;
    // The caches of publishers need it.
    set("timestamping/enabled", "true")?;
    for pair in overrides.unwrap_or("").split(';').map(str::trim).filter(|pair| !pair.is_empty()) {
        let (key, value) = pair
            .split_once('=')
            .ok_or_else(|| Error::new(format!("`{pair}` in `{OVERRIDE}` is not of the form `KEY=VALUE`")))?;
        if router.is_none() || key != "connect/endpoints" {
            set(key, value)?;
        }
    }
    Ok(config)
}

/// Mode of a session. A router on another machine serves clients: peers there listen on their own machine only, as
/// those of `rmw_zenoh` do.
fn mode(router: &str) -> &'static str {
    let address = router.split_once('/').map_or(router, |(_, address)| address);
    let host = address.rsplit_once(':').map_or(address, |(host, _)| host).trim_matches(['[', ']']);
    let is_here = host == "localhost" || host.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback() || ip.is_unspecified());
    if is_here { "peer" } else { "client" }
}

/// Returns the address of the router in the settings of a session, for messages.
pub fn address(router: Option<&str>) -> String {
    let of_environment = || {
        let pairs = env::var(OVERRIDE).ok()?;
        let pair = pairs.split(';').find_map(|pair| pair.trim().strip_prefix("connect/endpoints="))?;
        Some(pair.trim_matches(['[', ']', '"']).to_owned())
    };
    router.map(str::to_owned).or_else(of_environment).unwrap_or_else(|| ROUTER.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_router_elsewhere_makes_a_client() {
        for here in [ROUTER, "tcp/localhost:7447", "tcp/[::1]:7447", "tcp/127.0.0.2:1"] {
            assert_eq!(mode(here), "peer", "{here}");
        }
        for elsewhere in ["tcp/192.168.1.5:7447", "tcp/robot:7447", "tcp/[fe80::1]:7447"] {
            assert_eq!(mode(elsewhere), "client", "{elsewhere}");
        }
    }

    #[test]
    fn the_environment_changes_settings() {
        let get = |config: &Config, key| config.get_json(key).expect("a setting");
        let changed = config(None, Some("mode=\"client\"; connect/endpoints=[\"tcp/10.0.0.1:7447\"]")).expect("right");
        assert_eq!(get(&changed, "mode"), "\"client\"");
        assert!(get(&changed, "connect/endpoints").contains("10.0.0.1"));
        let named = config(Some("tcp/127.0.0.1:5"), Some("connect/endpoints=[\"tcp/10.0.0.1:7447\"]")).expect("right");
        assert!(get(&named, "connect/endpoints").contains("127.0.0.1:5"));
        let error = config(None, Some("mode")).expect_err("no value").to_string();
        assert_eq!(error, "`mode` in `ZENOH_CONFIG_OVERRIDE` is not of the form `KEY=VALUE`");
        let error = config(None, Some("mode=3")).expect_err("no mode").to_string();
        assert!(error.starts_with("`mode=3` is not a setting of Zenoh"), "{error}");
    }
}
