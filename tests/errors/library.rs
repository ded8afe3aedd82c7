//! Nodes of another crate: a source file has to import them.
use apex_rt::prelude::*;

#[node]
pub fn edges(x: &u64) -> u64 {
    *x
}

#[node]
pub fn corners(x: &u64) -> u64 {
    *x
}

mod inside {
    use apex_rt::prelude::*;

    /// Not accessible from outside.
    #[node]
    pub fn faces(x: &u64) -> u64 {
        *x
    }
}

/// Ports with units.
pub mod unit {
    use apex_rt::prelude::*;

    #[derive(Outputs)]
    pub struct Ranges {
        #[unit("m")]
        pub range: f32,
    }

    #[derive(Default)]
    #[node]
    pub struct Ranger {
        #[param(unit = "cm", default = 0.1)]
        gap: f32,
    }

    #[node]
    impl Ranger {
        fn process(&mut self, #[unit("mm")] near: Event<f32>) -> Ranges {
            near.emit(self.gap);
            Ranges { range: 1.0 }
        }
    }

    #[derive(Default)]
    #[node]
    pub struct Turner {
        turned: u64,
    }

    #[node]
    impl Turner {
        fn process(&mut self, #[unit("rad")] by: &f32, #[unit("rad/s")] turned: &mut Out<f32>) {
            self.turned += 1;
            turned.set(*by);
        }
        #[slot]
        fn stop(&mut self, #[unit("m")] distance: &f32) {
            self.turned += *distance as u64;
        }
    }

    #[node]
    #[unit("rad")]
    pub fn level<T: Copy>(#[unit("m")] x: &T) -> T {
        *x
    }

    #[node]
    #[unit("furlong")]
    pub fn strange() -> f32 {
        1.0
    }

    #[node]
    pub fn text(#[unit("m")] x: &String) {
        let _ = x;
    }
}

/// Structs that source files write as values.
pub mod value {
    use apex_rt::prelude::*;

    #[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
    pub struct Place {
        #[unit("m")]
        pub x: f32,
        #[unit("m")]
        pub y: f32,
        pub count: u8,
    }

    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct Secret {
        pub open: u8,
        hidden: u8,
    }

    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct Stamped<T> {
        pub value: T,
        pub place: Place,
    }

    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    pub struct Pair(pub u8, pub u8);

    #[derive(Debug, Clone, Copy, Default)]
    pub struct Unequal {
        pub x: u8,
    }

    #[derive(Debug, Clone, Copy, PartialEq, Default)]
    #[non_exhaustive]
    pub struct Growing {
        pub x: u8,
    }

    #[node]
    pub fn stand(#[param] place: Place) -> Place {
        place
    }
}

/// Ports of a type of a crate that only this one depends on.
pub mod foreign {
    use apex_rt::prelude::*;
    use serde_json::Value;

    #[node]
    pub fn answer() -> Value {
        Value::Null
    }

    #[derive(Default)]
    #[node]
    pub struct Answers;

    #[node]
    impl Answers {
        fn process(&mut self) {}

        #[slot]
        fn put(&mut self, value: &Value) {
            let _ = value;
        }
    }
}
