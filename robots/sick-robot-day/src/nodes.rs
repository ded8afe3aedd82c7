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

/// A digit as a number sign; ⊥ if no station has this number, or it is wider than high, as no digit is.
#[node]
pub fn number_sign(class: &Class, region: &Region) -> Option<NumberSign> {
    let Class { number, confidence } = *class;
    let is_sign = NUMBERS.contains(&number) && region.width <= region.height;
    is_sign.then_some(NumberSign { number, confidence, region: *region })
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

/// The delivery station that the bar code of a cube names; ⊥ if it names none, or there is no cube: patterns may look
/// like bar codes.
#[node]
pub fn cube_number(code: &BarCode, full: &bool) -> Option<u32> {
    let number = code.text.parse().ok().filter(|number| NUMBERS.contains(number));
    number.filter(|_| *full && code.symbology == Symbology::Code39)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(cube_number(&code("3", Symbology::Code39), &true), Some(3));
        for text in ["0", "5", "33", "", "A"] {
            assert_eq!(cube_number(&code(text, Symbology::Code39), &true), None, "{text}");
        }
        assert_eq!(cube_number(&code("3", Symbology::Code39), &false), None);
        assert_eq!(cube_number(&code("3", Symbology::Code128), &true), None);
    }
}
