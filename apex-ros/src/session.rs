//! Sessions of Zenoh as those of `rmw_zenoh`: peers that find one another by a router.

use crate::{Error, silence::PATIENCE};
use std::{
    env,
    net::IpAddr,
    sync::mpsc::{self, RecvTimeoutError},
    thread,
};
use zenoh::{Config, Session, Wait as _};

/// Address of the router by default: that at which `rmw_zenohd` listens. Not `localhost`, which may be `::1` first.
pub const ROUTER: &str = "tcp/127.0.0.1:7447";

/// Environment variable with settings of Zenoh, as for `rmw_zenoh`: `KEY=VALUE;KEY=VALUE`.
const OVERRIDE: &str = "ZENOH_CONFIG_OVERRIDE";

/// Open session.
pub struct Opened {
    pub session: Session,
    /// Addresses of its routers, for messages.
    pub router: String,
    /// Reason why other programs may not be met.
    pub doubt: Option<&'static str>,
}

/// Opens a session with the router at `router`. A client waits for its router: `tell` hears of a long wait, and of its
/// end.
///
/// # Errors
/// A setting is not one of Zenoh, or the session cannot be opened.
pub fn open(router: Option<&str>, tell: &(dyn Fn(&str) + Send + Sync)) -> Result<Opened, Error> {
    let overrides = env::var(OVERRIDE).ok();
    let config = config(router, overrides.as_deref())?;
    let routers = addresses(router, overrides.as_deref());
    let (doubt, router) = (doubt(&config, &routers), &routers.join("` or `"));
    let (opened, is_opened) = mpsc::channel::<()>();
    let (session, has_waited) = thread::scope(|scope| {
        let waits = scope.spawn(move || {
            let is_long = is_opened.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout);
            is_long.then(|| tell(&no_router(router))).is_some()
        });
        let session = zenoh::open(config).wait();
        drop(opened);
        (session, waits.join().unwrap_or_default())
    });
    let session = session.map_err(Error::zenoh("the session cannot be opened"))?;
    has_waited.then(|| tell(&a_router(router)));
    Ok(Opened { session, router: router.clone(), doubt })
}

/// Words for a router that is not there.
pub fn no_router(address: &str) -> String {
    format!(
        "no router of Zenoh answers at `{address}`: start one (`ros2 run rmw_zenoh_cpp rmw_zenohd`, or `zenohd`), or name \
         another one with `ZENOH_CONFIG_OVERRIDE='connect/endpoints=[\"tcp/HOST:7447\"]'`"
    )
}

/// Words for a router that is there again.
pub fn a_router(address: &str) -> String {
    format!("a router answers at `{address}`")
}

/// Settings, and those of the environment. A router that the program names comes before that of the environment.
fn config(router: Option<&str>, overrides: Option<&str>) -> Result<Config, Error> {
    let addresses = addresses(router, overrides);
    let mode = mode(&addresses);
    let mut config = Config::default();
    let mut set = |key: &str, value: &str| {
        let why = |error| Error::new(format!("`{key}={value}` is not a setting of Zenoh: {error}"));
        config.insert_json5(key, value).map_err(why)
    };
    set("mode", &format!("{mode:?}"))?;
    set("connect/endpoints", &format!("{addresses:?}"))?;
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
fn mode(routers: &[String]) -> &'static str {
    if routers.iter().all(|router| is_here(router)) { "peer" } else { "client" }
}

/// Returns `true` if an address is one of this machine.
fn is_here(router: &str) -> bool {
    let address = router.split_once('/').map_or(router, |(_, address)| address);
    let host = address.rsplit_once(':').map_or(address, |(host, _)| host).trim_matches(['[', ']']);
    host == "localhost" || host.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback() || ip.is_unspecified())
}

/// Addresses of the routers: that which the program names, or those in the settings of the environment.
fn addresses(router: Option<&str>, overrides: Option<&str>) -> Vec<String> {
    let pairs = overrides.unwrap_or("").split(';');
    let list = pairs.filter_map(|pair| pair.trim().strip_prefix("connect/endpoints=")).next_back();
    let address = |text: &str| Some(text.trim_matches([' ', '[', ']', '"', '\'']).to_owned()).filter(|a| !a.is_empty());
    let of_environment = || list.map(|list| list.split(',').filter_map(address).collect());
    router.map(|router| vec![router.to_owned()]).or_else(of_environment).unwrap_or_else(|| vec![ROUTER.to_owned()])
}

/// Reason why other programs may not be met: the session is a peer of a router on another machine, and routers leave it
/// to peers to connect with one another.
fn doubt(config: &Config, routers: &[String]) -> Option<&'static str> {
    let is_peer = config.get_json("mode").is_ok_and(|mode| mode.contains("peer"));
    (is_peer && mode(routers) == "client").then_some(
        "this program is a peer of a router on another machine, which carries nothing for it: take `mode=\"peer\"` out \
         of `ZENOH_CONFIG_OVERRIDE`",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_router_elsewhere_makes_a_client() {
        // Named by the program, and by the environment.
        let modes = |address: &str| {
            let overrides = format!("connect/endpoints=[{address:?}]");
            [config(Some(address), None), config(None, Some(&overrides))]
                .map(|config| config.expect("right").get_json("mode").expect("a setting"))
        };
        for here in [ROUTER, "tcp/localhost:7447", "tcp/[::1]:7447", "tcp/127.0.0.2:1"] {
            assert_eq!(modes(here), ["\"peer\""; 2], "{here}");
        }
        for elsewhere in ["tcp/192.168.1.5:7447", "tcp/robot:7447", "tcp/[fe80::1]:7447"] {
            assert_eq!(modes(elsewhere), ["\"client\""; 2], "{elsewhere}");
        }
        let several = Some("connect/endpoints=[\"tcp/localhost:7447\", \"tcp/robot:7447\"]");
        assert_eq!(addresses(None, several), ["tcp/localhost:7447", "tcp/robot:7447"]);
        assert_eq!(config(None, several).expect("right").get_json("mode").expect("a setting"), "\"client\"");
    }

    #[test]
    fn a_peer_of_a_router_elsewhere_is_doubted() {
        let doubt = |overrides: &str| {
            let config = config(None, Some(overrides)).expect("right");
            doubt(&config, &addresses(None, Some(overrides)))
        };
        assert_eq!(doubt("connect/endpoints=[\"tcp/robot:7447\"]"), None);
        assert_eq!(doubt("mode=\"peer\""), None);
        let why = doubt("connect/endpoints=[\"tcp/robot:7447\"];mode=\"peer\"");
        assert!(why.is_some_and(|why| why.contains("take `mode=\"peer\"` out")), "{why:?}");
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
