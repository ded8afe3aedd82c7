/// Pinhole camera without distortion, and its pose on the robot.
///
/// In the frame of the robot, x points forward, y left and z up. Without yaw and pitch the camera looks along x.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Camera {
    /// Width of the images, in pixels.
    pub width: u32,
    /// Height of the images, in pixels.
    pub height: u32,
    /// Focal length, in pixels.
    pub focal_length: f32,
    /// Pixel on the optical axis (u, v).
    pub principal_point: [f32; 2],
    /// Position in the frame of the robot, in m.
    pub position: [f32; 3],
    /// Rotation to the left, in rad.
    pub yaw: f32,
    /// Rotation downwards, in rad.
    pub pitch: f32,
}

impl Camera {
    /// Creates a camera at the origin that looks along x, with the optical axis through the middle of its images.
    /// `field_of_view` is the horizontal one, in rad.
    pub fn new(width: u32, height: u32, field_of_view: f32) -> Self {
        let middle = |count: u32| 0.5 * (count as f32 - 1.0);
        Self {
            width,
            height,
            focal_length: 0.5 * width as f32 / libm::tanf(0.5 * field_of_view),
            principal_point: [middle(width), middle(height)],
            position: [0.0; 3],
            yaw: 0.0,
            pitch: 0.0,
        }
    }

    /// Returns `true` if the images of the camera have this size.
    pub const fn takes(&self, size: (u32, u32)) -> bool {
        self.width == size.0 && self.height == size.1
    }

    /// Pixel (u, v) that shows a point of the robot frame. It may be outside the image. `None` if the point is not in
    /// front of the camera or a coordinate is not finite.
    pub fn project(&self, point: [f32; 3]) -> Option<[f32; 2]> {
        let [forward, left, up] = self.axes();
        let d: [f32; 3] = core::array::from_fn(|i| point[i] - self.position[i]);
        let depth = dot(d, forward);
        let u = self.principal_point[0] - self.focal_length * dot(d, left) / depth;
        let v = self.principal_point[1] - self.focal_length * dot(d, up) / depth;
        (depth > 0.0 && u.is_finite() && v.is_finite()).then_some([u, v])
    }

    /// Direction of the ray through a pixel, in the frame of the robot, with length 1.
    pub fn ray(&self, u: f32, v: f32) -> [f32; 3] {
        let [forward, left, up] = self.axes();
        let (a, b) = (self.principal_point[0] - u, self.principal_point[1] - v);
        let ray: [f32; 3] = core::array::from_fn(|i| self.focal_length * forward[i] + a * left[i] + b * up[i]);
        let length = libm::sqrtf(dot(ray, ray));
        ray.map(|x| x / length)
    }

    /// Forward, left and up directions of the camera in the frame of the robot.
    fn axes(&self) -> [[f32; 3]; 3] {
        let ((sin, cos), (down, level)) = (libm::sincosf(self.yaw), libm::sincosf(self.pitch));
        [[cos * level, sin * level, -down], [-sin, cos, 0.0], [cos * down, sin * down, level]]
    }
}

/// A camera without pixels.
impl Default for Camera {
    fn default() -> Self {
        Self::new(0, 0, 1.0)
    }
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn left_is_left_and_up_is_up() {
        let camera = Camera::new(640, 480, FRAC_PI_2);
        let [u, v] = camera.project([2.0, 0.5, 0.25]).expect("in front");
        assert!((u - (319.5 - 80.0)).abs() < 1e-3 && (v - (239.5 - 40.0)).abs() < 1e-3, "{u} {v}");
        assert!(camera.project([-1.0, 0.0, 0.0]).is_none());
        assert!(camera.project([f32::NAN, 0.0, 0.0]).is_none());
        assert!(camera.project([0.0, 1.0, 0.0]).is_none());
    }

    #[test]
    fn a_turned_camera_looks_where_it_is_turned() {
        let yawed = Camera { yaw: 0.3, ..Camera::new(640, 480, 1.0) };
        let [u, _] = yawed.project([0.3_f32.cos(), 0.3_f32.sin(), 0.0]).expect("ahead");
        assert!((u - 319.5).abs() < 1e-2);
        let pitched = Camera { pitch: 0.2, position: [0.0, 0.0, 1.0], ..Camera::new(640, 480, 1.0) };
        let [_, v] = pitched.project([1.0, 0.0, 1.0 - 0.2_f32.tan()]).expect("ahead");
        assert!((v - 239.5).abs() < 1e-2, "the floor ahead is on the axis of a camera that looks down");
    }

    #[test]
    fn the_ray_of_a_projection_leads_to_the_point() {
        let camera = Camera { position: [0.2, -0.1, 0.4], yaw: -0.4, pitch: 0.1, ..Camera::new(320, 240, 1.2) };
        for point in [[2.0, -0.5, 0.3], [1.0, -1.0, 1.0], [5.0, 0.0, 0.0]] {
            let [u, v] = camera.project(point).expect("in front");
            let ray = camera.ray(u, v);
            let d: [f32; 3] = core::array::from_fn(|i| point[i] - camera.position[i]);
            let along = dot(ray, d);
            let off: [f32; 3] = core::array::from_fn(|i| d[i] - along * ray[i]);
            assert!(dot(off, off) < 1e-9 && along > 0.0, "{point:?}");
        }
    }
}
