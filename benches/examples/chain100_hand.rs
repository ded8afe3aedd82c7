//! A program of nothing but `chain100`, by hand: how large is it?

fn main() {
    apex_bench::print_memory(apex_bench::hand::chain100);
}
