use super::MAX_JOBS;
use apex_rt::{Ctx, Event, node};
use heapless::Vec;

/// Keeps jobs of three priorities until it is active, and passes them on one by one: the most important one first, of
/// equal ones the oldest. Activity comes in at `next` and leaves with the job; without a job it stays until one comes.
///
/// A full inbox gives up its last job for a more important one, and refuses all others. The job that is lost triggers
/// `lost`. For jobs of one priority, use [`Inbox`](super::Inbox).
#[node]
#[derive(Debug, Clone)]
pub struct PriorityInbox<T> {
    /// Number of jobs that are kept.
    #[param(default = 16, range = 1..=64)]
    capacity: usize,
    /// Jobs with their priorities, in the order in which they will be passed on.
    kept: Vec<(Priority, T), MAX_JOBS>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Priority {
    Low,
    Normal,
    High,
}

#[node]
impl<T: Clone> PriorityInbox<T> {
    /// Takes a job that comes before all others.
    #[slot]
    fn high(&mut self, value: &T, ctx: &Ctx, job: Event<T>, #[failure] lost: Event<T>) {
        self.put(value, Priority::High, ctx, job, lost);
    }

    /// Takes a job.
    #[slot]
    fn normal(&mut self, value: &T, ctx: &Ctx, job: Event<T>, #[failure] lost: Event<T>) {
        self.put(value, Priority::Normal, ctx, job, lost);
    }

    /// Takes a job that comes after all others.
    #[slot]
    fn low(&mut self, value: &T, ctx: &Ctx, job: Event<T>, #[failure] lost: Event<T>) {
        self.put(value, Priority::Low, ctx, job, lost);
    }

    /// Passes the first job on, if there is one and the node is active.
    #[slot]
    fn next(&mut self, ctx: &Ctx, job: Event<T>) {
        if let Some(first) = self.first(ctx) {
            job.emit(first);
        }
    }

    /// Forgets all jobs.
    #[slot]
    fn clear(&mut self) {
        self.kept.clear();
    }
}

impl<T: Clone> PriorityInbox<T> {
    /// Keeps a job. An active node passes the first one on.
    fn put(&mut self, value: &T, priority: Priority, ctx: &Ctx, job: Event<T>, lost: Event<T>) {
        if !ctx.active() {
            if let Some(displaced) = self.keep(priority, value.clone()) {
                lost.emit(displaced);
            }
        } else if self.kept.first().is_none_or(|(first, _)| *first < priority) {
            job.emit(value.clone());
        } else if let Some(first) = self.first(ctx) {
            // There is room: that of the first one.
            let _ = self.keep(priority, value.clone());
            job.emit(first);
        }
    }

    /// Inserts a job by its priority. Returns the job that is lost, if the inbox is full.
    fn keep(&mut self, priority: Priority, job: T) -> Option<T> {
        let is_full = self.kept.len() >= self.capacity.clamp(1, MAX_JOBS);
        if is_full && self.kept.last().is_none_or(|(last, _)| *last >= priority) {
            return Some(job);
        }
        let displaced = if is_full { self.kept.pop() } else { None };
        let place = self.kept.partition_point(|(kept, _)| *kept >= priority);
        match self.kept.insert(place, (priority, job)) {
            Ok(()) => displaced.map(|(_, job)| job),
            Err((_, job)) => Some(job),
        }
    }

    /// Takes the first job out if the node is active.
    fn first(&mut self, ctx: &Ctx) -> Option<T> {
        (ctx.active() && !self.kept.is_empty()).then(|| self.kept.remove(0).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};

    struct Test(PriorityInbox<u32>);

    impl Test {
        fn ctx(active: bool) -> Ctx {
            Ctx::new(Time::ZERO).of_node(active)
        }

        /// The job and the lost one.
        fn put(&mut self, priority: Priority, value: u32, active: bool) -> (Option<u32>, Option<u32>) {
            let (mut job, mut lost) = (None, None);
            let (inbox, ctx) = (&mut self.0, Self::ctx(active));
            let slot = match priority {
                Priority::Low => PriorityInbox::low,
                Priority::Normal => PriorityInbox::normal,
                Priority::High => PriorityInbox::high,
            };
            slot(inbox, &value, &ctx, apex_rt::event(&mut job), apex_rt::event(&mut lost));
            (job, lost)
        }

        fn next(&mut self, active: bool) -> Option<u32> {
            let mut job = None;
            self.0.next(&Self::ctx(active), apex_rt::event(&mut job));
            job
        }
    }

    use Priority::{High, Low, Normal};

    #[test]
    fn the_most_important_job_is_first_and_equal_ones_keep_their_order() {
        let mut inbox = Test(PriorityInbox::construct((16,)));
        assert_eq!(inbox.put(Low, 1, true), (Some(1), None), "the activity was there");
        for (priority, job) in [(Low, 2), (Normal, 3), (High, 4), (Normal, 5), (High, 6), (Low, 7)] {
            assert_eq!(inbox.put(priority, job, false), (None, None));
        }
        assert_eq!(inbox.next(false), None, "a sign without activity");
        assert_eq!([inbox.next(true), inbox.next(true)], [Some(4), Some(6)]);
        // The activity came back by another way than `next`.
        assert_eq!(inbox.put(High, 8, true), (Some(8), None));
        assert_eq!(inbox.put(Normal, 9, true), (Some(3), None));
        let rest: [Option<u32>; 5] = core::array::from_fn(|_| inbox.next(true));
        assert_eq!(rest, [Some(5), Some(9), Some(2), Some(7), None]);
    }

    #[test]
    fn what_is_least_important_is_lost() {
        let mut inbox = Test(PriorityInbox::construct((2,)));
        inbox.put(Normal, 1, false);
        inbox.put(Low, 2, false);
        assert_eq!(inbox.put(Low, 3, false), (None, Some(3)), "the older one has the place");
        assert_eq!(inbox.put(Normal, 4, false), (None, Some(2)));
        assert_eq!(inbox.put(High, 5, false), (None, Some(4)));
        assert_eq!([inbox.next(true), inbox.next(true), inbox.next(true)], [Some(5), Some(1), None]);
        inbox.put(High, 6, false);
        inbox.0.clear();
        assert_eq!(inbox.next(true), None);
    }

    #[test]
    fn a_full_inbox_has_room_for_the_place_of_the_job_that_leaves() {
        let mut inbox = Test(PriorityInbox::construct((MAX_JOBS,)));
        (0..MAX_JOBS as u32).for_each(|job| assert_eq!(inbox.put(Normal, job, false), (None, None)));
        assert_eq!(inbox.put(Normal, 99, true), (Some(0), None));
        assert_eq!(inbox.put(Normal, 100, false), (None, Some(100)));
    }
}
