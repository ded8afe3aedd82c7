//! Runs of the robot in the competition, their reports, and measurements of the robot and of its perception.

pub mod bench;
mod knowledge_log;
pub mod measure;
pub mod run;
pub mod run_report;

pub use knowledge_log::KnowledgeLog;
