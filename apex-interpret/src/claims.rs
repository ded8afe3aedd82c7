//! Claims about activity that a program looks at while it runs.

use crate::run::Run;
use apex_dsl::program::{Broken, ClaimCheck, Spot};
use apex_rt::Observer;

impl<O: Observer> Run<'_, '_, O> {
    /// Looks at the claims. A violation is reported once, until the claim holds again.
    pub fn check_claims(&mut self) {
        for ClaimCheck { claim, broken } in &self.code.program.claims {
            let is_broken = match broken {
                Broken::Several(groups) => groups.iter().filter(|group| self.any(group)).count() > 1,
                Broken::Lost(from, nearer) => self.any(from) && !self.any(nearer),
                Broken::NotConserved(all, given) => all.iter().filter(|spot| self.has(**spot)).count() != *given,
                Broken::Never => false,
            };
            match is_broken {
                true if self.state.broken.insert(*claim) => self.observer.claim_failed(*claim),
                true => {}
                false => drop(self.state.broken.remove(claim)),
            }
        }
    }

    fn any(&self, spots: &[Spot]) -> bool {
        spots.iter().any(|spot| self.has(*spot))
    }

    /// Returns `true` if a place has activity.
    pub fn has(&self, spot: Spot) -> bool {
        self.state.has(spot)
    }
}
