//! A program that contains only `chain100`, compiled, to measure its size.

fn main() {
    apex_bench::print_memory(apex_bench::graphs::chain100);
}
