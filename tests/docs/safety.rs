use apex_nodes::{nav::Twist, scan::Scan};
use apex_rt::prelude::*;

/// Drives ahead while nothing is near.
#[node]
pub struct Ahead {
    /// Maximum age of a scan.
    #[param(unit = "s", default = 0.3, range = 0.01..=60.0, silence)]
    max_age: f32,
}

#[node]
impl Ahead {
    fn process(&mut self, ctx: &Ctx, scan: Option<&Scan>) -> Twist {
        let age = |scan: &Scan| ctx.now().since(scan.stamp).as_secs_f32();
        let is_young = |scan: &&Scan| scan.stamp <= ctx.now() && age(scan) < self.max_age;
        let Some(scan) = scan.filter(is_young).filter(|scan| scan.measures_anything()) else { return Twist::ZERO };
        let nearest = scan.points().map(|(_, point)| point.norm()).fold(f32::INFINITY, f32::min);
        Twist::new(if nearest > 1.0 { 0.3 } else { 0.0 }, 0.0, 0.0)
    }
}
