use apex_nodes::{
    image::{BarCode, GrayImage, MAX_REGIONS, Region, Symbology, Target},
    learn::Class,
    scan::Pose2,
};
use apex_rt::node;

/// Numbers of the delivery stations.
pub const NUMBERS: std::ops::RangeInclusive<u32> = 1..=4;

/// Model of the network for [`is_cube`], on the patches of images of the hopper: class 1 is a cube. Trained by the
/// example `train_cube`.
pub const CUBE: &[u8] = include_bytes!("cube.mlp");

/// Number sign in an image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NumberSign {
    /// Number of the sign, 1 to 4.
    pub number: u32,
    /// Probability of the number, from 0 to 1.
    pub confidence: f32,
    /// Region of the digit.
    pub region: Region,
    /// Pose of the sign in the frame of the robot.
    pub pose: Pose2,
}

/// Number signs of one image.
pub type NumberSigns = heapless::Vec<NumberSign, MAX_REGIONS>;

/// Passes a region with a dark object that has light paper all around, like the digit of a sign. ⊥ for objects that
/// touch others, like most objects in images, and for those at the edge of the image, which may be cut off.
#[node]
pub fn on_paper(image: &GrayImage, region: &Region) -> Option<Region> {
    /// Width of the examined margin as a fraction of the object's height: narrower than the margin of a sign.
    const MARGIN: f32 = 0.1;
    /// Maximum darkening of the paper, as a fraction of its contrast to the ink.
    const SHADE: f32 = 0.25;
    let thing = light_of(image, region, |_, _| true);
    let edge = region.grown((MARGIN * region.height as f32).ceil() as u32, image.size());
    let (right, bottom) = (edge.left + edge.width, edge.top + edge.height);
    let is_whole = edge.left > 0 && edge.top > 0 && right < image.size().0 && bottom < image.size().1;
    let on_edge = |x: u32, y: u32| x == edge.left || x + 1 == right || y == edge.top || y + 1 == bottom;
    let paper = light_of(image, &edge, on_edge);
    let at = |part: usize| paper.get(paper.len() * part / 10).copied().map(f32::from);
    // In an oblique view, the corners of the rectangle may be beside the paper.
    let (ink, dark, light) = (f32::from(*thing.first()?), at(2)?, at(9)?);
    (is_whole && light > ink && light - dark <= SHADE * (light - ink)).then_some(*region)
}

/// Intensities of some pixels in a region, in ascending order.
fn light_of(image: &GrayImage, region: &Region, which: impl Fn(u32, u32) -> bool) -> Vec<u8> {
    let Region { left, top, width, height, .. } = region.grown(0, image.size());
    let places = (top..top + height).flat_map(|y| (left..left + width).map(move |x| (x, y)));
    let mut light: Vec<u8> =
        places.filter(|(x, y)| which(*x, *y)).map(|(x, y)| image.pixels.get_pixel(x, y).0[0]).collect();
    light.sort_unstable();
    light
}

/// Number sign from a digit; ⊥ if no station has this number, or if the region is wider than high, unlike a digit.
#[node]
pub fn number_sign(class: &Class, region: &Region) -> Option<NumberSign> {
    let Class { number, confidence } = *class;
    let is_sign = NUMBERS.contains(&number) && region.width <= region.height;
    is_sign.then_some(NumberSign { number, confidence, region: *region, pose: Pose2::default() })
}

/// Number sign at its pose in the frame of the robot.
#[node]
pub fn placed(sign: &NumberSign, pose: &Pose2) -> NumberSign {
    NumberSign { pose: *pose, ..*sign }
}

/// Pose of the sign in the frame of the robot.
#[node]
pub fn sign_pose(sign: &NumberSign) -> Pose2 {
    sign.pose
}

/// Number sign with the greatest confidence; ⊥ without signs.
#[node]
pub fn clearest(signs: &NumberSigns) -> Option<NumberSign> {
    signs.iter().max_by(|a, b| a.confidence.total_cmp(&b.confidence)).copied()
}

/// Number sign as a target on the wall, so that its pose can be measured.
#[node]
pub fn sign_target(sign: &NumberSign) -> Target {
    Target { centre: sign.region.middle(), region: sign.region }
}

/// Number of the sign.
#[node]
pub fn sign_number(sign: &NumberSign) -> u32 {
    sign.number
}

/// `true` if the network classified the image as a cube.
#[node]
pub fn is_cube(class: &Class) -> bool {
    class.number == 1
}

/// Number of the delivery station in the bar code of a cube; ⊥ if the code is not such a number.
#[node]
pub fn cube_number(code: &BarCode) -> Option<u32> {
    let number = code.text.parse().ok().filter(|number| NUMBERS.contains(number));
    number.filter(|_| code.symbology == Symbology::Code39)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::ImageBuffer;

    #[test]
    fn only_what_paper_surrounds_is_on_paper() {
        let picture = |gray: &dyn Fn(u32, u32) -> u8| {
            GrayImage::from(ImageBuffer::from_fn(60, 60, |x, y| image::Luma([gray(x, y)])))
        };
        let digit = Region { left: 20, top: 15, width: 15, height: 30, area: 450 };
        let inside = |x: u32, y: u32| (20..35).contains(&x) && (15..45).contains(&y);
        // In light from the side.
        let sign = picture(&|x, y| if inside(x, y) { 30 } else { 180 + (x / 2) as u8 });
        let touching = picture(&|x, y| if inside(x, y) || y > 40 { 30 } else { 200 });
        let light = picture(&|x, y| if inside(x, y) { 200 } else { 30 });
        assert_eq!(on_paper(&sign, &digit), Some(digit));
        for other in [touching, light, picture(&|_, _| 90), GrayImage::default()] {
            assert_eq!(on_paper(&other, &digit), None);
        }
        // A digit that the image cuts off.
        let cut = picture(&|x, y| if inside(x + 20, y) { 30 } else { 200 });
        assert_eq!(on_paper(&cut, &Region { left: 0, ..digit }), None);
        assert_eq!(on_paper(&sign, &Region { left: 70, width: u32::MAX, ..digit }), None);
        assert_eq!(on_paper(&sign, &Region::default()), None);
    }

    #[test]
    fn signs_have_numbers_of_stations_and_are_upright() {
        let class = |number| Class { number, confidence: 0.9 };
        let [upright, level] =
            [(20, 30), (30, 20)].map(|(width, height)| Region { width, height, ..Region::default() });
        assert_eq!(number_sign(&class(4), &upright).map(|sign| sign.number), Some(4));
        for (number, region) in [(0, upright), (5, upright), (4, level)] {
            assert_eq!(number_sign(&class(number), &region), None);
        }
    }

    #[test]
    fn the_likeliest_sign_counts() {
        let sign = |number, confidence| NumberSign { number, confidence, ..NumberSign::default() };
        let signs = [sign(1, 0.9), sign(2, 0.99), sign(3, 0.95)].into();
        assert_eq!((clearest(&signs), clearest(&NumberSigns::new())), (Some(sign(2, 0.99)), None));
    }

    #[test]
    fn only_bar_codes_of_cubes_name_stations() {
        let code = |text: &str, symbology| BarCode { text: text.to_owned(), symbology };
        assert_eq!(cube_number(&code("3", Symbology::Code39)), Some(3));
        for text in ["0", "5", "33", "", "A"] {
            assert_eq!(cube_number(&code(text, Symbology::Code39)), None, "{text}");
        }
        assert_eq!(cube_number(&code("3", Symbology::Code128)), None);
    }
}
