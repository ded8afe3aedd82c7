//! What a tick costs besides time, compiled and by hand: instructions, allocations, how even its time is. And how large a
//! program is.

use crate::instructions::{self, Side};
use apex_bench::{CASES, Case, Run, allocations};
use std::{
    env, fs,
    path::Path,
    process::{Command, Stdio},
    time::Instant,
};

/// A value of the compiled program, and that of the hand-written one.
pub type Both<T> = [T; 2];

/// What a tick of a graph costs.
pub struct Cost {
    /// The graph.
    pub graph: &'static str,
    /// Instructions per tick; nothing where there is no valgrind.
    pub instructions: Option<Both<f64>>,
    /// Allocations per tick, once all storage has been made.
    pub allocations: Both<f64>,
    /// How long the slowest of a thousand runs of about a microsecond takes, in times of the median.
    pub unevenness: Both<f64>,
}

/// How large a program with one graph is.
pub struct Size {
    /// Bytes of the program without symbols.
    pub file: u64,
    /// Kilobytes of memory that it had at most (Linux).
    pub memory: Option<u64>,
}

/// All that was found.
pub struct Costs {
    /// For each graph.
    pub ticks: Vec<Cost>,
    /// For `chain100`.
    pub sizes: Both<Size>,
}

/// What ticks of `graphs` cost.
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

/// A tick may take less time than reading the clock, so that several are timed at once; only few, so that interrupts of
/// the machine meet fewer than one in a thousand.
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
