use apex_rt::prelude::*;
graph! {
    graph Chain {
        node s = Ramp();
        node k = Sink();
        s -> mul(k = 4) -> mul(k = 7) -> k;
    }
}
graph! {
    graph Diamond {
        node s = Ramp();
        node drop = even_only();
        node a2 = mul(k = 1);
        node b = mul(k = 1);
        node j = product();
        node k = Sink();
        s -> drop -> a2 -> j.a;
        s -> b -> j.b;
        j -> k;
    }
}
#[test]
fn chain() {
    let mut c = Chain::new();
    for _ in 0..3 {
        c.react(Time::ZERO);
    }
    assert_eq!(c.nodes().k.seen, [0, 28, 56]);
    let mut c = Diamond::new();
    for _ in 0..6 {
        c.react(Time::ZERO);
    }
    assert_eq!(c.nodes().k.seen, [0, 4, 16]);
}
