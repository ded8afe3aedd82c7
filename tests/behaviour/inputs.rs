//! Nodes with any number of inputs.

use apex_macros::graph;
use apex_rt::prelude::*;
use apex_tests::react;

graph!("inputs.afg");

#[test]
fn inputs_have_the_order_of_the_text() {
    let mut program = Ordered::new();
    let inputs = program.inputs();
    for (port, value) in [(&mut inputs.a, 10), (&mut inputs.b, 200), (&mut inputs.c, 3000), (&mut inputs.offset, 7)] {
        port.put(value).unwrap();
    }
    program.react(Time::ZERO);
    assert_eq!(program.outputs().weighed, Some(3000 + 7 + 3000 + 2 * 200 + 3 * 10));
    assert_eq!((program.outputs().first, program.outputs().all), (Some(200), Some(220)));
}

#[test]
fn optional_inputs_are_none_without_a_token() {
    let mut program = Rates::new();
    let log = react(&mut program, 2);
    // Sums of two firings: 2000 + offsets + first inputs + twice the second ones.
    assert_eq!(program.nodes().k.seen, [Some(4000 + 1 + 1 + 2), Some(4000 + 5 + 5 + 6)]);
    assert_eq!((log.count("w"), program.nodes().c.incomplete), (4, 2));
}

#[test]
fn a_node_is_told_if_one_of_the_inputs_is_missing() {
    let mut program = Counted::new();
    react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [Some(5), None, Some(8), None]);
    assert_eq!(program.nodes().c.incomplete, 2);
}

#[test]
fn through_ports_of_nested_graphs() {
    let mut program = Outer::new();
    program.inputs().x.put(1).unwrap();
    program.inputs().v.put(10).unwrap();
    program.inputs().e.put(100).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().y, Some(2000 + 1 + 10 + 200));
}

#[test]
fn by_name_one_of_them_is_connected() {
    let mut program = Named::new();
    program.inputs().offset.put(1).unwrap();
    program.inputs().values.put(10).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().y, Some(1011));
}

#[test]
fn in_the_body_of_an_each() {
    let mut program = Repeated::new();
    program.inputs().list.put(vec![1, 2, 3]).unwrap();
    program.inputs().x.put(10).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().sums, Some(vec![11, 12, 13]));
}
