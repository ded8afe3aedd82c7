//! Ages of tokens (docs/safety.md). The age of a token is that of its stamp, not of its arrival, and what comes from
//! the future is not young.

use crate::scan::{Pose2, Scan};
use apex_rt::{Ctx, Time};

/// Token of a sensor, which counts for a while.
pub(super) trait Measured: Clone {
    /// Time of the measurement; `None` if the token does not have it. Then the stamp of the firing counts.
    fn stamp(&self) -> Option<Time> {
        None
    }

    /// Returns `false` for what a failed sensor sends.
    fn is_usable(&self) -> bool;
}

impl Measured for Scan {
    fn stamp(&self) -> Option<Time> {
        Some(self.stamp)
    }

    fn is_usable(&self) -> bool {
        self.measures_anything()
    }
}

impl Measured for Pose2 {
    fn is_usable(&self) -> bool {
        self.is_usable()
    }
}

/// Returns `true` if something that was measured at `stamp` is younger than `max_age` s.
pub(super) fn is_young(ctx: &Ctx, stamp: Time, max_age: f32) -> bool {
    stamp <= ctx.now() && ctx.now().since(stamp).as_secs_f32() < max_age
}

/// Returns the token of this firing if a node may act on it: it is usable and neither older than `max_age` s nor from
/// that far in the future.
pub(super) fn fresh<'a, T: Measured>(ctx: &Ctx, token: Option<&'a T>, max_age: f32) -> Option<&'a T> {
    token.filter(|token| {
        let stamp = token.stamp().unwrap_or_else(|| ctx.stamp());
        let lead = stamp.since(ctx.now()).as_secs_f32();
        token.is_usable() && lead < max_age && is_young(ctx, stamp.min(ctx.now()), max_age)
    })
}

/// Returns both poses, if both are [`fresh`]: those of the axes of a tractor and its trailer.
pub(super) fn both_fresh<'a>(
    ctx: &Ctx,
    [base, trailer]: [Option<&'a Pose2>; 2],
    max_age: f32,
) -> Option<(&'a Pose2, &'a Pose2)> {
    fresh(ctx, base, max_age).zip(fresh(ctx, trailer, max_age))
}

/// Returns `true` if one of these poses is too far from the origin to compute with.
pub(super) fn any_far<const N: usize>(poses: [Option<&Pose2>; N]) -> bool {
    poses.into_iter().flatten().any(Pose2::is_far)
}

/// Newest token of an input that is ⊥ from time to time.
#[derive(Debug, Clone)]
pub(super) struct Latest<T>(Option<Kept<T>>);

/// Copy of a token.
#[derive(Debug, Clone)]
struct Kept<T> {
    stamp: Time,
    /// Time from which on the age counts: that of the stamp or, if that was in the future, of the arrival.
    since: Time,
    token: T,
}

impl<T> Default for Latest<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T: Measured> Latest<T> {
    /// Keeps the token of this firing, if it is [`fresh`]. One that came out of order does not replace a newer one.
    pub fn update(&mut self, ctx: &Ctx, token: Option<&T>, max_age: f32) {
        // The clock was set back.
        if self.0.as_ref().is_some_and(|kept| kept.since > ctx.now()) {
            self.0 = None;
        }
        if let Some(token) = fresh(ctx, token, max_age) {
            self.keep(ctx, token);
        }
    }

    /// Returns the newest token if it is younger than `max_age` s.
    pub fn young(&self, ctx: &Ctx, max_age: f32) -> Option<&T> {
        self.0.as_ref().filter(|kept| is_young(ctx, kept.since, max_age)).map(|kept| &kept.token)
    }

    /// Keeps a copy. The memory of the last one is used again.
    fn keep(&mut self, ctx: &Ctx, token: &T) {
        let stamp = token.stamp().unwrap_or_else(|| ctx.stamp());
        let since = stamp.min(ctx.now());
        match &mut self.0 {
            Some(kept) if stamp < kept.stamp => {}
            Some(kept) => {
                // A token that is repeated does not become younger.
                if stamp > kept.stamp {
                    (kept.stamp, kept.since) = (stamp, since);
                }
                kept.token.clone_from(token);
            }
            none => *none = Some(Kept { stamp, since, token: token.clone() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Age of a scan in ms that counts at each of these times in ms, when scans with these stamps come, or ⊥.
    fn ages<const N: usize>(firings: [(i64, Option<i64>); N]) -> [Option<i64>; N] {
        let mut latest = Latest::default();
        firings.map(|(now, stamp)| {
            let scan = stamp.map(|ms| {
                let mut scan = Scan { stamp: Time::from_millis(ms), ..Scan::default() };
                scan.ranges.push(1.0).expect("room");
                scan
            });
            let ctx = Ctx::new(Time::from_millis(now));
            latest.update(&ctx, scan.as_ref(), 0.5);
            latest.young(&ctx, 0.5).map(|scan| now - scan.stamp.as_nanos() / 1_000_000)
        })
    }

    #[test]
    fn a_token_counts_until_its_stamp_is_too_old() {
        assert_eq!(ages([(0, None), (100, Some(0)), (499, None), (500, None)]), [None, Some(100), Some(499), None]);
        assert_eq!(ages([(600, Some(100)), (600, Some(101)), (601, None)]), [None, Some(499), None]);
    }

    #[test]
    fn what_is_repeated_or_out_of_order_does_not_become_younger() {
        assert_eq!(ages([(0, Some(0)), (400, Some(0)), (500, Some(0))]), [Some(0), Some(400), None]);
        assert_eq!(ages([(100, Some(100)), (200, Some(50)), (599, Some(150))]), [Some(0), Some(100), Some(449)]);
    }

    #[test]
    fn the_future_is_not_young() {
        assert_eq!(
            ages([(0, Some(500)), (0, Some(400)), (499, None), (500, None)]),
            [None, Some(-400), Some(99), None]
        );
        // A driver whose clock is ahead repeats its scan.
        assert_eq!(ages([(0, Some(300)), (200, Some(300)), (500, Some(300))]), [Some(-300), Some(-100), None]);
        assert_eq!(ages([(100_000, Some(100_000)), (1000, None), (1100, Some(1100))]), [Some(0), None, Some(0)]);
    }
}
