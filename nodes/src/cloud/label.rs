/// Result for a point of [`Columns`](super::Columns).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Label {
    /// Pixel without a measurement.
    #[default]
    Missing,
    /// Measurement that does not belong to any surface: an error of the sensor (thesis 6.4.2).
    Artefact,
    /// Point that is not classified yet, or that has too few neighbours for it.
    Unknown,
    /// Point of the overhanging volume, above the floor and all small objects.
    Overhanging,
    /// Traversable floor.
    Floor,
    /// Obstacle near the floor.
    Obstacle,
    /// Point far below the floor: down a flight of stairs.
    Below,
}

/// Labels of all points of [`Columns`](super::Columns), in the same order.
#[derive(Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Labels {
    /// Number of rows.
    pub height: usize,
    /// Labels, column by column from the left, each column from the top.
    pub labels: Vec<Label>,
}

impl Label {
    /// Returns `true` if the point is a hazard to the robot: an obstacle or an overhanging one.
    pub const fn is_hazard(self) -> bool {
        matches!(self, Self::Obstacle | Self::Overhanging)
    }

    /// Returns `true` if the point is a valid measurement.
    #[inline]
    pub const fn is_valid(self) -> bool {
        !matches!(self, Self::Missing | Self::Artefact)
    }
}

/// `clone_from` reuses the allocated storage.
impl Clone for Labels {
    fn clone(&self) -> Self {
        Self { height: self.height, labels: self.labels.clone() }
    }

    fn clone_from(&mut self, source: &Self) {
        self.height = source.height;
        self.labels.clone_from(&source.labels);
    }
}
