//! Tokens at the inputs of nodes that drive, and what failed sensors make of them.

use apex_nodes::{
    cloud::Hazard,
    map::{Grid, Occupancy},
    nav::{BackPath, BackPiece, Path, Twist},
    persons::Persons,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::Time;
use std::any::Any;

/// A token, or the reason why there is none.
pub type Made = Result<Box<dyn Token>, &'static str>;

/// Token that can be odd.
pub trait Token: Any {
    /// The token with NaN in place of numbers.
    fn nan(&self) -> Made {
        self.filled(f32::NAN)
    }

    /// The token with ∞ in place of numbers.
    fn infinite(&self) -> Made {
        self.filled(f32::INFINITY)
    }

    /// The token with one number in place of those that a sensor measures.
    fn filled(&self, number: f32) -> Made;

    /// The token without content.
    fn empty(&self) -> Made {
        Err("fixed size")
    }

    /// The token 5,000 km from the origin.
    fn far(&self) -> Made {
        Err("not a pose")
    }

    /// The token with another time of measurement; `None` if it has none, so that the stamp of the firing counts.
    fn stamped(&self, stamp: Time) -> Option<Box<dyn Token>> {
        let _ = stamp;
        None
    }

    /// Copy of the token.
    fn copied(&self) -> Box<dyn Token>;

    /// Returns `true` if ∞ is a measurement.
    fn may_be_infinite(&self) -> bool {
        false
    }
}

fn made(token: impl Token) -> Made {
    Ok(Box::new(token))
}

impl Token for Twist {
    fn filled(&self, number: f32) -> Made {
        made(Self { x: number, ..*self })
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(*self)
    }
}

impl Token for Pose2 {
    fn filled(&self, number: f32) -> Made {
        made(Self { x: number, ..*self })
    }

    fn far(&self) -> Made {
        made(Self { y: self.y + 5e6, ..*self })
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(*self)
    }
}

impl Token for Scan {
    fn filled(&self, number: f32) -> Made {
        let mut scan = self.clone();
        scan.ranges.iter_mut().for_each(|range| *range = number);
        made(scan)
    }

    fn empty(&self) -> Made {
        made(Self { stamp: self.stamp, ..Self::default() })
    }

    fn stamped(&self, stamp: Time) -> Option<Box<dyn Token>> {
        Some(Box::new(Self { stamp, ..self.clone() }))
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(self.clone())
    }

    fn may_be_infinite(&self) -> bool {
        true
    }
}

impl Token for Grid<Occupancy> {
    fn filled(&self, _: f32) -> Made {
        Err("cells are not numbers")
    }

    fn empty(&self) -> Made {
        made(Self::default())
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(self.clone())
    }
}

impl Token for Hazard {
    fn filled(&self, number: f32) -> Made {
        made(Self { position: Point2::new(number, 0.0), ..*self })
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(*self)
    }
}

impl Token for Persons {
    fn filled(&self, number: f32) -> Made {
        let mut persons = self.clone();
        persons.iter_mut().for_each(|person| person.position.x = number);
        made(persons)
    }

    fn empty(&self) -> Made {
        made(Self::new())
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(self.clone())
    }
}

impl Token for Path {
    fn filled(&self, number: f32) -> Made {
        made(Self { points: vec![Point2::new(number, 0.0); 2], ..*self })
    }

    fn empty(&self) -> Made {
        made(Self::default())
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(self.clone())
    }
}

impl Token for BackPath {
    fn filled(&self, number: f32) -> Made {
        made(Self { pieces: vec![BackPiece { bend: number, length: number }] })
    }

    fn empty(&self) -> Made {
        made(Self::default())
    }

    fn copied(&self) -> Box<dyn Token> {
        Box::new(self.clone())
    }
}
