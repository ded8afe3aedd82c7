//! Nodes with an output of twists: how each is made, and which inputs it cannot do without.

use super::token::Token;
use apex_nodes::{
    nav::{
        Articulated, BackFollower, BackUp, Clearance, CurveFollower, HazardStop, LookAround, MoveRobot, MoveToObstacle,
        OdometryGuard, Path, PathFollower, PersonCaution, PlannedApproach, PositionToTarget, ReactiveApproach,
        SafetyField, SkidFollower, Steer, SweepStop, TrailerField, Twist,
    },
    scan::{FarFromOrigin, Point2},
};
use apex_rt::{Construct, Ctx, Event, event};
use std::{any::Any, collections::BTreeMap};

/// Tokens of one firing, by the names of the inputs. A missing one is ⊥.
pub type Inputs = BTreeMap<String, Box<dyn Token>>;

/// Answer of a node to one firing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sent {
    pub twist: Option<Twist>,
    pub event: Option<&'static str>,
    pub fails: bool,
}

/// Node that takes the tokens of a firing.
pub type Node = Box<dyn FnMut(&Ctx, &Inputs) -> Sent>;

pub struct Row {
    pub name: &'static str,
    /// Inputs without which the node must not move the robot for longer than `max_age`.
    pub needs: &'static [&'static str],
    /// Time in s without anything after which the node is called with ⊥.
    pub max_age: f32,
    pub make: fn() -> Node,
}

fn get<'a, T: Token>(inputs: &'a Inputs, name: &str) -> Option<&'a T> {
    inputs.get(name).map(|token| {
        let token: &dyn Any = &**token;
        token.downcast_ref().unwrap_or_else(|| panic!("the token at `{name}` has another type"))
    })
}

/// Lets a node fire with its events.
fn fire<const N: usize>(
    names: [&'static str; N],
    process: impl FnOnce([Event<()>; N]) -> Result<Option<Twist>, FarFromOrigin>,
) -> Sent {
    let mut events = [None; N];
    let twist = process(events.each_mut().map(event));
    let event = names.into_iter().zip(events).find_map(|(name, event)| event.map(|()| name));
    Sent { twist: twist.unwrap_or(None), event, fails: twist.is_err() }
}

const PATSY: Articulated = Articulated::PATSY;

pub const ROWS: &[Row] = &[
    Row {
        name: "MoveRobot",
        needs: &["pose"],
        max_age: 0.5,
        make: || {
            let mut node = MoveRobot::construct((5.0, 0.0, 0.5, 0.5, 0.5));
            Box::new(move |ctx, i| fire(["done"], |[done]| node.process(ctx, get(i, "pose"), done)))
        },
    },
    Row {
        name: "MoveToObstacle",
        needs: &["scan"],
        max_age: 0.5,
        make: || {
            let mut node = MoveToObstacle::construct((0.05, 0.3, 0.3, 0.2, 0.5, 0.5));
            Box::new(move |ctx, i| fire(["done"], |[done]| Ok(node.process(ctx, get(i, "scan"), done))))
        },
    },
    Row {
        name: "PositionToTarget",
        needs: &["target"],
        max_age: 0.5,
        make: || {
            let mut node = PositionToTarget::construct((0.5, 0.3, 0.8, 1.0, 0.02, 0.03, 2.0, 0.5));
            Box::new(move |ctx, i| {
                fire(["positioned", "lost"], |[at, lost]| Ok(node.process(ctx, get(i, "target"), at, lost)))
            })
        },
    },
    Row {
        name: "PathFollower",
        needs: &["pose"],
        max_age: 0.5,
        make: || {
            let mut node = PathFollower::construct((
                2.0, 1.0, 0.05, 0.5, 0.2, 0.1, 0.2, 1.5, 1.0, 3.0, 1.5, 2.0, 0.0, 0.0, 1.0, 0.05, 0.05, 1.0, 0.3, 2.0,
                0.5,
            ));
            Box::new(move |ctx, i| {
                fire(["reached", "blocked", "off_path"], |[a, b, c]| {
                    node.process(ctx, get(i, "pose"), get(i, "path"), get(i, "scan"), a, b, c)
                })
            })
        },
    },
    Row {
        name: "CurveFollower",
        needs: &["pose", "trailer"],
        max_age: 0.5,
        make: || {
            let mut node = CurveFollower::construct((
                PATSY,
                0.0,
                0.0,
                0.7,
                0.5,
                0.05,
                0.5,
                0.5,
                1.5,
                3.5,
                0.15,
                2.5,
                0.02,
                Clearance::PATSY,
                0.05,
                1.0,
                2.0,
                2.0,
                0.5,
            ));
            Box::new(move |ctx, i| {
                let [pose, trailer] = ["pose", "trailer"].map(|name| get(i, name));
                let [ahead, behind] = ["ahead", "behind"].map(|name| get(i, name));
                let (ground, odometry) = (get(i, "ground"), get(i, "odometry"));
                fire(["reached", "blocked", "off_path"], |[a, b, c]| {
                    node.process(ctx, pose, trailer, get(i, "path"), ahead, behind, ground, odometry, a, b, c)
                })
            })
        },
    },
    Row {
        name: "SkidFollower",
        needs: &["pose"],
        max_age: 0.5,
        make: || {
            let mut node = SkidFollower::construct((
                0.5, 0.1, 1.5, 1.8, 1.6, 0.8, 2.5, 0.4, 0.25, 0.1, 0.15, 4.0, 0.42, 0.61, 0.3, 0.7, 0.3, 1.2, 0.4, 1.5,
                0.0, 0.5,
            ));
            let mut path = Some(Path { points: [0.0, 3.0, 6.0].map(|x| Point2::new(x, 0.0)).into(), heading: 0.0 });
            Box::new(move |ctx, i| {
                path.take().iter().for_each(|path| node.follow(path, ctx));
                fire(["reached", "blocked", "off_path"], |[a, b, c]| {
                    node.process(ctx, get(i, "pose"), get(i, "scan"), get(i, "map"), a, b, c)
                })
            })
        },
    },
    Row {
        name: "LookAround",
        needs: &["pose"],
        max_age: 0.5,
        make: || {
            let mut node = LookAround::construct((0.8, 0.2, 0.5));
            Box::new(move |ctx, i| fire([], |[]| node.process(ctx, get(i, "pose"))))
        },
    },
    Row {
        name: "BackUp",
        needs: &["base", "trailer"],
        max_age: 0.5,
        make: || {
            let mut node = BackUp::construct((5.0, 0.2, 0.6, PATSY, 0.5));
            Box::new(move |ctx, i| fire(["done"], |[done]| node.process(ctx, get(i, "base"), get(i, "trailer"), done)))
        },
    },
    Row {
        name: "BackFollower",
        needs: &["base", "trailer"],
        max_age: 0.5,
        make: || {
            let mut node = BackFollower::construct((0.2, 2.5, PATSY, 3.0, 0.5));
            Box::new(move |ctx, i| {
                fire(["reached", "blocked"], |[a, b]| {
                    node.process(ctx, get(i, "base"), get(i, "trailer"), get(i, "path"), a, b)
                })
            })
        },
    },
    Row {
        name: "ReactiveApproach",
        needs: &["base", "trailer"],
        max_age: 0.5,
        make: || {
            let mut node =
                ReactiveApproach::construct((0.7, 1.8, 0.6, 0.5, 0.05, 0.5, 0.5, 0.4, 1.0, PATSY, 0.05, 0.5));
            Box::new(move |ctx, i| {
                fire(["reached", "missed"], |[a, b]| {
                    node.process(ctx, get(i, "base"), get(i, "trailer"), get(i, "container"), a, b)
                })
            })
        },
    },
    Row {
        name: "PlannedApproach",
        needs: &["base", "trailer"],
        max_age: 0.5,
        make: || {
            let sizes = (1.2, 0.7, 0.43, 0.05);
            let mut node = PlannedApproach::construct((
                0.8,
                1.0,
                0.5,
                0.03,
                0.2,
                PATSY,
                sizes.0,
                sizes.1,
                sizes.2,
                sizes.3,
                0.05,
                0.05,
                0.05,
                Clearance::PATSY,
                0.5,
            ));
            Box::new(move |ctx, i| {
                fire(["reached", "missed"], |[a, b]| {
                    node.process(ctx, get(i, "base"), get(i, "trailer"), get(i, "container"), None, a, b)
                })
            })
        },
    },
    Row {
        name: "Steer",
        needs: &["twist"],
        max_age: 0.5,
        make: || {
            let mut node = Steer::construct((2.5, 0.7, 0.5));
            Box::new(move |ctx, i| fire([], |[]| Ok(node.process(ctx, get(i, "twist")))))
        },
    },
    Row {
        name: "OdometryGuard",
        needs: &["twist", "odometry"],
        max_age: 0.5,
        make: || {
            let mut node = OdometryGuard::construct((0.4, 1.0, 0.05, 0.1, 0.5));
            Box::new(move |ctx, i| fire([], |[]| Ok(node.process(ctx, get(i, "twist"), get(i, "odometry")))))
        },
    },
    Row {
        name: "SafetyField",
        needs: &["twist", "scan"],
        max_age: 0.5,
        make: || {
            let mut node = SafetyField::construct((0.3, 0.05, 1.0, 0.1, 0.5));
            Box::new(move |ctx, i| fire([], |[]| Ok(node.process(ctx, get(i, "twist"), get(i, "scan")))))
        },
    },
    Row {
        name: "HazardStop",
        needs: &["twist", "map"],
        max_age: 0.6,
        make: || {
            let mut node = HazardStop::construct((0.25, 0.2, 0.6, 0.6));
            Box::new(move |ctx, i| {
                fire([], |[]| Ok(node.process(ctx, get(i, "twist"), get(i, "map"), get(i, "hazard"))))
            })
        },
    },
    Row {
        name: "SweepStop",
        needs: &["twist", "map", "base", "trailer"],
        max_age: 0.6,
        make: || {
            let mut node = SweepStop::construct((PATSY, Clearance::PATSY, 0.6, 1.0, 0.6));
            Box::new(move |ctx, i| {
                fire([], |[]| Ok(node.process(ctx, get(i, "twist"), get(i, "map"), get(i, "base"), get(i, "trailer"))))
            })
        },
    },
    Row {
        name: "TrailerField",
        needs: &["twist", "ahead", "behind", "base", "trailer"],
        max_age: 0.5,
        make: || {
            let mut node = TrailerField::construct((PATSY, 0.0, 0.0, 0.05, 1.0, 0.1, 0.5));
            Box::new(move |ctx, i| {
                let scans = (get(i, "ahead"), get(i, "behind"));
                fire([], |[]| {
                    Ok(node.process(ctx, get(i, "twist"), scans.0, scans.1, get(i, "base"), get(i, "trailer")))
                })
            })
        },
    },
    Row {
        name: "PersonCaution",
        needs: &["twist"],
        max_age: 0.5,
        make: || {
            let mut node = PersonCaution::construct((
                PATSY, 0.0, 0.0, 0.7, 0.15, 0.15, 0.0, 0.0, 0.0, 0.3, 0.3, 0.0, 0.4, 0.05, 0.5,
            ));
            Box::new(move |ctx, i| {
                let axes = (get(i, "pose"), get(i, "trailer"));
                fire([], |[]| Ok(node.process(ctx, get(i, "twist"), axes.0, axes.1, get(i, "persons"))))
            })
        },
    },
];
