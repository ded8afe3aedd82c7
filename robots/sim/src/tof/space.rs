use super::{
    ray::{Entry, Ray},
    solid::{Material, Solid, SolidKind, Surface},
    vector::{V3, dot, scale},
};

/// World of solids on a floor, for a depth camera.
#[derive(Debug, Clone)]
pub struct Space {
    floor: Floor,
    solids: Vec<Solid>,
    /// Surface of each solid, with centre and radius of a sphere around it.
    surfaces: Vec<(Surface, (V3, f32))>,
    pits: Vec<Pit>,
}

/// Rectangular opening in the floor with sides along the axes, such as a stairwell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pit {
    /// Least and greatest x, in m.
    pub x: [f32; 2],
    /// Least and greatest y, in m.
    pub y: [f32; 2],
    /// Depth, in m.
    pub depth: f32,
}

/// Floor at z = 0, which may end at stairs that go down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Floor {
    /// Albedo, 0 to 1.
    pub albedo: f32,
    /// Size of a tile, in m. Tiles differ a little in albedo.
    pub tile: f32,
    /// Deviation of the albedo of a tile, relative.
    pub variation: f32,
    /// Distance at which the floor ends, along x, in m.
    pub end: f32,
    /// Height and depth of the steps behind the end, in m. The last of [`STEPS`] steps is a floor again.
    pub step: [f32; 2],
}

/// Number of steps of the stairs.
const STEPS: usize = 8;

/// True class of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Truth {
    /// Nothing was measured, or the pixel shows several surfaces and its measurement lies on one of them, or a surface
    /// below the floor.
    #[default]
    Unlabelled,
    /// Floor.
    Floor,
    /// Obstacle below the plane of the laser scanner.
    Small,
    /// Obstacle that the laser scanner sees too.
    Object,
    /// Obstacle above the plane of the laser scanner.
    Overhanging,
    /// Measurement where no surface is: a flying pixel, or a distance that is wrapped.
    Artefact,
}

/// Surface that a ray meets.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    pub entry: Entry,
    pub material: Material,
    pub truth: Truth,
    /// Number of the solid, or `None` for the floor.
    pub solid: Option<usize>,
}

/// Floor without end.
impl Default for Floor {
    fn default() -> Self {
        Self { albedo: 0.3, tile: 0.5, variation: 0.0, end: f32::INFINITY, step: [0.17, 0.29] }
    }
}

impl Space {
    /// Creates a space with only a floor.
    pub const fn new(floor: Floor) -> Self {
        Self { floor, solids: vec![], surfaces: vec![], pits: vec![] }
    }

    /// Removes all solids and openings, and keeps the storage.
    pub fn clear(&mut self) {
        self.solids.clear();
        self.surfaces.clear();
        self.pits.clear();
    }

    /// Opens the floor.
    pub fn dig(&mut self, pit: Pit) {
        self.pits.push(pit);
    }

    /// Adds a solid.
    pub fn add(&mut self, solid: Solid) {
        self.surfaces.push((solid.shape.surface(), solid.shape.bounds()));
        self.solids.push(solid);
    }

    /// All solids.
    pub fn solids(&self) -> &[Solid] {
        &self.solids
    }

    /// Nearest surface on a ray, without the solid `skipped`, which the ray has already passed.
    pub(super) fn hit(&self, ray: &Ray, skipped: Option<usize>) -> Option<Hit> {
        self.nearest(ray, skipped, (0..self.solids.len()).map(|number| (number, 0.0)))
    }

    /// As [`hit`](Self::hit), of some solids, which are at least this far away, in m.
    pub(super) fn nearest(
        &self,
        ray: &Ray,
        skipped: Option<usize>,
        solids: impl Iterator<Item = (usize, f32)>,
    ) -> Option<Hit> {
        let mut nearest = self.hit_floor(ray);
        for (i, least) in solids {
            let (solid, (surface, bounds)) = (&self.solids[i], &self.surfaces[i]);
            let is_hidden = nearest.is_some_and(|hit| hit.entry.distance < least);
            if Some(i) == skipped || is_hidden || !ray.touches(*bounds) {
                continue;
            }
            let Some(entry) = ray.enter(surface) else { continue };
            if nearest.is_none_or(|hit| entry.distance < hit.entry.distance) {
                let truth = solid.kind.into();
                nearest = Some(Hit { entry, material: solid.material, truth, solid: Some(i) });
            }
        }
        nearest
    }
}

impl Space {
    /// Surface of the floor, or the ground of an opening.
    fn hit_floor(&self, ray: &Ray) -> Option<Hit> {
        let hit = self.floor.hit(ray)?;
        let at = ray.at(hit.entry.distance);
        match self.pits.iter().find(|pit| pit.contains(at[0], at[1])) {
            Some(pit) => self.floor.level(ray, -pit.depth, f32::MIN, f32::INFINITY, Truth::Unlabelled),
            None => Some(hit),
        }
    }
}

impl Pit {
    /// Returns `true` if a point of the plane is over the opening.
    pub fn contains(&self, x: f32, y: f32) -> bool {
        self.x[0] < x && x < self.x[1] && self.y[0] < y && y < self.y[1]
    }
}

impl Floor {
    fn hit(&self, ray: &Ray) -> Option<Hit> {
        let flat = self.level(ray, 0.0, f32::MIN, self.end, Truth::Floor);
        if flat.is_some() || self.end.is_infinite() {
            return flat;
        }
        let [rise, tread] = self.step;
        (0..STEPS).find_map(|i| {
            let (from, down) = (self.end + i as f32 * tread, (i + 1) as f32 * rise);
            let to = if i + 1 == STEPS { f32::INFINITY } else { from + tread };
            self.level(ray, -down, from, to, Truth::Unlabelled)
        })
    }

    /// Entry into the horizontal plane at `height`, between two distances along x.
    fn level(&self, ray: &Ray, height: f32, from: f32, to: f32, truth: Truth) -> Option<Hit> {
        let distance = (height - ray.origin[2]) / ray.direction[2];
        let point = ray.at(distance);
        let inside = distance > 0.0 && ray.direction[2] < 0.0 && point[0] >= from && point[0] < to;
        let entry = Entry { distance, normal: [0.0, 0.0, 1.0] };
        inside.then(|| Hit { entry, material: Material::plain(self.albedo_at(point)), truth, solid: None })
    }

    fn albedo_at(&self, point: V3) -> f32 {
        let tile = scale(point, 1.0 / self.tile).map(libm::floorf);
        // A number of each tile that looks random, from −1 to 1.
        let wave = libm::sinf(dot(tile, [12.9898, 78.233, 0.0])) * 43_758.547;
        self.albedo * (1.0 + self.variation * (2.0 * (wave - libm::floorf(wave)) - 1.0))
    }
}

impl From<SolidKind> for Truth {
    fn from(kind: SolidKind) -> Self {
        match kind {
            SolidKind::Small => Self::Small,
            SolidKind::Object => Self::Object,
            SolidKind::Overhanging => Self::Overhanging,
            SolidKind::Unlabelled => Self::Unlabelled,
        }
    }
}
