//! patsy
