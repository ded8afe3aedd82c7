//! rustc underlines the exact token.
use apex_rt::prelude::*;

#[node]
fn ramp() -> u64 {
    1
}

#[node]
fn show(x: &u64, #[param(unit = "m", default = 1.0)] gap: f32) {
    let _ = (x, gap);
}

graph! {
    graph Unknown {
        node r = rmap();
        node s = show(gap = 3s);
        r -> s.y;
    }
}

graph! { graph Broken { node r = ramp() node s = show(); } }

fn main() {}
