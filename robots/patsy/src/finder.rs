use crate::{LENGTH, TRAIL, WHEEL_BOXES, WHEEL_LENGTH, WHEEL_WIDTH, WIDTH};
use apex_nodes::scan::{
    Container, ContainerSearch, JumpDistance, RangeFilter, Scan, SegmentFilter, Segments, TooManySegments,
};
use apex_rt::{Construct as _, Out};

/// Dimensions of a container and limits of its detection, in SI units: the parameters of `FindContainer` in
/// `find_container.afg`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// Minimum range of a point, in m.
    pub near: f32,
    /// Maximum difference between neighbouring ranges in a segment, in m.
    pub gap: f32,
    /// Maximum size of a segment that may be a wheel, in m.
    pub max_size: f32,
    /// Maximum distance of a segment, in m.
    pub max_distance: f32,
    /// Dimensions of the container, in m: width, length, width and length of a wheel, trail of its castors.
    pub dimensions: [f32; 5],
    /// Maximum deviation of the distance between two near wheels, in m.
    pub tolerance: f32,
    /// Minimum number of points of a near wheel.
    pub min_points: u16,
    /// Minimum number of points in wheel boxes.
    pub min_inliers: u16,
    /// Number of points beside the wheels that refutes a hypothesis.
    pub max_outliers: u16,
    /// Minimum number of wheels that are seen.
    pub min_wheels: usize,
    /// Maximum number of wheels that are not seen in plain view.
    pub max_missing: usize,
    /// Length of the free strip before the container, in m.
    pub clearance: f32,
    /// Minimum share of the beams between the near wheels that do not end before the container.
    pub min_passing: f32,
    /// Maximum root mean square of the distances of the wheels from the model, in m.
    pub max_residual: f32,
    /// Maximum obliqueness of the view, in rad.
    pub max_view_angle: f32,
    /// Wheel boxes.
    pub boxes: &'static [[f32; 4]],
    /// Areas in which points do not count.
    pub boards: &'static [[f32; 4]],
}

/// Detection of containers by nodes connected by hand: `FindContainer` without a graph.
#[derive(Debug)]
pub struct Finder {
    filter: RangeFilter,
    jumps: JumpDistance,
    wheels: SegmentFilter,
    search: ContainerSearch,
    clean: Out<Scan>,
    segments: Out<Segments>,
    candidates: Out<Segments>,
}

impl Search {
    /// Container carts (see [`Cart`](crate::world::Cart)).
    pub const CART: Self = Self {
        near: 0.05,
        gap: 0.15,
        max_size: 0.2,
        max_distance: 5.0,
        dimensions: [WIDTH, LENGTH, WHEEL_WIDTH, WHEEL_LENGTH, TRAIL],
        tolerance: 0.15,
        min_points: 1,
        min_inliers: 4,
        max_outliers: 3,
        min_wheels: 3,
        max_missing: 0,
        clearance: 0.0,
        min_passing: 0.8,
        max_residual: 0.08,
        max_view_angle: 120.0_f32.to_radians(),
        boxes: WHEEL_BOXES,
        boards: &[],
    };
}

impl Finder {
    /// Connects the nodes.
    pub fn new(search: &Search) -> Self {
        let s = *search;
        let [width, length, wheel_width, wheel_length, trail] = s.dimensions;
        Self {
            filter: RangeFilter::construct((s.near, 10.0)),
            jumps: JumpDistance::construct((s.gap, 1)),
            wheels: SegmentFilter::construct((s.max_size, s.max_distance, 1)),
            search: ContainerSearch::construct((
                width,
                length,
                wheel_width,
                wheel_length,
                trail,
                s.tolerance,
                s.min_points,
                s.min_inliers,
                s.max_outliers,
                s.min_wheels,
                s.max_missing,
                s.clearance,
                s.min_passing,
                s.max_residual,
                s.max_view_angle,
                s.boxes,
                s.boards,
                0,
            )),
            clean: Out::new(),
            segments: Out::new(),
            candidates: Out::new(),
        }
    }

    /// Container in a scan, or `None`.
    ///
    /// # Errors
    /// If the scan has too many segments.
    pub fn find(&mut self, scan: &Scan) -> Result<Option<Container>, TooManySegments> {
        self.segment(scan)?;
        Ok(self.search())
    }

    /// First step: cleans and segments a scan.
    ///
    /// # Errors
    /// If the scan has too many segments.
    pub fn segment(&mut self, scan: &Scan) -> Result<(), TooManySegments> {
        self.filter.process(scan, &mut self.clean);
        let Some(clean) = self.clean.get() else { return Ok(()) };
        self.jumps.process(clean, &mut self.segments)?;
        if let Some(segments) = self.segments.get() {
            self.wheels.process(segments, &mut self.candidates);
        }
        Ok(())
    }

    /// Second step: searches the segments for a container.
    pub fn search(&mut self) -> Option<Container> {
        self.clean.get().zip(self.candidates.get()).and_then(|(clean, wheels)| self.search.process(clean, wheels))
    }
}
