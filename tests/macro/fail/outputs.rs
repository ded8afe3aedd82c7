//! `#[derive(Outputs)]` is for structs with named fields.
use apex_rt::prelude::*;

#[derive(Outputs)]
struct Tuple(u64, u64);

#[derive(Outputs)]
struct Unit;

#[derive(Outputs)]
enum Either {
    A,
    B,
}

fn main() {}
