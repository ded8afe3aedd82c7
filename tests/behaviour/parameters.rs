//! Parameters: values in the source file, values that arrive, values that are rejected.

use apex_macros::graph;
use apex_tests::react;
use std::{f32::consts::PI, time::Duration};

graph!("parameters.afg");

#[test]
fn par_01_a_parameter_is_fed_and_read() {
    let mut program = Fed::new();
    react(&mut program, 3);
    assert_eq!(program.nodes().g.seen, [5, 6, 7]);
    assert_eq!(program.nodes().k.seen, [5, 6, 7]);
    react(&mut program, 1);
    assert_eq!(program.nodes().g.seen, [5, 6, 7, 7], "without a new value the old one stays");
}

#[test]
fn par_02_a_value_out_of_range_is_refused() {
    let mut program = Refused::new();
    let log = react(&mut program, 4);
    assert_eq!(program.nodes().g.seen, [5, 5, 5, 10]);
    assert_eq!(log.refused, [("g", "gain", "11".to_owned())]);
}

#[test]
fn par_02_a_function_does_not_fire_with_a_refused_value() {
    let mut program = RefusedByFunction::new();
    let log = react(&mut program, 4);
    assert_eq!(program.nodes().k.seen, [Some(5), None, None, Some(40)]);
    assert_eq!(log.refused, [("f", "gain", "11".to_owned())]);
}

#[test]
fn a_parameter_is_an_output_too() {
    let mut program = PassedOn::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [(8, 7), (9, 7)]);
}

#[test]
fn values_are_evaluated_and_reach_rust_in_si() {
    let mut program = Values::new();
    react(&mut program, 7);
    let plain = &program.nodes().plain;
    assert_eq!((plain.length, plain.angle, plain.speed), (0.5, 0.0, 1.0));
    assert_eq!((plain.pause, plain.name, plain.on, plain.count), (Duration::from_millis(1500), "none", false, 3));
    let given = &program.nodes().given;
    assert_eq!((given.length, given.angle, given.speed), (1.5, PI, 10.0));
    assert_eq!((given.pause, given.name, given.on, given.count), (Duration::from_secs(2), "given", true, 6));
    assert_eq!(program.nodes().constant.count, 7);
    assert_eq!(program.nodes().shared.speed, 2.0, "a share of a share is brought into its unit once");
    let exact = &program.nodes().exact;
    assert_eq!((exact.length, exact.speed, exact.angle), (0.25, 0.3, PI / 4.0));
    assert_eq!((exact.pause, exact.count), (Duration::from_millis(125), 3500));
    assert_eq!(program.nodes().k.seen, [1, 2, 3, 4, 5, 6]);
}

#[test]
fn arguments_reach_imported_graphs() {
    let mut program = Amplified::new();
    react(&mut program, 2);
    assert_eq!(program.nodes().k.seen, [(4, 100), (8, 200)]);
}
