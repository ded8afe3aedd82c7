//! Connections by name: each port goes to the port with the same name.

use apex_macros::graph;
use apex_rt::Time;

graph!("by_name.afg");

graph! {
    use apex_tests::nodes::{add, product};

    pub graph Product {
        in  a: i64;
        in  b: i64;
        out result: i64;
        node of = product();
        in.* -> of.*;
        of -> result;
    }

    graph Sum = Product {
        node of = add();
    }

    graph Both {
        in  a: i64;
        in  b: i64;
        out result: i64;
        node product = Product();
        in.* -> product.* -> out.*;
    }

    test sums: Sum {
        feed a = 6;
        feed b = 7;
        expect result == 12 +- 1;
    }
}

/// A program that has taken a factor at `a` and one at `b`.
macro_rules! fed {
    ($program:expr) => {{
        let mut program = $program;
        program.inputs().a.put(6).unwrap();
        program.inputs().b.put(7).unwrap();
        program
    }};
}

#[test]
fn ports_of_all_kinds_go_through_two_graphs() {
    let mut program = fed!(Around::new());
    program.inputs().s.put(5).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().product, Some(42));
    assert_eq!(program.events().e.take(), Some(5));
}

#[test]
fn in_a_macro_as_in_a_file() {
    let mut program = fed!(Both::new());
    program.react(Time::ZERO);
    assert_eq!(program.outputs().result, Some(42));
    let mut program = fed!(Product::new());
    program.react(Time::ZERO);
    assert_eq!(program.outputs().result, Some(42));
}

#[test]
fn a_port_that_is_named_is_left_out() {
    let mut program = fed!(Named::new());
    program.react(Time::ZERO);
    assert_eq!(program.outputs().product, Some(360));
    assert_eq!(program.nodes().unused.seen, [7]);
}
