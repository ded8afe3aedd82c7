use super::{MAX_PERSONS, Person, Persons};
use crate::scan::Point2;
use apex_rt::{Ctx, Out, Time, node};
use heapless::Vec;

/// Distance up to which persons who stand are the same, in m.
const SAME: f32 = 0.5;
/// Time for which the place of a person who is no longer seen is remembered, in s.
const MEMORY: f32 = 60.0;

/// Selects the persons who will have gone on when the robot gets to them: those who walk, and those who have stood for
/// less than `patience`.
///
/// A person who has stood for longer is an obstacle like others, as is what was only taken for a person. `persons` are
/// in a fixed frame such as that of odometry.
#[node]
#[derive(Debug, Clone)]
pub struct Passersby {
    /// Velocity from which on a person walks.
    #[param(unit = "m/s", default = 0.3, range = 0.0..=10.0)]
    walking: f32,
    /// Time after which a person who stands is not expected to go on.
    #[param(unit = "s", default = 15.0, range = 0.0..=86400.0)]
    patience: f32,
    standing: Vec<Standing, MAX_PERSONS>,
}

/// Place where a person stands.
#[derive(Debug, Clone, Copy)]
struct Standing {
    place: Point2,
    since: Time,
    seen: Time,
}

#[node]
impl Passersby {
    fn process(&mut self, ctx: &Ctx, persons: &Persons, passing: &mut Out<Persons>) {
        let (now, passing) = (ctx.now(), passing.get_mut());
        // Nothing was seen in the future: the clock was set back.
        self.standing.retain(|one| one.seen <= now && now.since(one.seen).as_secs_f32() <= MEMORY);
        passing.clear();
        for person in persons {
            if self.is_passing(person, now) {
                // Cannot fail: there are not more than at the input.
                let _ = passing.push(*person);
            }
        }
    }

    fn is_passing(&mut self, person: &Person, now: Time) -> bool {
        if person.velocity.norm() >= self.walking {
            return true;
        }
        let place = person.position;
        let since = match self.standing.iter_mut().find(|one| (one.place - place).norm() <= SAME) {
            Some(one) => {
                one.seen = now;
                one.since
            }
            None => {
                // If it is full, the person has never stood for long.
                let _ = self.standing.push(Standing { place, since: now, seen: now });
                now
            }
        };
        now.since(since).as_secs_f32() < self.patience
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    #[test]
    fn who_has_stood_for_long_does_not_pass() {
        let mut node = Passersby::construct((0.3, 20.0));
        let mut passing = |second: i64, persons: &[(f32, f32)]| {
            let person = |&(x, velocity): &(f32, f32)| Person {
                position: Point2::new(x, 0.0),
                velocity: Point2::new(0.0, velocity),
                ..Person::default()
            };
            let (persons, mut out): (Persons, _) = (persons.iter().map(person).collect(), Out::new());
            node.process(&Ctx::new(Time::from_secs(second)), &persons, &mut out);
            out.get().expect("persons").iter().map(|person| person.position.x).collect::<std::vec::Vec<_>>()
        };
        assert_eq!(passing(0, &[(1.0, 0.0), (3.0, 1.0)]), [1.0, 3.0]);
        assert_eq!(passing(19, &[(1.1, 0.1), (5.0, 0.0)]), [1.1, 5.0]);
        // The first one has taken a little step, and the robot has not seen it for a while.
        assert_eq!(passing(30, &[(1.2, 0.1), (5.0, 0.0), (1.0, 0.8)]), [5.0, 1.0]);
        assert_eq!(passing(39, &[(5.0, 0.0)]), [] as [f32; 0]);
        // It is not remembered for ever.
        assert_eq!(passing(120, &[(1.0, 0.0)]), [1.0]);
    }
}
