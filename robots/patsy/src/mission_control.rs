use crate::Order;
use apex_nodes::scan::{Container, Pose2};
use apex_rt::{Ctx, Event, node};

/// Decides what the vehicle does next (thesis 8.2, *Mission Control*): asks for orders, has the container collected and
/// brought to its destination. It is active while it waits for an order.
///
/// The pose of a container has the heading, of its two, towards the destination. A container that cannot be collected
/// is tried again; after `attempts` the order is given back. Once a container is on the lift, the vehicle tries to
/// bring it until it is there. `ask` asks for the next order: with `false` if the last one is given back.
#[node]
#[derive(Debug, Clone)]
pub struct MissionControl {
    /// Number of attempts to collect a container.
    #[param(default = 3, range = 1..=1000)]
    attempts: u32,
    order: Option<Order>,
    failures: u32,
    is_loaded: bool,
}

#[node]
impl MissionControl {
    /// Begins to work.
    #[slot]
    fn begin(&mut self, ask: Event<bool>) {
        ask.emit(true);
    }

    /// Takes an order, which counts only while the node is active.
    #[slot]
    fn order(&mut self, order: &Order, ctx: &Ctx, get_container: Event<Pose2>) {
        if ctx.active() {
            (self.order, self.failures, self.is_loaded) = (Some(*order), 0, false);
            get_container.emit(order.towards_destination());
        }
    }

    /// The container is on the lift.
    #[slot]
    fn loaded(&mut self, bring: Event<Pose2>) {
        self.is_loaded = true;
        if let Some(order) = &self.order {
            bring.emit(order.destination);
        }
    }

    /// The container is at its destination.
    #[slot]
    fn delivered(&mut self, ask: Event<bool>) {
        (self.order, self.is_loaded) = (None, false);
        ask.emit(true);
    }

    /// The container is no longer on the lift: nothing can be brought.
    #[slot]
    fn dropped(&mut self, ask: Event<bool>) {
        (self.order, self.is_loaded) = (None, false);
        ask.emit(false);
    }

    /// The container could not be collected, or not be brought.
    #[slot]
    fn failed(&mut self, get_container: Event<Pose2>, bring: Event<Pose2>, ask: Event<bool>) {
        self.failures += 1;
        match self.order {
            Some(order) if self.is_loaded => bring.emit(order.destination),
            Some(order) if self.failures < self.attempts => get_container.emit(order.towards_destination()),
            _ => {
                self.order = None;
                ask.emit(false);
            }
        }
    }
}

/// Pose of a container that is at least `distance` m ahead; ⊥ if it is nearer. Beneath a container, its two ends are
/// easily mistaken for each other.
#[node]
pub fn ahead(
    container: &Container,
    #[param(unit = "m", default = 1.1, range = 0.0..=100.0)] distance: f32,
) -> Option<Pose2> {
    (container.pose.x >= distance).then_some(container.pose)
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time, event};

    const ORDER: Order = Order { container: Pose2::new(1.0, 2.0, 0.0), destination: Pose2::new(9.0, 2.0, 0.0) };

    fn ordered() -> MissionControl {
        let mut node = MissionControl::construct((2,));
        let (ctx, mut get) = (Ctx::new(Time::ZERO), None);
        node.order(&ORDER, &ctx, event(&mut get));
        assert_eq!(get, None, "without activity");
        node.order(&ORDER, &ctx.of_node(true), event(&mut get));
        assert_eq!(get, Some(ORDER.container));
        node
    }

    /// Consequence of a failure: collect, bring, refuse.
    fn fail(node: &mut MissionControl) -> [bool; 3] {
        let (mut get, mut bring, mut ask) = (None, None, None);
        node.failed(event(&mut get), event(&mut bring), event(&mut ask));
        [get.is_some(), bring.is_some(), ask == Some(false)]
    }

    #[test]
    fn a_container_is_driven_beneath_towards_the_destination() {
        let behind = Order { destination: Pose2::new(-3.0, 8.0, 0.0), ..ORDER };
        assert_eq!([ORDER, behind].map(|order| order.towards_destination().theta), [0.0, core::f32::consts::PI]);
        assert_eq!(behind.towards_destination().position(), ORDER.container.position());
    }

    #[test]
    fn a_container_that_is_not_there_is_given_up() {
        let mut node = ordered();
        assert_eq!([fail(&mut node), fail(&mut node)], [[true, false, false], [false, false, true]]);
    }

    #[test]
    fn a_loaded_container_is_brought() {
        let (mut node, mut bring, mut ask) = (ordered(), None, None);
        node.loaded(event(&mut bring));
        assert_eq!(bring, Some(ORDER.destination));
        assert_eq!([fail(&mut node), fail(&mut node), fail(&mut node)], [[false, true, false]; 3]);
        node.delivered(event(&mut ask));
        assert_eq!((ask, fail(&mut node)), (Some(true), [false, false, true]));
    }

    #[test]
    fn a_load_that_is_gone_is_not_brought() {
        let (mut node, mut bring, mut ask) = (ordered(), None, None);
        node.loaded(event(&mut bring));
        node.dropped(event(&mut ask));
        assert_eq!((ask, fail(&mut node)), (Some(false), [false, false, true]));
    }

    #[test]
    fn near_containers_are_left_out() {
        let at = |x: f32| Container { pose: Pose2::new(x, 0.0, 0.0), ..crate::CONTAINER_AHEAD };
        assert_eq!((ahead(&at(2.0), 1.0), ahead(&at(0.5), 1.0)), (Some(Pose2::new(2.0, 0.0, 0.0)), None));
    }
}
