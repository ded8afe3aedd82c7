//! Pictures of a particle filter.

use apex_nodes::{localize::Filter, map::VectorMap, scan::Pose2};
use apex_sim::World;
use std::fmt::Write as _;

/// Pixels per metre, and the height of the caption in pixels.
const SCALE: f32 = 13.0;
const CAPTION: f32 = 26.0;
/// Maximum number of drawn particles.
const MOST: usize = 700;

/// Drawings of several moments, one below the other.
pub struct Picture {
    low: (f32, f32),
    size: (f32, f32),
    panels: Vec<String>,
}

impl Picture {
    pub fn new(map: &VectorMap) -> Self {
        let (low, high) = map.bounds().unwrap_or_default();
        Self { low: (low.x - 0.5, low.y - 0.5), size: (high.x - low.x + 1.0, high.y - low.y + 1.0), panels: vec![] }
    }

    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        ((x - self.low.0) * SCALE, (self.size.1 - (y - self.low.1)) * SCALE)
    }

    /// Adds a moment: plan black, furniture brown, particles blue, the robot red.
    pub fn add(&mut self, caption: &str, plan: &VectorMap, world: &World, filter: &Filter, robot: &Pose2) {
        let mut text = String::new();
        let known = plan.segments().len();
        let mut path = |walls: &[apex_sim::Wall], colour: &str| {
            let lines: String = walls
                .iter()
                .map(|wall| {
                    let ((ax, ay), (bx, by)) = (self.at(wall.a.x, wall.a.y), self.at(wall.b.x, wall.b.y));
                    format!("M{ax:.0} {ay:.0}L{bx:.0} {by:.0}")
                })
                .collect();
            let _ = writeln!(text, "<path d=\"{lines}\" fill=\"none\" stroke=\"{colour}\"/>");
        };
        path(&world.walls()[known..], "#c49a6c");
        path(&world.walls()[..known], "#222");
        let discs: String = world.discs().iter().map(|disc| self.dot(disc.centre.x, disc.centre.y)).collect();
        let _ = writeln!(text, "<path d=\"{discs}\" stroke=\"#c49a6c\" stroke-width=\"2\" stroke-linecap=\"round\"/>");
        let every = filter.particles().len().div_ceil(MOST).max(1);
        let dots: String = filter.particles().step_by(every).map(|p| self.dot(p.x, p.y)).collect();
        let _ = writeln!(text, "<path d=\"{dots}\" stroke=\"#2878b5\" stroke-width=\"3\" stroke-linecap=\"round\"/>");
        let (x, y) = self.at(robot.x, robot.y);
        let (dx, dy) = (14.0 * robot.theta.cos(), -14.0 * robot.theta.sin());
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"none\" stroke=\"#d43d2a\" stroke-width=\"2\"/>\
             <path d=\"M{x:.1} {y:.1}l{dx:.1} {dy:.1}\" stroke=\"#d43d2a\" stroke-width=\"2\"/>\
             <text x=\"8\" y=\"{:.0}\" font-size=\"15\" fill=\"#333\">{caption}, {} particles</text>",
            self.size.1 * SCALE + 15.0,
            filter.particles().len(),
        );
        self.panels.push(text);
    }

    fn dot(&self, x: f32, y: f32) -> String {
        let (x, y) = self.at(x, y);
        format!("M{x:.0} {y:.0}h0")
    }

    /// All moments as SVG.
    pub fn svg(&self) -> String {
        let (width, height) = (self.size.0 * SCALE, self.size.1 * SCALE + CAPTION);
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {:.0}\" font-family=\"sans-serif\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            height * self.panels.len() as f32
        );
        for (i, panel) in self.panels.iter().enumerate() {
            let _ = writeln!(text, "<g transform=\"translate(0 {:.0})\">\n{panel}</g>", i as f32 * height);
        }
        text + "</svg>\n"
    }
}
