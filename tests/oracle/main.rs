//! Compiled programs against the Petri nets of their graphs.

mod nets;
