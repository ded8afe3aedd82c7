//! Parameters that other threads read and set while the program runs, on one thread and on several.

use apex_macros::graph;
use apex_rt::{
    Mailbox, PortReceiver, PortSender, Ports, Program, RemoteParams, Time, drive_from, drive_with,
    params::{ParamError, Rejection},
    prelude::*,
};
use std::{sync::mpsc, thread, time::Duration};

/// Multiplies tokens.
#[node]
#[derive(Default)]
pub struct Times {
    #[param(range = 0..=9)]
    factor: i64,
}

#[node]
impl Times {
    #[slot]
    fn put(&mut self, number: &i64, product: Event<i64>) {
        product.emit(self.factor * number);
    }
}

/// A parameter of a type that no value fits.
#[node]
pub struct Opaque {
    #[param]
    text: &'static str,
}

#[node]
impl Opaque {
    fn process(&mut self, number: &i64) -> i64 {
        *number + self.text.len() as i64
    }
}

/// Sends its parameter.
#[node]
#[derive(Default)]
pub struct Level {
    #[param]
    level: i64,
}

#[node]
impl Level {
    fn process(&mut self) -> i64 {
        self.level
    }
}

graph! {
    use crate::remote::{Level, Opaque, Times};

    graph Alone {
        slot  number: i64;
        slot  end;
        event product: i64;
        node near = Times(factor = 2);
        node far  = Times(factor = 3);
        number       -> near.put;
        near.product -> far.put;
        far.product  -> product;
        end          -> exit;
    }

    graph Apart {
        slot  number: i64;
        slot  end;
        event product: i64;
        node near = Times(factor = 2);
        node far  = Times(factor = 3) on other;
        number       -> near.put;
        near.product -> far.put;
        far.product  -> product;
        end          -> exit;
    }

    graph Sampled {
        out sum: i64;
        node level = Level(level = 1) every 10ms;
        node long  = Opaque(text = "four");
        level -> long -> sum;
    }
}

/// Acts as another thread that uses a program that multiplies.
fn tune(numbers: &PortSender<i64>, products: &PortReceiver<i64>, params: &RemoteParams) {
    let product = |number| {
        numbers.send(number).expect("the program waits");
        products.receive().expect("a product")
    };
    assert_eq!(product(1), 6);
    // Nothing happens meanwhile: the groups sleep.
    assert_eq!(params.set("far.factor", 5i64), Ok(()));
    assert_eq!((product(1), params.get("far.factor"), params.get("near.factor")), (10, Ok(5i64), Ok(2i64)));
    assert_eq!(params.set_text("near.factor", "7"), Ok(()));
    assert_eq!((product(1), params.get_text("near.factor")), (35, Ok("7".to_owned())));
    let error = params.set("far.factor", 10i64).expect_err("out of range");
    assert!(matches!(error, ParamError::Refused { refusal: Rejection::Range, .. }), "{error}");
    let error = params.set("far.facto", 1i64).expect_err("no such parameter");
    assert_eq!(error.to_string(), "there is no parameter of this name; did you mean `far.factor`?");
    assert!(params.get::<bool>("far.factor").is_err(), "it is a number");
    assert_eq!((product(1), params.all().len()), (35, 2));
}

/// Runs `program` with a thread that tunes it.
fn tuned<P: Program<Inputs: 'static, Events: 'static>>(
    program: P,
    number: fn(&mut P::Inputs) -> &mut Mailbox<i64>,
    end: fn(&mut P::Inputs) -> &mut Mailbox<()>,
    product: fn(&mut P::Events) -> &mut Mailbox<i64>,
) {
    let mut ports = Ports::<P>::new();
    let (numbers, end, products, params) =
        (ports.input(number), ports.input(end), ports.event(product), ports.params());
    let tunes = thread::spawn(move || {
        tune(&numbers, &products, &params);
        assert_eq!(end.put(()), Ok(()));
        params
    });
    assert_eq!(drive_from(program, WallClock::new(), ports), 0);
    let params = tunes.join().expect("it does not panic");
    assert_eq!(params.set("near.factor", 1i64), Err(ParamError::Ended));
}

#[test]
fn other_threads_set_parameters_of_a_program() {
    tuned(Alone::new(), |inputs| &mut inputs.number, |inputs| &mut inputs.end, |events| &mut events.product);
}

#[test]
fn other_threads_set_parameters_of_each_group() {
    for _ in 0..20 {
        tuned(Apart::new(), |inputs| &mut inputs.number, |inputs| &mut inputs.end, |events| &mut events.product);
    }
}

#[test]
fn what_no_value_fits_is_refused() {
    let ports = Ports::<Sampled>::new();
    let params = ports.params();
    let asks = thread::spawn(move || {
        let error = params.get_text("long.text").expect_err("a text that lives forever");
        assert!(matches!(error, ParamError::Refused { refusal: Rejection::Opaque, .. }), "{error}");
    });
    // It ends when the question is answered: the clock stands until then.
    drive_from(Sampled::new(), WhileRunning(asks), ports);
}

/// Simulated time that ends with a thread.
struct WhileRunning(thread::JoinHandle<()>);

impl Clock for WhileRunning {
    fn now(&mut self) -> Time {
        Time::ZERO
    }
    fn wait_until(&mut self, _time: Time) -> bool {
        thread::yield_now();
        !self.0.is_finished()
    }
}

#[test]
fn a_request_to_a_program_that_never_runs_fails() {
    let ports = Ports::<Alone>::new();
    let params = ports.params();
    let asks = thread::spawn(move || params.get::<i64>("near.factor"));
    drop(ports);
    assert_eq!(asks.join().expect("it does not panic"), Err(ParamError::Ended));
}

/// Raises the level before each reaction, up to 5, and notes when the next one is due.
#[derive(Default)]
struct Raise {
    reactions: i64,
    next: Vec<Next>,
}

impl Observer for Raise {
    fn before_reaction(&mut self, now: Time, params: &mut impl Parameters) {
        assert_eq!(now, Time::from_millis(10 * self.reactions));
        self.reactions += 1;
        let _ = params.set_param("level.level", self.reactions.min(5));
    }
    fn after_reaction(&mut self, next: Next) {
        self.next.push(next);
    }
}

#[test]
fn an_observer_acts_between_reactions() {
    let (mut program, mut raise) = (Sampled::new(), Raise::default());
    drive_with(&mut program, SimClock::until(Time::from_millis(25)), &mut raise);
    assert_eq!(program.outputs().sum, Some(3 + 4));
    assert_eq!(raise.next, [10, 20, 30].map(|ms| Next::At(Time::from_millis(ms))));
}

/// Sends 3000 numbers through a program whose products are taken on its own thread, but for those that a function
/// leaves to another one. Returns the products in the order in which they were taken, and how many were left.
fn products<P: Program + Send + 'static>(
    program: P,
    number: fn(&mut P::Inputs) -> &mut Mailbox<i64>,
    product: fn(&mut P::Events) -> &mut Mailbox<i64>,
) -> (Vec<i64>, usize) {
    let mut ports = Ports::<P>::new();
    let (numbers, products) = (ports.input(number), ports.event(product));
    let (sender, taken) = mpsc::channel();
    let at_once = sender.clone();
    products.at_once(move |product| {
        // Some are left, as many a time as one would by chance.
        if product % 7 < 2 { Some(product) } else { at_once.send((product, true)).err().map(|_| product) }
    });
    let later = thread::spawn(move || {
        while let Some(product) = products.receive() {
            // Those that come meanwhile have to wait.
            thread::sleep(Duration::from_micros(50));
            sender.send((product, false)).expect("the test waits");
        }
    });
    let feed = thread::spawn(move || (0..3000).for_each(|i| numbers.send(i).expect("it runs")));
    assert_eq!(drive_from(program, WallClock::new(), ports), 0);
    feed.join().expect("no panic");
    later.join().expect("no panic");
    let taken: Vec<(i64, bool)> = taken.iter().collect();
    let left = taken.iter().filter(|(_, at_once)| !at_once).count();
    (taken.into_iter().map(|(product, _)| product).collect(), left)
}

#[test]
fn tokens_that_are_taken_at_once_and_later_keep_their_order() {
    let expected: Vec<i64> = (0..3000).map(|i| 6 * i).collect();
    for (products, left) in [
        products(Alone::new(), |inputs| &mut inputs.number, |events| &mut events.product),
        products(Apart::new(), |inputs| &mut inputs.number, |events| &mut events.product),
    ] {
        assert_eq!(products, expected);
        assert!((800..=3000).contains(&left), "{left} were left");
    }
}
