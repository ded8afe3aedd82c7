//! Behaviour of graphs: source files are compiled into this program and run, and their firings and records are
//! compared. Tests whose names begin with a case (`df_01`) check that case of the conformance list.

mod accept;
mod active;
mod activity;
mod borders;
mod by_name;
mod cancel;
mod claims;
mod dataflow;
mod each;
mod events;
mod failures;
mod figures;
mod forms;
mod handed;
mod hygiene;
mod inputs;
mod large;
mod late;
mod lifecycle;
mod machines;
mod missing;
mod names;
mod nesting;
mod parameters;
mod params;
mod profile;
mod random;
mod rates;
mod reported;
mod scale;
mod scripts;
mod structs;
mod timing;
mod variants;
mod waits;
