use apex_nodes::{
    image::GrayImage,
    scan::{Point2, Pose2},
};
use image::imageops::{FilterType, resize};

/// Scene for a camera: upright objects on a floor.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// Brightness of the floor.
    pub floor: u8,
    /// Brightness of the sky.
    pub sky: u8,
    panels: Vec<Panel>,
    pillars: Vec<Pillar>,
}

/// Appearance of a surface.
#[derive(Debug, Clone)]
pub enum Look {
    /// Uniform brightness, 0 to 255.
    Plain(u8),
    /// Surface with a picture.
    Picture(Picture),
}

/// Picture with smaller copies of it for greater distances.
#[derive(Debug, Clone)]
pub struct Picture(Vec<GrayImage>);

/// Upright rectangle. For a viewer of its picture, `a` is on the left.
#[derive(Debug, Clone)]
pub struct Panel {
    /// Left end on the floor plan, in m.
    pub a: Point2,
    /// Right end on the floor plan, in m.
    pub b: Point2,
    /// Height of the lower edge, in m.
    pub bottom: f32,
    /// Height of the upper edge, in m.
    pub top: f32,
    /// Appearance of the surface.
    pub look: Look,
}

/// Upright cylinder.
#[derive(Debug, Clone)]
pub struct Pillar {
    /// Axis on the floor plan, in m.
    pub centre: Point2,
    /// Radius, in m.
    pub radius: f32,
    /// Height, in m.
    pub top: f32,
    /// Appearance of the surface. Of a picture, only its left edge is shown.
    pub look: Look,
}

/// Object in a column of an image.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Hit<'a> {
    /// Distance along the direction, in lengths of the direction vector.
    pub distance: f32,
    pub bottom: f32,
    pub top: f32,
    pub look: &'a Look,
    /// Position on the width of the object, from 0 to 1.
    pub across: f32,
    /// Width, in m.
    pub width: f32,
}

impl Scene {
    /// Creates a floor under a sky, with brightnesses from 0 to 255.
    pub const fn new(floor: u8, sky: u8) -> Self {
        Self { floor, sky, panels: vec![], pillars: vec![] }
    }

    /// Adds a panel.
    pub fn panel(&mut self, panel: Panel) {
        self.panels.push(panel);
    }

    /// Adds a picture of `width` m that hangs on a wall with its middle at the height `z` m. `pose` is its position,
    /// with x pointing to the viewer.
    pub fn sign(&mut self, pose: &Pose2, z: f32, width: f32, picture: Picture) {
        let (columns, rows) = picture.size();
        let half = 0.5 * width * rows as f32 / columns.max(1) as f32;
        // The y axis of the sign points to its left, which is on the right for the viewer.
        let [a, b] = [-0.5, 0.5].map(|side| pose.to_outer(Point2::new(0.0, side * width)));
        self.panel(Panel { a, b, bottom: z - half, top: z + half, look: Look::Picture(picture) });
    }

    /// Adds a pillar and returns its number.
    pub fn pillar(&mut self, pillar: Pillar) -> usize {
        self.pillars.push(pillar);
        self.pillars.len() - 1
    }

    /// Pillars for modification.
    pub fn pillars_mut(&mut self) -> &mut [Pillar] {
        &mut self.pillars
    }

    /// Collects the objects in a direction on the floor plan into `hits`, the farthest first.
    pub(crate) fn look<'a>(&'a self, origin: Point2, direction: Point2, hits: &mut Vec<Hit<'a>>) {
        hits.clear();
        hits.extend(self.panels.iter().filter_map(|panel| panel.hit(origin, direction)));
        hits.extend(self.pillars.iter().filter_map(|pillar| pillar.hit(origin, direction)));
        hits.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    }
}

impl Panel {
    fn hit(&self, origin: Point2, direction: Point2) -> Option<Hit<'_>> {
        let (along, from) = (self.b - self.a, self.a - origin);
        let normal = along.perpendicular();
        let distance = from.dot(normal) / direction.dot(normal);
        let across = (direction.scaled(distance) - from).dot(along) / along.norm_squared();
        // Also false for NaN: a direction along the panel.
        let seen = distance > 0.0 && distance.is_finite() && (0.0..=1.0).contains(&across);
        let (bottom, top, look) = (self.bottom, self.top, &self.look);
        seen.then(|| Hit { distance, bottom, top, look, across, width: along.norm() })
    }
}

impl Pillar {
    fn hit(&self, origin: Point2, direction: Point2) -> Option<Hit<'_>> {
        let to_centre = self.centre - origin;
        let squared = direction.norm_squared();
        let along = to_centre.dot(direction) / squared;
        let off = (to_centre - direction.scaled(along)).norm_squared();
        let half_chord = self.radius * self.radius - off;
        if half_chord < 0.0 {
            return None;
        }
        let distance = along - libm::sqrtf(half_chord / squared);
        let (top, look) = (self.top, &self.look);
        (distance > 0.0).then_some(Hit { distance, bottom: 0.0, top, look, across: 0.0, width: 2.0 * self.radius })
    }
}

impl Picture {
    /// Creates a picture from an image.
    pub fn new(image: GrayImage) -> Self {
        let mut levels = vec![image];
        while let Some(last) = levels.last()
            && last.size().0 > 1
            && last.size().1 > 1
        {
            let (width, height) = last.size();
            levels.push(resize(&last.pixels, width / 2, height / 2, FilterType::Triangle).into());
        }
        Self(levels)
    }

    /// Width and height of the full picture, in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.0.first().map_or((0, 0), GrayImage::size)
    }

    /// The smallest copy of the picture that is at least `width` pixels wide.
    pub(crate) fn at_width(&self, width: f32) -> Option<&GrayImage> {
        let wide = self.0.iter().take_while(|level| level.size().0 as f32 >= width);
        wide.last().or(self.0.first()).filter(|level| level.size().0 > 0 && level.size().1 > 0)
    }
}
