//! The cart on a Cortex-M3, the LM3S6965, with RTIC 2: one task owns the graph, and sleeps until its next timer or
//! interrupt.
#![no_std]
#![no_main]

mod machine;

use rtic_monotonics::systick::prelude::*;

systick_monotonic!(Clock, 1000);

/// Frequency of the core clock, in Hz.
const CORE: u32 = 12_500_000;

#[rtic::app(device = lm3s6965, dispatchers = [SSI0])]
mod app {
    use super::{CORE, Clock, machine};
    use apex_rt::prelude::*;
    use cortex_m_semihosting::debug;
    use firmware::{Cart, tell};
    use lm3s6965::Interrupt;
    use rtic_monotonics::systick::prelude::*;
    use rtic_sync::{
        channel::{Receiver, Sender},
        make_channel,
    };

    /// Signal of an interrupt to the task that owns the graph.
    #[derive(Clone, Copy)]
    pub enum Signal {
        /// The button was pressed.
        Button,
        /// The bumper hit something.
        Bumper,
    }

    /// Capacity of the queue of interrupts.
    const WAITING: usize = 4;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        cart: Cart,
        signals: Receiver<'static, Signal, WAITING>,
        button: Sender<'static, Signal, WAITING>,
        bumper: Sender<'static, Signal, WAITING>,
    }

    #[init]
    fn init(cx: init::Context) -> (Shared, Local) {
        Clock::start(cx.core.SYST, CORE);
        let (button, signals) = make_channel!(Signal, WAITING);
        let bumper = button.clone();
        let spawned = control::spawn().and_then(|()| world::spawn());
        assert!(spawned.is_ok(), "they are spawned once");
        (Shared {}, Local { cart: Cart::new(), signals, button, bumper })
    }

    /// Runs the graph when one of its timers is due, and immediately on an interrupt.
    #[task(local = [cart, signals], priority = 1)]
    async fn control(cx: control::Context) {
        let control::LocalResources { cart, signals, .. } = cx.local;
        loop {
            let now = Time::from_millis(Clock::now().ticks().into());
            let next = cart.react(now);
            tell(cart, now, machine::write);
            let Next::At(time) = next else { machine::exit(debug::EXIT_FAILURE) };
            let due = (time.as_nanos() / 1_000_000) as u32;
            // A full mailbox returns the token. Nothing is lost, as the token in it has the same meaning.
            match Clock::timeout_at(Instant::from_ticks(due), signals.recv()).await {
                Ok(Ok(Signal::Button)) => drop(cart.inputs().button.put(())),
                Ok(Ok(Signal::Bumper)) => drop(cart.inputs().bumper.put(())),
                Ok(Err(_)) | Err(_) => {}
            }
        }
    }

    /// Interrupt of the button. If the queue is full, it already contains the same signal.
    #[task(binds = GPIOA, local = [button], priority = 2)]
    fn button(cx: button::Context) {
        let _ = cx.local.button.try_send(Signal::Button);
    }

    /// Interrupt of the bumper.
    #[task(binds = GPIOB, local = [bumper], priority = 2)]
    fn bumper(cx: bumper::Context) {
        let _ = cx.local.bumper.try_send(Signal::Bumper);
    }

    /// Simulates a person and a wall for eight seconds.
    #[task(priority = 1)]
    async fn world(_: world::Context) {
        use Interrupt::{GPIOA, GPIOB};
        for (time, interrupt) in [(255, GPIOB), (505, GPIOA), (1005, GPIOA), (2005, GPIOB), (3005, GPIOA)] {
            Clock::delay_until(Instant::from_ticks(time)).await;
            rtic::pend(interrupt);
        }
        Clock::delay_until(Instant::from_ticks(8005)).await;
        machine::exit(debug::EXIT_SUCCESS);
    }

    type Instant = <Clock as Monotonic>::Instant;
}
