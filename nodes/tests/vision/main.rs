//! Vision of a robot (thesis 4.3.2, 4.3.3): number signs, digits and bar codes, drawn and real ones.
//!
//! The real images are not part of the project. Without them the tests print a message and pass, unless they run with
//! `CI=true`.

use apex_nodes::{
    image::{BlackHat, Components, GrayImage, Region, bar_code, largest},
    learn::{Activity, Classifier, DIGITS, Example, Features, Mlp, Model, Trainer, glyph_features},
    math::Random,
};
use apex_rt::{Construct, Out};
use image::{ImageBuffer, Luma};
use std::{
    fs,
    io::Read,
    path::{Path, PathBuf},
};

#[path = "../../examples/train_digits/pen.rs"]
mod pen;

/// Folder of the data, or `None` (with a message) if it does not exist.
fn data(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", folder.display());
    eprintln!("skipped: {} is missing", folder.display());
    None
}

fn open(path: impl AsRef<Path>) -> GrayImage {
    image::open(path).expect("an image").to_luma8().into()
}

#[test]
fn bar_codes_are_read_exactly() {
    let Some(folder) = data("barcodes") else { return };
    let (mut right, mut all) = (0, 0);
    for kind in ["code128-1", "code39-1", "ean13-1", "ean8-1", "itf-1"] {
        let mut images: Vec<PathBuf> =
            fs::read_dir(folder.join(kind)).expect("images").flatten().map(|e| e.path()).collect();
        images.retain(|path| path.extension().is_some_and(|e| e == "png"));
        images.sort();
        for path in images {
            let expected = fs::read_to_string(path.with_extension("txt")).expect("what it says");
            let found = bar_code(&open(&path)).map(|code| code.text);
            all += 1;
            if found.as_deref() == Some(expected.trim()) {
                right += 1;
            } else {
                println!("{}: {found:?} instead of {expected:?}", path.display());
            }
        }
    }
    println!("{right} of {all} bar codes read exactly");
    assert_eq!((right, all), (23, 23));
}

fn features(image: &GrayImage) -> Option<Features> {
    let (width, height) = image.size();
    let mut out = Out::new();
    glyph_features(image, &Region { width, height, ..Region::default() }, &mut out);
    out.get().cloned()
}

fn best(outputs: &[f32]) -> Option<usize> {
    (0..outputs.len()).max_by(|a, b| outputs[*a].total_cmp(&outputs[*b]))
}

/// Number of examples that the network classifies correctly.
fn right(network: &Mlp, examples: &[Example]) -> usize {
    let mut activity = Activity::default();
    examples.iter().filter(|e| best(network.run(&e.input, &mut activity)) == Some(e.class)).count()
}

/// The digits of the sheet: 50 rows of 50, five rows for each digit.
fn handwritten(folder: &Path) -> Vec<GrayImage> {
    let sheet = open(folder.join("handwritten_digits.png"));
    let cell = |i: u32| image::imageops::crop_imm(&sheet.pixels, i % 50 * 20, i / 50 * 20, 20, 20).to_image().into();
    (0..2500).map(cell).collect()
}

/// The network of the library, trained further on the left half of the sheet and measured on the right one.
#[test]
fn handwritten_digits_are_learned() {
    let Some(folder) = data("digits") else { return };
    let images = handwritten(&folder);
    let mut random = Random::new(1);
    let (mut seen, mut unseen) = (vec![], vec![]);
    for (i, image) in images.iter().enumerate() {
        let class = i / 250;
        let example = |image: &GrayImage| Example { input: features(image).expect("a digit").to_vec(), class };
        if i % 50 >= 25 {
            unseen.push(example(image));
            continue;
        }
        seen.push(example(image));
        seen.extend((0..8).map(|_| example(&slanted(image, &mut random))));
    }
    // The network already knows drawn digits.
    let mut network = Model::from_bytes(DIGITS).expect("the model of the library").network;
    let before = right(&network, &unseen) as f32 / unseen.len() as f32;
    let mut trainer = Trainer::new(&network, 1);
    for epoch in 0..12 {
        trainer.rate = 1e-3 * 0.8_f32.powi(epoch);
        trainer.epoch(&mut network, &seen);
    }
    let share = right(&network, &unseen) as f32 / unseen.len() as f32;
    println!("{:.1} % of {} handwritten digits, {:.1} % before learning", 100.0 * share, unseen.len(), 100.0 * before);
    assert!(share >= 0.92);
}

/// The same digit in a different handwriting.
fn slanted(image: &GrayImage, random: &mut Random) -> GrayImage {
    use imageproc::geometric_transformations::{Border, Interpolation, Projection, warp};
    let (slant, turn) = (random.normal(0.15), random.normal(0.1));
    let scale = random.uniform(0.8, 1.0);
    let to_middle = Projection::translate(-9.5, -9.5);
    let bent = Projection::from_matrix([scale, slant, 0.0, turn, 1.0, 0.0, 0.0, 0.0, 1.0]).expect("no mirror");
    let change = Projection::translate(9.5, 9.5) * bent * to_middle;
    warp(&image.pixels, change, Interpolation::Bilinear, Border::Constant(Luma([0]))).into()
}

fn unpacked(path: PathBuf) -> Vec<u8> {
    let mut bytes = vec![];
    flate2::read::GzDecoder::new(fs::File::open(path).expect("a file")).read_to_end(&mut bytes).expect("packed bytes");
    bytes
}

/// The classifier of the library was trained on digits drawn by strokes, without any of these fonts.
#[test]
fn printed_digits_are_read() {
    let Some(folder) = data("digits") else { return };
    let images = unpacked(folder.join("printed-images-idx3-ubyte.gz"));
    let labels = unpacked(folder.join("printed-labels-idx1-ubyte.gz"));
    let model = Model::from_bytes(DIGITS).expect("the model of the library");
    let image = |bytes: &[u8]| ImageBuffer::<Luma<u8>, _>::from_raw(28, 28, bytes.to_vec()).expect("28 x 28").into();
    let mut activity = Activity::default();
    let mut table = [[0; 10]; 10];
    for (bytes, label) in images[16..].chunks_exact(28 * 28).zip(&labels[8..]) {
        let found = features(&image(bytes)).and_then(|f| best(model.network.run(&f, &mut activity)));
        table[usize::from(*label)][found.expect("a digit")] += 1;
    }
    let right: u32 = (0..10).map(|i| table[i][i]).sum();
    let all: u32 = table.iter().flatten().sum();
    table.iter().for_each(|row| println!("{row:?}"));
    println!("{:.1} % of {all} printed digits", 100.0 * f64::from(right) / f64::from(all));
    assert_eq!(all, 2812);
    assert!(f64::from(right) >= 0.9 * f64::from(all));
}

/// A number sign of white paper on a wall, in uneven light.
fn sign(digit: usize, random: &mut Random) -> GrayImage {
    let drawn = pen::draw(digit, random).pixels;
    let side = random.uniform(70.0, 140.0) as u32;
    let paper = image::imageops::resize(&drawn, side, side, image::imageops::FilterType::Triangle);
    let dark = paper[(0, 0)].0[0] > 128;
    let (left, top) = (random.uniform(20.0, 150.0) as u32, random.uniform(20.0, 80.0) as u32);
    let pixels = ImageBuffer::from_fn(320, 240, |x, y| {
        let on_paper = x.checked_sub(left).zip(y.checked_sub(top)).and_then(|(x, y)| paper.get_pixel_checked(x, y));
        let shade = on_paper.map_or(110.0, |p| f32::from(if dark { p.0[0] } else { 255 - p.0[0] }));
        Luma([(shade * (0.5 + x as f32 / 640.0) + random.normal(2.0)) as u8])
    });
    pixels.into()
}

/// From the image to the number (thesis 4.3.2, figure 4.5): the digit is the largest dark object on light ground.
fn read_sign(image: &GrayImage, classifier: &mut Classifier) -> Option<u32> {
    let (mut hat, mut regions, mut features, mut class) = (Out::new(), Out::new(), Out::new(), Out::new());
    BlackHat::construct((25,)).process(image, &mut hat);
    Components::construct((40, 6, 200)).process(hat.get()?, &mut regions);
    glyph_features(image, &largest(regions.get()?)?.grown(3, image.size()), &mut features);
    classifier.process(features.get()?, &mut class).expect("the model of the library");
    class.get().map(|class| class.number)
}

/// The signs are drawn by the program that drew the training data, but with another seed.
#[test]
fn number_signs_are_read_in_images() {
    let mut random = Random::new(1_000_001);
    let mut classifier = Classifier::construct((DIGITS, 0.8));
    let (mut right, mut wrong) = (0, 0);
    for i in 0..100 {
        let digit = 1 + i % 4;
        let image = sign(digit, &mut random);
        match read_sign(&image, &mut classifier) {
            Some(number) if number as usize == digit => right += 1,
            Some(_) => wrong += 1,
            None => {}
        }
    }
    println!("{right} of 100 signs read, {wrong} wrong");
    assert!(right >= 90 && wrong <= 4);
    for (width, height) in [(0, 0), (1, 1), (320, 240)] {
        assert_eq!(read_sign(&ImageBuffer::from_pixel(width, height, Luma([0])).into(), &mut classifier), None);
    }
}
