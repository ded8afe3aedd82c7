//! A program of nothing but `chain100`, compiled: how large is it?

fn main() {
    apex_bench::print_memory(apex_bench::graphs::chain100);
}
