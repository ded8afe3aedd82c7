//! Other costs of a tick, compiled and by hand: instructions, allocations, variation of its time. Also the size of a
//! program.

use crate::instructions::{self, Side};
use apex_bench::{CASES, Case, Run, allocations};
use std::{
    env, fs,
    path::Path,
    process::{Command, Stdio},
    time::Instant,
};

/// Values of the compiled and the hand-written program.
pub type Both<T> = [T; 2];

/// Costs of a tick of a graph.
pub struct Cost {
    /// Name of the graph.
    pub graph: &'static str,
    /// Instructions per tick, or `None` without valgrind.
    pub instructions: Option<Both<f64>>,
    /// Allocations per tick, after all storage has been allocated.
    pub allocations: Both<f64>,
    /// Ratio of the slowest of a thousand runs to the median; a run takes about a microsecond.
    pub unevenness: Both<f64>,
}

/// Size of a program with one graph.
pub struct Size {
    /// Size of the executable without symbols, in bytes.
    pub file: u64,
    /// Peak memory in kB (Linux).
    pub memory: Option<u64>,
}

/// All costs.
pub struct Costs {
    /// Costs for each graph.
    pub ticks: Vec<Cost>,
    /// Sizes for `chain100`.
    pub sizes: Both<Size>,
}

/// Costs of ticks of `graphs`.
pub fn all(graphs: impl Iterator<Item = &'static str>) -> Result<Costs, String> {
    let counts = instructions::can_count();
    let cases = graphs.filter_map(|name| CASES.iter().find(|case| case.name == name));
    let ticks = cases.map(|case| cost(case, counts)).collect::<Result<_, _>>()?;
    Ok(Costs { ticks, sizes: [size("chain100_apex")?, size("chain100_hand")?] })
}

fn cost(case: &Case, counts: bool) -> Result<Cost, String> {
    let count = |side| instructions::per_tick(case.name, side);
    Ok(Cost {
        graph: case.name,
        instructions: if counts { Some([count(Side::Apex)?, count(Side::Hand)?]) } else { None },
        allocations: [case.apex, case.hand].map(allocations_per_tick),
        unevenness: [case.apex, case.hand].map(unevenness),
    })
}

fn allocations_per_tick(run: Run) -> f64 {
    const TICKS: u64 = 100;
    (allocations(run, 2 * TICKS) as f64 - allocations(run, TICKS) as f64) / TICKS as f64
}

/// Variation of the time of a tick. A tick may take less time than reading the clock, so several ticks are timed at
/// once. Their number is small, so that less than one in a thousand measurements contains an interrupt.
fn unevenness(run: Run) -> f64 {
    const RUNS: usize = 100_000;
    let mut ticks = 1;
    while nanoseconds(run, ticks) < 1000 {
        ticks *= 2;
    }
    let mut times: Vec<u128> = (0..RUNS).map(|_| nanoseconds(run, ticks)).collect();
    times.sort_unstable();
    times[RUNS - 1 - RUNS / 1000] as f64 / times[RUNS / 2] as f64
}

fn nanoseconds(run: Run, ticks: u64) -> u128 {
    let start = Instant::now();
    std::hint::black_box(run(std::hint::black_box(ticks)));
    start.elapsed().as_nanos()
}

/// Builds an example without symbols and runs it.
fn size(example: &str) -> Result<Size, String> {
    let own = env::current_exe().map_err(|e| e.to_string())?;
    let target = own.ancestors().nth(2).ok_or("this program is in no folder of a build")?;
    let built = Command::new(env!("CARGO"))
        .args(["rustc", "--quiet", "--release", "--example", example, "--manifest-path"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"))
        .arg("--target-dir")
        .arg(target)
        .args(["--", "-C", "strip=symbols"])
        .status();
    if !built.is_ok_and(|status| status.success()) {
        return Err(format!("cannot build the example `{example}`"));
    }
    let program = target.join("release/examples").join(example);
    let failed = |e| format!("cannot measure `{}`: {e}", program.display());
    let file = fs::metadata(&program).map_err(failed)?.len();
    let output = Command::new(&program).stderr(Stdio::inherit()).output().map_err(failed)?;
    Ok(Size { file, memory: String::from_utf8_lossy(&output.stdout).trim().parse().ok() })
}
