//! copper-rs: tasks and a graph in RON, compiled by a macro. Every task is timed twice per tick. Nothing is logged.

use crate::Ran;
use std::cell::Cell;

thread_local! {
    /// Final value of the sink of the last application, whose state is not accessible.
    static CHECKSUM: Cell<u64> = const { Cell::new(0) };
}

/// Tasks of the graphs.
pub mod tasks {
    use super::CHECKSUM;
    use apex_bench::nodes::{self, Count, OneOf, add, op, total};
    use cu29::prelude::*;

    macro_rules! stateless {
        () => {
            type Resources<'r> = ();
            fn new(_: Option<&ComponentConfig>, _: ()) -> CuResult<Self> {
                Ok(Self::default())
            }
        };
    }

    /// 0, 1, 2, …
    #[derive(Default, Reflect)]
    #[reflect(from_reflect = false)]
    pub struct Source {
        #[reflect(ignore)]
        count: Count,
    }

    impl Freezable for Source {}

    impl CuSrcTask for Source {
        stateless!();
        type Output<'m> = output_msg!(u64);
        fn process(&mut self, _: &CuContext, output: &mut Self::Output<'_>) -> CuResult<()> {
            output.set_payload(self.count.process());
            Ok(())
        }
    }

    /// `op` with a compile-time constant.
    #[derive(Default, Reflect)]
    pub struct Op<const K: u64>;

    impl<const K: u64> Freezable for Op<K> {}

    impl<const K: u64> CuTask for Op<K> {
        stateless!();
        type Input<'m> = input_msg!(u64);
        type Output<'m> = output_msg!(u64);
        fn process(&mut self, _: &CuContext, input: &Self::Input<'_>, output: &mut Self::Output<'_>) -> CuResult<()> {
            match input.payload() {
                Some(x) => output.set_payload(op(x, K)),
                None => output.clear_payload(),
            }
            Ok(())
        }
    }

    /// Passes every `PERIOD`-th message.
    #[derive(Reflect)]
    #[reflect(from_reflect = false)]
    pub struct Filter<const PERIOD: u64> {
        #[reflect(ignore)]
        filter: OneOf,
    }

    impl<const PERIOD: u64> Default for Filter<PERIOD> {
        fn default() -> Self {
            Self { filter: OneOf::new(PERIOD) }
        }
    }

    impl<const PERIOD: u64> Freezable for Filter<PERIOD> {}

    impl<const PERIOD: u64> CuTask for Filter<PERIOD> {
        stateless!();
        type Input<'m> = input_msg!(u64);
        type Output<'m> = output_msg!(u64);
        fn process(&mut self, _: &CuContext, input: &Self::Input<'_>, output: &mut Self::Output<'_>) -> CuResult<()> {
            match input.payload().and_then(|x| self.filter.process(x)) {
                Some(x) => output.set_payload(x),
                None => output.clear_payload(),
            }
            Ok(())
        }
    }

    /// Sum of two values.
    #[derive(Default, Reflect)]
    pub struct Join;

    impl Freezable for Join {}

    impl CuTask for Join {
        stateless!();
        type Input<'m> = input_msg!('m, u64, u64);
        type Output<'m> = output_msg!(u64);
        fn process(&mut self, _: &CuContext, input: &Self::Input<'_>, output: &mut Self::Output<'_>) -> CuResult<()> {
            match (input.0.payload(), input.1.payload()) {
                (Some(a), Some(b)) => output.set_payload(add(a, b)),
                _ => output.clear_payload(),
            }
            Ok(())
        }
    }

    /// Sum of eight values, which are all present in every tick.
    #[derive(Default, Reflect)]
    pub struct Sum8;

    impl Freezable for Sum8 {}

    impl CuTask for Sum8 {
        stateless!();
        type Input<'m> = input_msg!('m, u64, u64, u64, u64, u64, u64, u64, u64);
        type Output<'m> = output_msg!(u64);
        fn process(&mut self, _: &CuContext, input: &Self::Input<'_>, output: &mut Self::Output<'_>) -> CuResult<()> {
            let (a, b, c, d, e, f, g, h) = input;
            let all = [a, b, c, d, e, f, g, h].map(|message| message.payload());
            match all {
                [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f), Some(g), Some(h)] => {
                    output.set_payload(total([a, b, c, d, e, f, g, h]));
                }
                _ => output.clear_payload(),
            }
            Ok(())
        }
    }

    /// Folds all values into a checksum.
    #[derive(Default, Reflect)]
    #[reflect(from_reflect = false)]
    pub struct Last {
        #[reflect(ignore)]
        sink: nodes::Sink,
    }

    impl Freezable for Last {}

    impl CuSinkTask for Last {
        stateless!();
        type Input<'m> = input_msg!(u64);
        fn process(&mut self, _: &CuContext, input: &Self::Input<'_>) -> CuResult<()> {
            if let Some(x) = input.payload() {
                self.sink.process(x);
            }
            Ok(())
        }
        fn stop(&mut self, _: &CuContext) -> CuResult<()> {
            CHECKSUM.set(self.sink.checksum());
            Ok(())
        }
    }
}

macro_rules! copper {
    ($name:ident, $config:literal) => {
        /// An application.
        mod $name {
            use super::tasks;
            use cu29::prelude::*;

            #[copper_runtime(config = $config)]
            struct App {}

            pub fn run(ticks: u64) -> CuResult<crate::Ran> {
                let mut app = App::builder().build()?.start()?;
                let time = crate::timed(|| {
                    for _ in 0..ticks {
                        app.run_one_iteration().expect("no task fails");
                    }
                });
                app.stop()?;
                Ok(crate::Ran { time, checksum: super::CHECKSUM.get() })
            }
        }

        #[doc = concat!("Ticks of `", stringify!($name), "`.")]
        pub fn $name(ticks: u64) -> Ran {
            $name::run(ticks).expect("no task fails")
        }
    };
}

include!(concat!(env!("OUT_DIR"), "/copper.rs"));
