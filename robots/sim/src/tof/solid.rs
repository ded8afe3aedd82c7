use super::vector::{Turn, V3, add, norm, scale, sub, unit};

/// Reflection of infrared light by a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    /// Share of the light that is reflected diffusely, 0 to 1.
    pub albedo: f32,
    /// Additional reflection back to the source: 0 for plain surfaces, thousands for retro-reflectors.
    pub retro: f32,
    /// Share of the light that passes the solid, 0 to 1: 0.8 for clear glass.
    pub transmission: f32,
}

/// Kind of a solid, for the truth of the pixels that show it (thesis 6.3.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolidKind {
    /// Obstacle below the plane of the laser scanner.
    Small,
    /// Obstacle that the laser scanner sees too.
    Object,
    /// Obstacle above the plane of the laser scanner.
    Overhanging,
    /// Surface without a truth.
    Unlabelled,
}

/// Shape of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Upright box.
    Block {
        /// Centre, in m.
        centre: [f32; 3],
        /// Length, width and height, in m.
        size: [f32; 3],
        /// Rotation about the vertical axis, in rad.
        yaw: f32,
    },
    /// Round rod with flat ends: a pole, a cable, a glass.
    Rod {
        /// Middle of one end, in m.
        from: [f32; 3],
        /// Middle of the other end, in m.
        to: [f32; 3],
        /// Radius, in m.
        radius: f32,
    },
}

/// Solid in a [`Space`](super::Space).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Shape and place.
    pub shape: Shape,
    /// Material of its surface.
    pub material: Material,
    /// Kind of obstacle.
    pub kind: SolidKind,
}

/// Shape, with what is the same for all rays.
#[derive(Debug, Clone, Copy)]
pub enum Surface {
    Block {
        centre: V3,
        size: V3,
        /// Rotations into the frame of the block and out of it.
        turns: [Turn; 2],
    },
    Rod {
        from: V3,
        /// Direction of the rod, of length 1.
        axis: V3,
        length: f32,
        radius: f32,
    },
}

impl Material {
    /// Creates a plain material.
    pub const fn plain(albedo: f32) -> Self {
        Self { albedo, retro: 0.0, transmission: 0.0 }
    }

    /// Clear glass: little of the light comes back, except from surfaces that face the source.
    pub const GLASS: Self = Self { albedo: 0.06, retro: 0.0, transmission: 0.75 };

    /// Retro-reflector, as on vests, bicycles and as landmarks of vehicles.
    pub const RETRO: Self = Self { albedo: 0.5, retro: 8000.0, transmission: 0.0 };
}

impl Shape {
    /// Centre and radius of a sphere around the shape, in m.
    pub(super) fn bounds(&self) -> (V3, f32) {
        match *self {
            Self::Block { centre, size, .. } => (centre, 0.5 * norm(size)),
            Self::Rod { from, to, radius } => (scale(add(from, to), 0.5), 0.5 * norm(sub(to, from)) + radius),
        }
    }

    /// Surface that rays enter.
    pub(super) fn surface(&self) -> Surface {
        match *self {
            Self::Block { centre, size, yaw } => Surface::Block { centre, size, turns: [-yaw, yaw].map(Turn::new) },
            Self::Rod { from, to, radius } => {
                let along = sub(to, from);
                Surface::Rod { from, axis: unit(along), length: norm(along), radius }
            }
        }
    }

    /// Height of the highest point, in m.
    pub fn top(&self) -> f32 {
        match *self {
            Self::Block { centre, size, .. } => centre[2] + 0.5 * size[2],
            // The ends of a rod that is not upright are a little lower than this.
            Self::Rod { from, to, radius } => {
                let is_upright = from[0] == to[0] && from[1] == to[1];
                from[2].max(to[2]) + if is_upright { 0.0 } else { radius }
            }
        }
    }
}
