//! Runs of the vehicle in the simulated clinic, what came of them, and the cost of faults (thesis 8.2).

mod budget;
mod losses;
mod outages;
mod picture;
mod run;
mod table;
mod timeline;

pub use budget::{Budget, BudgetTable};
pub use losses::Losses;
pub use outages::run_with_outages;
pub use picture::picture;
pub use run::{Run, run};
pub use table::{Row, activity_table, fault_at, faults_table, prices, prices_table, summary, table};
pub use timeline::timeline;
