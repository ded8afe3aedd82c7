use apex_macros::graph;
use apex_rt::{
    params::{load, save},
    prelude::*,
};

graph! {
    use apex_nodes::math::LowPass;

    graph Smooth {
        in  x: f64;
        out y: f64;

        node filter = LowPass(weight = 0.5);
        x      -> filter.x;
        filter -> y;
    }
}

pub fn main() {
    let mut smooth = Smooth::new();
    assert_eq!(smooth.param::<f64>("filter.weight").unwrap(), 0.5);
    assert!(smooth.set_param("filter.weight", 0.25).is_ok());

    let error = smooth.set_param("filter.weight", 2.0).unwrap_err();
    assert_eq!(error.to_string(), "the value of `filter.weight` is out of range: its range is 0..=1");
    let error = smooth.set_param("filter.wight", 0.1).unwrap_err();
    assert_eq!(error.to_string(), "there is no parameter of this name; did you mean `filter.weight`?");

    // As files: `load_file`, `save_file`. If anything in the text is wrong, nothing is changed.
    let kept = save(&mut smooth);
    assert_eq!(kept, "[filter]\nweight = 0.25 # 0..=1\n");
    assert!(load(&mut smooth, "[filter]\nweight = 3.0\n").is_err());
    assert!(load(&mut smooth, &kept).is_ok());
    assert_eq!(smooth.param::<f64>("filter.weight").unwrap(), 0.25);
}
