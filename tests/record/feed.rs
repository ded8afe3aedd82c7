//! A test that takes its tokens from a recording: twelve milliseconds of `Small` in `cut.rs`.

use apex_macros::graph;

graph! {
    use apex_tests::nodes::Mean;

    graph Averaged {
        in value: f64;
        out mean: f64;
        node m = Mean();
        value -> m -> mean;
    }

    test tokens_of_a_recorded_run: Averaged {
        feed value = recording("small.mcap", "a.out");
        never mean > 1;
        expect mean > 0;
        wait 10ms;
        expect mean > 0 within 1ms;
        wait 1ms;
        never mean > 0;
        wait 1s;
    }

    graph Belt {
        in  value: f64 in belt;
        out same: f64;
        value -> same;
    }

    test a_recorded_run_of_apex_has_no_frames: Belt {
        feed value = recording("small.mcap", "a.out");
        expect same within 0s;
    }
}
