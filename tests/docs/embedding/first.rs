use apex_macros::graph;
use apex_rt::prelude::*;

graph! {
    use apex_nodes::math::scale;

    graph Double {
        in  x: f64;
        out y: f64;

        x -> scale(factor = 2) -> y;
    }
}

pub fn main() {
    let mut double = Double::new();
    assert_eq!(double.inputs().x.put(21.0), Ok(()));
    let next = double.react(Time::ZERO);
    assert_eq!(double.outputs().y, Some(42.0));
    assert_eq!(next, Next::Input);
}
