use super::{Blob, Blobs, Camera};
use crate::scan::{Point2, Pose2};
use apex_rt::{Out, node};

/// Finds a thing that stands on level ground among blobs, by its shape, and where it stands.
///
/// The shape is the height of the blob by its width. Blobs at the border of the image are cut off, and do not count. Of
/// several, the largest one is taken. `place` is the middle of the thing, in the frame of the robot, whose floor is at
/// height 0; the thing is taken to be as deep as it is wide. Its heading is that of the line of sight, as a round thing
/// has none. Both outputs are ⊥ without such a thing within `reach`.
#[node]
#[derive(Debug, Clone)]
pub struct StandingBlob {
    /// Class of the thing, which is sent with its place.
    #[param(default = 1)]
    class: u32,
    /// Minimum of the height by the width.
    #[param(default = 0.0, range = 0.0..=100.0)]
    min_shape: f32,
    /// Maximum of the height by the width.
    #[param(default = 100.0, range = 0.0..=100.0)]
    max_shape: f32,
    /// Maximum distance from the camera.
    #[param(unit = "m", default = 4.0, range = 0.0..=100.0)]
    reach: f32,
}

#[node]
impl StandingBlob {
    fn process(&mut self, blobs: &Blobs, camera: &Camera, class: &mut Out<u32>, place: &mut Out<Pose2>) {
        let fits = |blob: &&Blob| self.fits(blob, camera);
        let places = blobs.iter().filter(fits).filter_map(|blob| Some((blob.region.area, self.place(blob, camera)?)));
        if let Some((_, found)) = places.max_by_key(|(area, _)| *area) {
            class.set(self.class);
            place.set(found);
        }
    }

    fn fits(&self, blob: &Blob, camera: &Camera) -> bool {
        let region = &blob.region;
        let is_whole = region.left > 0
            && region.top > 0
            && region.left + region.width < camera.width
            && region.top + region.height < camera.height;
        let shape = region.height as f32 / region.width as f32;
        is_whole && (self.min_shape..=self.max_shape).contains(&shape)
    }

    /// Place of a blob: its lower edge is where the thing meets the ground.
    fn place(&self, blob: &Blob, camera: &Camera) -> Option<Pose2> {
        let region = &blob.region;
        let foot = (region.top + region.height) as f32 - 0.5;
        let [x, y, z] = camera.ray(blob.u, foot);
        let length = -camera.position[2] / z;
        let (sight, way) = (Point2::new(x, y), Point2::new(x, y).scaled(length));
        let depth = 0.5 * region.width as f32 * way.norm() / camera.focal_length;
        let middle = way + sight.scaled(depth / sight.norm());
        let place = Point2::new(camera.position[0], camera.position[1]) + middle;
        // A ray that does not go down meets no ground. False for NaN.
        (length > 0.0 && middle.norm() <= self.reach).then(|| Pose2::new(place.x, place.y, sight.angle()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Region;
    use apex_rt::Construct;

    fn camera() -> Camera {
        Camera { position: [0.1, 0.0, 0.5], pitch: 0.2, ..Camera::new(320, 240, 1.2) }
    }

    /// Blob of a thing whose foot is at a place of the floor, with a size in pixels.
    fn blob(foot: [f32; 2], width: u32, height: u32) -> Blob {
        let [u, v] = camera().project([foot[0], foot[1], 0.0]).expect("it is before the camera");
        let (left, top) = (u.round() as u32 - width / 2, v.round() as u32 - height);
        Blob { u, v: 0.0, region: Region { left, top, width, height, area: width * height } }
    }

    fn find(blobs: &[Blob]) -> Option<(u32, Pose2)> {
        let (mut class, mut place) = (Out::new(), Out::new());
        let blobs = blobs.iter().copied().collect();
        StandingBlob::construct((7, 1.0, 2.0, 4.0)).process(&blobs, &camera(), &mut class, &mut place);
        class.get().copied().zip(place.get().copied())
    }

    #[test]
    fn a_thing_stands_where_its_blob_meets_the_ground() {
        let (class, place) = find(&[blob([2.0, 0.5], 10, 15)]).expect("it has the shape");
        // Its front is at the foot; the middle is half of its width behind.
        assert_eq!(class, 7);
        assert!((place.x - 2.04).abs() < 0.05 && (place.y - 0.51).abs() < 0.03, "{place:?}");
    }

    #[test]
    fn the_largest_of_the_right_shape_is_taken() {
        let flat = blob([1.5, 0.0], 40, 20);
        let (far, near) = (blob([3.0, -0.5], 8, 12), blob([2.0, 0.5], 12, 18));
        let place = find(&[flat, far, near]).expect("two have the shape").1;
        assert!(place.y > 0.4, "{place:?}");
        assert_eq!(find(&[flat]), None);
    }

    #[test]
    fn what_is_cut_off_or_too_far_or_above_the_horizon_is_left_out() {
        let cut = Blob { region: Region { left: 0, ..blob([2.0, 0.5], 10, 15).region }, ..blob([2.0, 0.5], 10, 15) };
        let sky = Blob { region: Region { top: 2, ..blob([2.0, 0.5], 10, 15).region }, ..blob([2.0, 0.5], 10, 15) };
        assert_eq!(find(&[cut, sky, blob([5.0, 0.0], 4, 6)]), None);
        assert_eq!(find(&[]), None);
    }
}
