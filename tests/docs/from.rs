//! The programs of the pages for those who come from elsewhere.

pub mod copper;
pub mod cs_apex;
