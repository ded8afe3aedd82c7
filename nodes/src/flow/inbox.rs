use apex_rt::{Ctx, Event, node};
use heapless::Deque;

/// Maximum capacity of an [`Inbox`].
pub const MAX_JOBS: usize = 64;

/// Keeps tokens until it is active, and passes them on one by one: jobs that arrive while the last one is under way, or
/// is interrupted. Activity comes in at `next` and leaves with the job; without a job it stays until one comes.
///
/// A token for which there is no room triggers `lost`. To drop all that comes without activity, use
/// [`Await`](super::Await).
#[node]
#[derive(Debug, Clone)]
pub struct Inbox<T> {
    /// Number of tokens that are kept.
    #[param(default = 16, range = 1..=64)]
    capacity: usize,
    kept: Deque<T, MAX_JOBS>,
}

#[node]
impl<T: Clone> Inbox<T> {
    /// Takes a token: an active node passes the oldest one on, another one keeps it.
    #[slot]
    fn put(&mut self, value: &T, ctx: &Ctx, job: Event<T>, #[failure] lost: Event<T>) {
        if ctx.active() && self.kept.is_empty() {
            job.emit(value.clone());
            return;
        }
        let oldest = if ctx.active() { self.kept.pop_front() } else { None };
        let has_room = self.kept.len() < self.capacity.clamp(1, MAX_JOBS);
        if !has_room || self.kept.push_back(value.clone()).is_err() {
            lost.emit(value.clone());
        }
        if let Some(oldest) = oldest {
            job.emit(oldest);
        }
    }

    /// Passes the oldest token on, if there is one and the node is active.
    #[slot]
    fn next(&mut self, ctx: &Ctx, job: Event<T>) {
        if let Some(oldest) = if ctx.active() { self.kept.pop_front() } else { None } {
            job.emit(oldest);
        }
    }

    /// Forgets all tokens.
    #[slot]
    fn clear(&mut self) {
        self.kept.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    struct Test(Inbox<u32>);

    impl Test {
        fn ctx(active: bool) -> Ctx {
            Ctx::new(Time::ZERO).of_node(active)
        }

        /// The job and the lost token.
        fn put(&mut self, value: u32, active: bool) -> (Option<u32>, Option<u32>) {
            let (mut job, mut lost) = (None, None);
            self.0.put(&value, &Self::ctx(active), apex_rt::event(&mut job), apex_rt::event(&mut lost));
            (job, lost)
        }

        fn next(&mut self, active: bool) -> Option<u32> {
            let mut job = None;
            self.0.next(&Self::ctx(active), apex_rt::event(&mut job));
            job
        }
    }

    #[test]
    fn jobs_are_kept_until_the_activity_comes() {
        let mut inbox = Test(Inbox::construct((2,)));
        assert_eq!(inbox.next(true), None);
        assert_eq!(inbox.put(1, true), (Some(1), None), "the activity was there");
        assert_eq!([2, 3, 4].map(|job| inbox.put(job, false)), [(None, None), (None, None), (None, Some(4))]);
        assert_eq!(inbox.next(false), None, "a sign without activity");
        assert_eq!(inbox.next(true), Some(2));
        // The activity came back by another way than `next`: jobs keep their order.
        assert_eq!(inbox.put(5, true), (Some(3), None));
        assert_eq!([inbox.next(true), inbox.next(true)], [Some(5), None]);
    }

    #[test]
    fn a_cleared_inbox_has_no_job() {
        let mut inbox = Test(Inbox::construct((0,)));
        assert_eq!(inbox.put(1, false), (None, None), "there is room for one");
        inbox.0.clear();
        assert_eq!(inbox.next(true), None);
    }
}
