//! Approach to a container from many poses, in simulation (thesis 6.10.2, figure 6.25).

mod drive;
mod picture;

pub use drive::{Approach, Controller, End, drive, starts};
pub use picture::picture;

use apex_sim::in_order;
use std::{fmt::Write as _, io, num::NonZero};

/// Approaches from all start poses, with each of the seeds and both controllers, on `threads` threads.
///
/// # Errors
/// If a thread cannot be started.
pub fn approaches(seeds: &[u64], threads: Option<NonZero<usize>>) -> io::Result<Vec<Approach>> {
    let work: Vec<_> = Controller::ALL
        .iter()
        .flat_map(|controller| seeds.iter().map(move |seed| (*controller, *seed)))
        .flat_map(|(controller, seed)| starts().map(move |start| (controller, seed, start)))
        .collect();
    in_order(&work, threads, |(controller, seed, start)| drive(*controller, *seed, *start), |_| {})
}

/// Table of the ends of approaches, by controller.
pub fn table(approaches: &[Approach]) -> String {
    let mut text = format!(
        "{:<12}{:>10}{:>10}{:>8}{:>9}{:>11}{:>14}{:>18}\n",
        "controller", "approaches", "beneath", "missed", "contact", "too late", "mean time (s)", "mean offset (cm)"
    );
    for controller in Controller::ALL {
        let of = || approaches.iter().filter(move |a| a.controller == controller);
        let count = |end: End| of().filter(|a| a.end == end).count();
        let (all, beneath) = (of().count(), count(End::Beneath));
        let mean = |value: fn(&Approach) -> f32| {
            let there = of().filter(|a| a.end == End::Beneath);
            there.map(|a| f64::from(value(a))).sum::<f64>() / beneath.max(1) as f64
        };
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<12}{all:>10}{:>10}{:>8}{:>9}{:>11}{:>14.1}{:>18.1}",
            controller.to_string(),
            format!("{:.1} %", 100.0 * beneath as f64 / all.max(1) as f64),
            count(End::Missed),
            count(End::Contact),
            count(End::TooLate),
            mean(|a| a.time),
            100.0 * mean(|a| a.offset)
        );
    }
    text
}
