use crate::world::{Field, Kind, Object};
use apex_nodes::{
    map::{Sign, Signs},
    scan::Point2,
};

/// Number of sightings from which on the robot takes an object for real.
const SURE: u32 = 4;
/// Distance from an object up to which one that the robot knows is that object, in m.
const NEAR: f32 = 0.6;

/// Object that the robot knows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Find {
    /// Kind.
    pub kind: Kind,
    /// Place in the world, if the map lay exactly at the station.
    pub place: Point2,
    /// Standard deviation of a sighting, in m.
    pub deviation: f32,
    /// Distance from the true object, in m; `None` if there is none.
    pub error: Option<f32>,
}

/// Objects that the robot knows, and those that it does not.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Finds {
    /// Objects that it knows.
    pub all: Vec<Find>,
    /// Number of true objects.
    pub objects: usize,
    /// Number of true objects that it knows.
    pub found: usize,
}

impl Finds {
    /// Number of finds where there is not an object, or one that is known already.
    pub fn wrong(&self) -> usize {
        self.all.len() - self.found
    }

    /// Greatest error of an object, in m.
    pub fn greatest_error(&self) -> Option<f32> {
        self.all.iter().filter_map(|find| find.error).reduce(f32::max)
    }
}

/// Compares what the robot knows with the truth.
pub fn finds(field: &Field, known: &[Signs]) -> Finds {
    let each = Kind::ALL.into_iter().zip(known);
    let sure = each.flat_map(|(kind, signs)| signs.iter().filter(|sign| sign.count >= SURE).map(move |s| (kind, s)));
    let all: Vec<Find> = sure.map(|(kind, sign)| find(field, kind, sign)).collect();
    let is_known = |object: &&Object| all.iter().any(|find| find.kind == object.kind && is_near(find.place, object));
    Finds { objects: field.objects.len(), found: field.objects.iter().filter(is_known).count(), all }
}

fn find(field: &Field, kind: Kind, sign: &Sign) -> Find {
    let place = field.station.to_outer(sign.mean);
    let same = field.objects.iter().filter(|object| object.kind == kind && is_near(place, object));
    let error = same.map(|object| (object.place - place).norm()).reduce(f32::min);
    let [x, y, _] = sign.covariance();
    Find { kind, place, deviation: (x + y).sqrt(), error }
}

fn is_near(place: Point2, object: &Object) -> bool {
    (object.place - place).norm() <= NEAR
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_sim::Random;

    fn sign(field: &Field, place: Point2, count: usize) -> Sign {
        let pose = field.station.transform().to_inner(place);
        let pose = apex_nodes::scan::Pose2::new(pose.x, pose.y, 0.0);
        let mut sign = Sign::new(1, &pose);
        (1..count).for_each(|_| sign.add(&pose));
        sign
    }

    #[test]
    fn an_object_that_is_known_twice_or_not_there_is_wrong() {
        let field = Field::new(&mut Random::new(3));
        let cup = field.objects[0].place;
        let offset = |x: f32, count: usize| sign(&field, cup + Point2::new(x, 0.0), count);
        let known = [offset(0.1, 9), offset(-0.5, 9), offset(0.9, 9), offset(5.0, 2)];
        let found = finds(&field, &[known.into_iter().collect(), Signs::new()]);
        assert_eq!((found.objects, found.found, found.all.len(), found.wrong()), (4, 1, 3, 2));
        assert!((found.greatest_error().expect("a find") - 0.5).abs() < 1e-3);
    }
}
