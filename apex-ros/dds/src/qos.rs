//! Quality of service in the terms of DDS.

use apex_ros::{Durability, Qos, Reliability};
use rustdds::{Duration as Span, QosPolicies, QosPolicyBuilder, policy};
use std::time::Duration;

/// Time for which a reliable publisher waits for subscriptions that are behind, before a message is lost.
const WAIT: Span = Span::from_millis(100);

/// The policies of a subscription, or of an endpoint of a service.
pub fn policies(qos: &Qos) -> QosPolicies {
    policies_of(qos, QosPolicyBuilder::new())
}

/// The policies of a publisher. RustDDS keeps all that no subscription has taken, up to a limit, which is here that of
/// the messages for later ones.
pub fn policies_of_publisher(qos: &Qos) -> QosPolicies {
    match (qos.durability, qos.depth) {
        (Durability::TransientLocal, Some(depth)) => {
            policies_of(qos, QosPolicyBuilder::new().resource_limits(limits(depth)))
        }
        _ => policies(qos),
    }
}

fn policies_of(qos: &Qos, builder: QosPolicyBuilder) -> QosPolicies {
    let lease_duration = span(qos.lease);
    builder
        .reliability(match qos.reliability {
            Reliability::Reliable => policy::Reliability::Reliable { max_blocking_time: WAIT },
            Reliability::BestEffort => policy::Reliability::BestEffort,
        })
        .durability(match qos.durability {
            Durability::TransientLocal => policy::Durability::TransientLocal,
            Durability::Volatile => policy::Durability::Volatile,
        })
        .history(match qos.depth {
            Some(depth) => policy::History::KeepLast { depth: i32::try_from(depth.max(1)).unwrap_or(i32::MAX) },
            None => policy::History::KeepAll,
        })
        .deadline(policy::Deadline(span(qos.deadline)))
        .lifespan(policy::Lifespan { duration: span(qos.lifespan) })
        .liveliness(if qos.is_manual {
            policy::Liveliness::ManualByTopic { lease_duration }
        } else {
            policy::Liveliness::Automatic { lease_duration }
        })
        .build()
}

/// Room for this number of messages.
fn limits(depth: u32) -> policy::ResourceLimits {
    let max_samples = i32::try_from(depth.max(1)).unwrap_or(i32::MAX);
    policy::ResourceLimits { max_samples, max_instances: 1, max_samples_per_instance: max_samples }
}

/// The quality of an endpoint of another program. What it does not say is the default of DDS.
pub fn qos(policies: &QosPolicies, is_writer: bool) -> Qos {
    let reliability = match policies.reliability() {
        Some(policy::Reliability::BestEffort) => Reliability::BestEffort,
        Some(policy::Reliability::Reliable { .. }) => Reliability::Reliable,
        None if is_writer => Reliability::Reliable,
        None => Reliability::BestEffort,
    };
    let durability = match policies.durability() {
        Some(policy::Durability::Volatile) | None => Durability::Volatile,
        Some(_) => Durability::TransientLocal,
    };
    let depth = match policies.history() {
        Some(policy::History::KeepAll) => None,
        Some(policy::History::KeepLast { depth }) => Some(u32::try_from(depth).unwrap_or(1)),
        None => Some(1),
    };
    Qos { reliability, durability, depth, ..Qos::DEFAULT }
}

fn span(time: Option<Duration>) -> Span {
    time.map_or(Span::INFINITE, Span::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quality_comes_back() {
        let best = Qos::DEFAULT.best_effort().depth(3);
        for there in [Qos::DEFAULT, best, best.transient_local(), Qos { depth: None, ..Qos::DEFAULT }] {
            assert_eq!(qos(&policies(&there), true), there);
        }
        let none = QosPolicyBuilder::new().build();
        assert_eq!(qos(&none, true).reliability, Reliability::Reliable);
        assert_eq!(qos(&none, false).reliability, Reliability::BestEffort);
    }
}
