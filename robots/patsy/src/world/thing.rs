use apex_nodes::scan::{Point2, Pose2};
use apex_sim::{
    Random,
    tof::{Material, Shape, Solid, SolidKind, Space},
};

/// Things that lie or stand on floors, or hang over them (thesis fig. 6.19 and 6.20).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Thing {
    /// Screwdriver of 22 cm.
    Screwdriver,
    /// Hammer of 30 cm.
    Hammer,
    /// Wrench of 20 cm.
    Wrench,
    /// Dark cable of 1 m, about 1 cm thick.
    Cable,
    /// Drinking glass.
    Glass,
    /// Black plastic case.
    DarkPlastic,
    /// Roll of tape.
    Roll,
    /// Piece of wood.
    Wood,
    /// Box of 20 to 40 cm.
    Carton,
    /// Table with four legs.
    Table,
}

/// Height of the plane of the laser scanner, in m: lower things are small (thesis 6.3.4).
const LASER: f32 = 0.06;

impl Thing {
    /// Things below the plane of the laser scanner, and a glass.
    pub const LITTLE: [Self; 8] = [
        Self::Screwdriver,
        Self::Hammer,
        Self::Wrench,
        Self::Cable,
        Self::Glass,
        Self::DarkPlastic,
        Self::Roll,
        Self::Wood,
    ];

    /// Places the thing in a space, with its middle and direction at `pose`. Its sizes and materials vary a little.
    pub fn place(self, pose: &Pose2, random: &mut Random, space: &mut Space) {
        let mut place = Place { pose: *pose, space };
        let mut vary = |value: f32| value * random.uniform(0.85, 1.15);
        match self {
            Self::Screwdriver => {
                place.rod(Point2::new(-0.11, 0.0), Point2::new(-0.01, 0.0), 0.015, vary(0.4));
                place.rod(Point2::new(-0.01, 0.0), Point2::new(0.11, 0.0), 0.004, vary(0.5));
            }
            Self::Hammer => {
                place.rod(Point2::new(-0.15, 0.0), Point2::new(0.13, 0.0), 0.014, vary(0.4));
                place.block(Point2::new(0.14, 0.0), [0.03, 0.11, 0.035], 0.0, vary(0.5));
            }
            Self::Wrench => {
                place.block(Point2::default(), [0.16, 0.022, 0.01], 0.0, vary(0.6));
                place.block(Point2::new(0.08, 0.0), [0.04, 0.045, 0.014], 0.0, vary(0.6));
            }
            Self::Cable => {
                let (radius, albedo) = (vary(0.006), vary(0.1));
                let mut at = Point2::new(-0.5, 0.0);
                for step in 1..=5 {
                    let to = Point2::new(-0.5 + 0.2 * step as f32, random.uniform(-0.12, 0.12));
                    place.rod(at, to, radius, albedo);
                    at = to;
                }
            }
            Self::Glass => place.upright(Point2::default(), [0.0, vary(0.11)], vary(0.035), Material::GLASS),
            Self::DarkPlastic => place.block(Point2::default(), [vary(0.09), 0.06, vary(0.04)], 0.0, vary(0.05)),
            Self::Roll => {
                let material = Material::plain(vary(0.4));
                place.upright(Point2::default(), [0.0, vary(0.04)], vary(0.05), material);
            }
            Self::Wood => place.block(Point2::default(), [vary(0.12), vary(0.06), vary(0.035)], 0.0, vary(0.5)),
            Self::Carton => {
                let size = [vary(0.3), vary(0.35), vary(0.3)];
                place.block(Point2::default(), size, 0.0, vary(0.5));
            }
            Self::Table => {
                let (height, albedo) = (vary(0.7), vary(0.45));
                for (x, y) in [(-0.3, -0.5), (-0.3, 0.5), (0.3, -0.5), (0.3, 0.5)] {
                    place.upright(Point2::new(x, y), [0.0, height], 0.025, Material::plain(albedo));
                }
                place.block(Point2::default(), [0.8, 1.2, 0.04], height, albedo);
            }
        }
    }
}

/// Space in which a thing is placed.
struct Place<'a> {
    pose: Pose2,
    space: &'a mut Space,
}

impl Place<'_> {
    /// Rod that lies on the floor.
    fn rod(&mut self, from: Point2, to: Point2, radius: f32, albedo: f32) {
        let [from, to] = [from, to].map(|end| self.pose.to_outer(end)).map(|end| [end.x, end.y, radius]);
        self.add(Shape::Rod { from, to, radius }, 0.0, Material::plain(albedo));
    }

    /// Rod that stands between two heights.
    fn upright(&mut self, at: Point2, [bottom, top]: [f32; 2], radius: f32, material: Material) {
        let at = self.pose.to_outer(at);
        let shape = Shape::Rod { from: [at.x, at.y, bottom], to: [at.x, at.y, top], radius };
        self.add(shape, bottom, material);
    }

    /// Block with its underside at a height.
    fn block(&mut self, at: Point2, size: [f32; 3], bottom: f32, albedo: f32) {
        let at = self.pose.to_outer(at);
        let centre = [at.x, at.y, bottom + 0.5 * size[2]];
        self.add(Shape::Block { centre, size, yaw: self.pose.theta }, bottom, Material::plain(albedo));
    }

    fn add(&mut self, shape: Shape, bottom: f32, material: Material) {
        let kind = if shape.top() <= LASER {
            SolidKind::Small
        } else if bottom > LASER {
            SolidKind::Overhanging
        } else {
            SolidKind::Object
        };
        self.space.add(Solid { shape, material, kind });
    }
}
