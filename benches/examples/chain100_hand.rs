//! A program that contains only `chain100`, written by hand, to measure its size.

fn main() {
    apex_bench::print_memory(apex_bench::hand::chain100);
}
