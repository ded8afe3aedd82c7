//! Connections by name: each port goes to the port with the same name.

use apex_macros::graph;
use apex_rt::Time;

graph!("by_name.afg");

#[test]
fn ports_of_all_kinds_go_through_two_graphs() {
    let mut program = Around::new();
    program.inputs().a.put(6).unwrap();
    program.inputs().b.put(7).unwrap();
    program.inputs().s.put(5).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().product, Some(42));
    assert_eq!(program.events().e.take(), Some(5));
}

#[test]
fn a_port_that_is_named_is_left_out() {
    let mut program = Named::new();
    program.inputs().a.put(6).unwrap();
    program.inputs().b.put(7).unwrap();
    program.react(Time::ZERO);
    assert_eq!(program.outputs().product, Some(360));
    assert_eq!(program.nodes().unused.seen, [7]);
}
