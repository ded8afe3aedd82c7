use super::{Pose2, Scan};
use apex_rt::{Out, node};

/// Marks the beams of a scan that end in a box as not measured (NaN): in a load, or in a part of the robot itself.
///
/// `place` is the pose of the middle of the box in the frame of the scan. It may be ⊥: then nothing is hidden.
#[node]
#[derive(Debug, Clone)]
pub struct HideBox {
    /// Size of the box along its heading.
    #[param(unit = "m", range = 0.0..=100.0)]
    length: f32,
    /// Size of the box across.
    #[param(unit = "m", range = 0.0..=100.0)]
    width: f32,
}

#[node]
impl HideBox {
    fn process(&mut self, scan: &Scan, place: Option<&Pose2>, rest: &mut Out<Scan>) {
        let rest = rest.get_mut();
        rest.clone_from(scan);
        let Some(place) = place else { return };
        for (beam, point) in scan.points() {
            if place.is_in_box(point, self.length, self.width) {
                rest.ranges[beam] = f32::NAN;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn only_beams_that_end_in_the_box_are_hidden() {
        let mut scan = Scan { angle_min: 0.0, angle_increment: FRAC_PI_2, ..Scan::default() };
        scan.ranges.extend([1.0, 1.0, f32::INFINITY]);
        let mut node = HideBox::construct((1.0, 0.4));
        let mut hide = |place: Option<Pose2>| {
            let mut out = Out::new();
            node.process(&scan, place.as_ref(), &mut out);
            out.get().expect("a scan").ranges.iter().map(|range| range.is_nan()).collect::<std::vec::Vec<_>>()
        };
        assert_eq!(hide(Some(Pose2::new(0.6, 0.0, 0.0))), [true, false, false]);
        assert_eq!(hide(Some(Pose2::new(0.6, 0.0, FRAC_PI_2))), [false, false, false]);
        assert_eq!(hide(Some(Pose2::new(0.0, 0.6, FRAC_PI_2))), [false, true, false]);
        assert_eq!([hide(None), hide(Some(Pose2::new(f32::NAN, 0.0, 0.0)))], [[false; 3], [false; 3]]);
    }
}
