use apex_nodes::{
    image::{GrayImage, Region},
    learn::{Features, acf_features, hog_features},
    math::Random,
};
use apex_rt::Out;
use std::{collections::BTreeMap, fs, path::PathBuf};

/// Regions without a person in each image.
const OTHERS: usize = 60;

/// Largest intersection of such a region with a person, over their union.
const MAX_OVERLAP: f32 = 0.3;

/// Descriptor of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Descriptor {
    Acf,
    Hog,
}

impl Descriptor {
    pub const fn name(self) -> &'static str {
        match self {
            Self::Acf => "acf",
            Self::Hog => "hog",
        }
    }

    /// Features of a crop.
    pub fn of(self, crop: &Crop) -> &[f32] {
        match self {
            Self::Acf => &crop.acf,
            Self::Hog => &crop.hog,
        }
    }
}

/// Features of a region.
pub struct Crop {
    pub is_person: bool,
    /// `true` for a region of the mirrored image, which is used for training only.
    pub is_mirrored: bool,
    hog: Features,
    acf: Features,
}

/// Box in an image, in pixels: first column and row, and those behind the last ones.
#[derive(Clone, Copy)]
struct Corners([f32; 4]);

impl Corners {
    fn overlap(&self, other: &Self) -> f32 {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        let common = (c.min(g) - a.max(e)).max(0.0) * (d.min(h) - b.max(f)).max(0.0);
        common / ((c - a) * (d - b) + (g - e) * (h - f) - common)
    }

    fn region(&self) -> Region {
        let [left, top, right, bottom] = self.0.map(|x| x.max(0.0).round() as u32);
        Region { left, top, width: right.saturating_sub(left), height: bottom.saturating_sub(top), area: 0 }
    }

    fn mirrored(&self, width: f32) -> Self {
        let [left, top, right, bottom] = self.0;
        Self([width - right, top, width - left, bottom])
    }
}

/// Crops of all images, in the order of their frames.
pub fn crops(folder: &str, boxes: &str, seed: u64) -> Result<Vec<Vec<Crop>>, String> {
    let boxes = read_boxes(boxes)?;
    let sizes: Vec<[f32; 2]> = boxes.values().flatten().map(|Corners([a, b, c, d])| [c - a, d - b]).collect();
    let mut random = Random::new(seed);
    let mut images = Vec::new();
    for (frame, path) in frames(folder)? {
        let Some(persons) = boxes.get(&frame) else { continue };
        let image = ::image::open(&path).map_err(|e| format!("{} cannot be read: {e}", path.display()))?.to_luma8();
        let mirrored = GrayImage::from(::image::imageops::flip_horizontal(&image));
        let image = GrayImage::from(image);
        let (width, height) = (image.size().0 as f32, image.size().1 as f32);
        let mut regions: Vec<(Corners, bool)> = persons.iter().map(|person| (*person, true)).collect();
        for _ in 0..OTHERS {
            let [w, h] = sizes[(random.bits() % sizes.len() as u64) as usize];
            let (x, y) = (random.uniform(0.0, (width - w).max(1.0)), random.uniform(0.0, (height - h).max(1.0)));
            let other = Corners([x, y, x + w, y + h]);
            if persons.iter().all(|person| person.overlap(&other) < MAX_OVERLAP) {
                regions.push((other, false));
            }
        }
        let both = regions.iter().flat_map(|(corners, is_person)| {
            let straight = crop(&image, &corners.region(), *is_person, false);
            straight.into_iter().chain(crop(&mirrored, &corners.mirrored(width).region(), *is_person, true))
        });
        images.push(both.collect());
    }
    if images.is_empty() {
        return Err(format!("no image in {folder} has a frame number of the table"));
    }
    Ok(images)
}

/// Features of a region, or `None` if it has no pixels.
fn crop(image: &GrayImage, region: &Region, is_person: bool, is_mirrored: bool) -> Option<Crop> {
    let (mut hog, mut acf) = (Out::new(), Out::new());
    hog_features(image, region, &mut hog);
    acf_features(image, region, &mut acf);
    Some(Crop { is_person, is_mirrored, hog: hog.get()?.clone(), acf: acf.get()?.clone() })
}

/// Images of a folder by the number in their names.
fn frames(folder: &str) -> Result<BTreeMap<u32, PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{folder} cannot be read: {e}"))?;
    let number = |path: &PathBuf| {
        let name = path.file_stem()?.to_str()?;
        let digits: String = name.chars().filter(char::is_ascii_digit).collect();
        digits.parse().ok()
    };
    Ok(entries.flatten().map(|entry| entry.path()).filter_map(|path| Some((number(&path)?, path))).collect())
}

/// Boxes by frame.
fn read_boxes(file: &str) -> Result<BTreeMap<u32, Vec<Corners>>, String> {
    let text = fs::read_to_string(file).map_err(|e| format!("{file} cannot be read: {e}"))?;
    let mut boxes: BTreeMap<u32, Vec<Corners>> = BTreeMap::new();
    for (at, line) in text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty()) {
        let numbers: Vec<f32> = line.split(',').filter_map(|word| word.trim().parse().ok()).collect();
        let [frame, _, u, v, width, height] = numbers[..] else {
            return Err(format!("{file}:{}: `frame,person,u,v,width,height` expected", at + 1));
        };
        if !(width > 0.0 && height > 0.0 && u.is_finite() && v.is_finite()) {
            return Err(format!("{file}:{}: the box is empty", at + 1));
        }
        let (w, h) = (0.5 * width, 0.5 * height);
        boxes.entry(frame as u32).or_default().push(Corners([u - w, v - h, u + w, v + h]));
    }
    if boxes.is_empty() { Err(format!("{file} holds no box")) } else { Ok(boxes) }
}
