//! Draws the plan of an office floor: `draw_building FILE.dxf [SEED]`. The project's own plan has seed 1.

use apex_sim::OfficePlan;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let (file, seed) = (arguments.next(), arguments.next().map_or(Ok(1), |word| word.parse()));
    let (Some(file), Ok(seed)) = (file, seed) else {
        eprintln!("usage: draw_building FILE.dxf [SEED]");
        std::process::exit(2);
    };
    if let Err(e) = std::fs::write(&file, OfficePlan::new(seed).dxf()) {
        eprintln!("error: {file}: {e}");
        std::process::exit(2);
    }
}
