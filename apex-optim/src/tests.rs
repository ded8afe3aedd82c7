use crate::{Axis, CmaSearch, DeSearch, Scale, Search, Selection, Space};
use core::fmt::Debug;
use serde::{Serialize, de::DeserializeOwned};

/// Space of two real numbers, one of them on a logarithmic scale, and an integer.
fn space() -> Space {
    let axis = |low, high, scale, integer| Axis::new(low, high, scale, integer).expect("a range");
    Space::new(vec![
        axis(-5.0, 5.0, Scale::Linear, false),
        axis(1e-3, 1e3, Scale::Logarithmic, false),
        axis(0.0, 40.0, Scale::Linear, true),
    ])
}

/// Function with its minimum 0 at (1, 10, 17), which fails for x below −4.
fn fitness(values: &[f64]) -> f64 {
    let (x, y, n) = (values[0] - 1.0, (values[1] / 10.0).ln(), (values[2] - 17.0) / 4.0);
    if values[0] < -4.0 { f64::NAN } else { x * x + (y - x) * (y - x) + n * n }
}

fn advance(search: &mut impl Search, generations: usize) {
    for _ in 0..generations {
        let fitness: Vec<f64> = search.ask().iter().map(|c| fitness(c)).collect();
        search.tell(&fitness);
    }
}

fn finds_the_minimum(mut search: impl Search, generations: usize) {
    advance(&mut search, generations);
    let best = search.best().expect("a candidate that has not failed");
    assert!(best.fitness < 1e-10 && best.values[2] == 17.0, "{best:?}");
}

#[test]
fn minima_are_found_with_any_kind_of_axis() {
    for seed in 0..5 {
        finds_the_minimum(DeSearch::new(space(), seed), 300);
        finds_the_minimum(CmaSearch::new(space(), seed), 600);
        finds_the_minimum(CmaSearch::from_better_half(space(), seed, &[-3.0, 500.0, 1.0]), 600);
    }
}

/// Saves and restores a search at several times, also between restarts.
fn continues<S: Search + Serialize + DeserializeOwned + PartialEq + Debug>(mut search: S) {
    for _ in 0..20 {
        let bytes = postcard::to_allocvec(&search).expect("a search can be saved");
        let mut restored: S = postcard::from_bytes(&bytes).expect("and restored");
        advance(&mut restored, 50);
        advance(&mut search, 50);
        assert_eq!(search, restored);
    }
}

#[test]
fn a_saved_search_continues_exactly() {
    continues(DeSearch::new(space(), 3));
    continues(CmaSearch::new(space(), 3));
}

/// Compares a search with one that is not told fitness that does not matter.
fn races<S: Search + PartialEq + Debug>(mut search: S, mut raced: S) {
    let mut hidden = 0;
    for _ in 0..300 {
        let exact: Vec<f64> = search.ask().iter().map(|c| fitness(c)).collect();
        let mut sorted = exact.clone();
        sorted.sort_by(f64::total_cmp);
        let limit = |i: usize| match raced.selection() {
            Selection::AtMost(limits) => limits[i],
            Selection::Best(count) => sorted[count - 1],
            Selection::All => f64::INFINITY,
        };
        let told: Vec<f64> =
            exact.iter().enumerate().map(|(i, &f)| if f <= limit(i) { f } else { f64::INFINITY }).collect();
        hidden += told.iter().filter(|f| f.is_infinite()).count();
        search.tell(&exact);
        raced.tell(&told);
        assert_eq!(search, raced);
    }
    assert!(hidden > 500, "{hidden}");
}

#[test]
fn fitness_outside_of_the_selection_does_not_matter() {
    races(DeSearch::new(space(), 8), DeSearch::new(space(), 8));
    let start = [0.0, 1.0, 20.0];
    let half = || CmaSearch::from_better_half(space(), 8, &start);
    races(half(), half());
    assert_eq!(half().ask()[0], start, "the start is the first candidate");
    assert_eq!(DeSearch::starting_at(space(), 8, &start).ask()[0], start);
}

#[test]
fn failures_end_no_search() {
    let mut searches: [Box<dyn Search>; 2] =
        [Box::new(DeSearch::new(space(), 1)), Box::new(CmaSearch::new(space(), 1))];
    for search in &mut searches {
        for fitness in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            (0..40).for_each(|_| search.tell(&[fitness; 5]));
            assert_eq!(search.best(), None);
        }
        search.tell(&[]);
        (0..40).for_each(|_| search.tell(&[2.0; 100]));
        assert_eq!(search.best().map(|best| best.fitness), Some(2.0));
        let inside = |c: &Vec<f64>| c.iter().zip(space().axes()).all(|(v, a)| (a.low()..=a.high()).contains(v));
        assert!(search.ask().iter().all(inside));
    }
}
