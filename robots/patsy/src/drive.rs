use apex_nodes::scan::Container;
use apex_rt::{Event, node};

/// Wheels of the robot: it turns on the spot to look for a container, and stops in front of it or when the search is
/// given up.
#[node]
#[derive(Debug, Default)]
pub struct Drive {
    is_searching: bool,
}

#[node]
impl Drive {
    /// Begins a search. A search in progress is abandoned.
    #[slot]
    fn go(&mut self) {
        self.is_searching = true;
    }

    /// Stops in front of the container.
    #[slot]
    fn stop(&mut self, _container: &Container, stopped: Event<()>) {
        self.is_searching = false;
        stopped.emit(());
    }

    /// Stops without a container.
    #[slot]
    fn give_up(&mut self, stopped: Event<()>) {
        self.is_searching = false;
        stopped.emit(());
    }

    /// Returns `true` while the robot turns.
    pub fn is_searching(&self) -> bool {
        self.is_searching
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_ends_at_a_container_or_without_one() {
        let mut drive = Drive::default();
        drive.go();
        assert!(drive.is_searching());
        let mut stopped = None;
        drive.stop(&crate::CONTAINER_AHEAD, apex_rt::event(&mut stopped));
        assert!(stopped.is_some() && !drive.is_searching());
        drive.go();
        let mut stopped = None;
        drive.give_up(apex_rt::event(&mut stopped));
        assert!(stopped.is_some() && !drive.is_searching());
    }
}
