use apex_nodes::{
    image::{BarCode, MAX_REGIONS, Region, Symbology, Target},
    learn::Class,
};
use apex_rt::node;

/// The numbers of the delivery stations.
pub const NUMBERS: std::ops::RangeInclusive<u32> = 1..=4;

/// The network of [`is_cube`], for the patches of images of the hopper: class 1 is a cube. Made by the example
/// `train_cube`.
pub const CUBE: &[u8] = include_bytes!("cube.mlp");

/// A number sign in an image.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NumberSign {
    /// What it says, 1 to 4.
    pub number: u32,
    /// How likely that is, from 0 to 1.
    pub confidence: f32,
    /// Where the digit is.
    pub region: Region,
}

/// The number signs of one image.
pub type NumberSigns = heapless::Vec<NumberSign, MAX_REGIONS>;

/// A digit as a number sign; ⊥ if no station has this number.
#[node]
pub fn number_sign(class: &Class, region: &Region) -> Option<NumberSign> {
    let Class { number, confidence } = *class;
    NUMBERS.contains(&number).then_some(NumberSign { number, confidence, region: *region })
}

/// The sign that is likeliest to be one; ⊥ without signs.
#[node]
pub fn clearest(signs: &NumberSigns) -> Option<NumberSign> {
    signs.iter().max_by(|a, b| a.confidence.total_cmp(&b.confidence)).copied()
}

/// The sign as something that hangs on the wall, so that its pose can be measured.
#[node]
pub fn sign_target(sign: &NumberSign) -> Target {
    Target { centre: sign.region.middle(), region: sign.region }
}

/// Whether the network took it for a cube.
#[node]
pub fn is_cube(class: &Class) -> bool {
    class.number == 1
}

/// The delivery station that a bar code names; ⊥ if it is none of a cube.
#[node]
pub fn cube_number(code: &BarCode) -> Option<u32> {
    let number = code.text.parse().ok().filter(|number| NUMBERS.contains(number));
    number.filter(|_| code.symbology == Symbology::Code39)
}
