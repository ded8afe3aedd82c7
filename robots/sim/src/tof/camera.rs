use crate::Random;

/// Simulated time-of-flight camera (thesis 6.4).
///
/// Each pixel adds the light of several rays as complex numbers: their length is the amplitude, their angle the phase
/// of the modulation. The phase of the sum is the distance. Flying pixels at edges, and distances that wrap beyond half
/// the wavelength, are the consequence. So is the floor that seems to bend before a wall, as light of the wall comes
/// back over it.
#[derive(Debug, Clone, PartialEq)]
pub struct TofCamera {
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Horizontal field of view, in rad.
    pub field_of_view: f32,
    /// Position on the robot, in m.
    pub position: [f32; 3],
    /// Rotation downwards, in rad.
    pub pitch: f32,
    /// Wavelength of the modulation, in m. Distances are ambiguous beyond half of it.
    pub wavelength: f32,
    /// Amplitude of a surface of albedo 1 that faces the camera at 1 m, in raw units.
    pub gain: f32,
    /// Minimum amplitude of a measurement, in raw units.
    pub least_amplitude: f32,
    /// Maximum intensity, in raw units.
    pub saturation: f32,
    /// Number of rays of a pixel along each side.
    pub rays: usize,
    /// Static errors.
    pub distortion: Distortion,
}

/// Static errors of a camera: smooth functions of the pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distortion {
    /// Coefficients of the error of the distance, in m.
    pub distance: [f32; 6],
    /// Coefficients of the error of the vertical direction, in rad.
    pub elevation: [f32; 6],
    /// Amplitude of the error that repeats four times in the range of unambiguous distances, in m.
    pub wiggling: f32,
}

/// The E70-P of the thesis as far as it is known: 160 × 120 pixels, 10 m, 10 cm above the floor, 15° down. Without
/// distortion.
impl Default for TofCamera {
    fn default() -> Self {
        Self {
            width: 160,
            height: 120,
            field_of_view: 70_f32.to_radians(),
            position: [0.0, 0.0, 0.1],
            pitch: 15_f32.to_radians(),
            wavelength: 20.0,
            gain: 750.0,
            least_amplitude: 2.5,
            saturation: 1024.0,
            rays: 4,
            distortion: Distortion::NONE,
        }
    }
}

impl Distortion {
    /// No errors.
    pub const NONE: Self = Self { distance: [0.0; 6], elevation: [0.0; 6], wiggling: 0.0 };

    /// Errors of a random camera: up to some cm in distance, and about 1° in direction, which bends the floor by more
    /// than the height of a small object.
    pub fn random(random: &mut Random) -> Self {
        let mut of = |sigma: f32| core::array::from_fn(|_| random.normal(sigma));
        Self { distance: of(0.012), elevation: of(0.012), wiggling: 0.01 }
    }

    /// Value of a smooth function at the pixel (u, v), both from −1 to 1.
    pub(super) fn at(coefficients: &[f32; 6], u: f32, v: f32) -> f32 {
        // Second and third degree: what is left after the calibration of offset and tilt.
        let terms = [u * u - 0.33, v * v - 0.33, u * v, u * (u * u - 0.6), v * (v * v - 0.6), u * u * v];
        coefficients.iter().zip(terms).map(|(c, term)| c * term).sum()
    }
}
