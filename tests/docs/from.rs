//! The programs of the pages for users of other frameworks.

pub mod copper;
pub mod cs_apex;
