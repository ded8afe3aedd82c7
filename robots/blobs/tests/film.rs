//! From the camera to blobs through a file.

use apex_nodes::{image::ColorImage, io::BagTopic};
use apex_rt::{Construct as _, event, prelude::*};
use blobs::{Find, Prototype, film, parts};
use std::{env, fs, path::PathBuf};

/// Films for this time, in s.
fn filmed(name: &str, length: f64) -> PathBuf {
    let path = env::temp_dir().join(format!("apex-film-{}-{name}.mcap", std::process::id()));
    film(&path, length).expect("a film");
    path
}

#[test]
fn every_part_of_the_film_is_a_blob() {
    let path = filmed("parts", 4.0);
    let mut bag = BagTopic::<ColorImage>::construct((path.to_str().expect("text").to_owned(), "belt.image", false, ""));
    let (mut find, mut seen, mut done) = (Find::new(), 0, None);
    for millis in 0.. {
        let image = bag.process(&Ctx::new(Time::from_millis(millis)), event(&mut done)).expect("a film");
        if done.is_some() {
            break;
        }
        let Some(image) = image else { continue };
        let stamp = image.stamp;
        assert!(find.inputs().image.put(image).is_ok());
        find.react(stamp);
        let blobs = find.outputs().blobs.clone().expect("blobs");
        // Those that are in the image as a whole.
        let inside = |u: f64, v: f64, radius: f64| u > radius && u < 320.0 - radius && v > radius && v < 240.0 - radius;
        for part in parts(stamp).filter(|part| inside(part.u, part.v, part.radius + 1.0)) {
            let off = |u: f32, v: f32| (f64::from(u) - part.u).hypot(f64::from(v) - part.v);
            let nearest = blobs.iter().map(|blob| off(blob.u, blob.v)).fold(f64::MAX, f64::min);
            assert!(nearest < 1.0, "{part:?} is {nearest} pixels off at {stamp}: {blobs:?}");
            seen += 1;
        }
    }
    assert!(seen > 120, "{seen} parts");
    drop(fs::remove_file(path));
}

#[test]
fn the_film_is_played_again_and_again() {
    let path = filmed("again", 0.5);
    let mut bag = BagTopic::<ColorImage>::construct((path.to_str().expect("text").to_owned(), "belt.image", true, ""));
    let mut sent = vec![];
    for millis in (0..1550).step_by(10) {
        let image = bag.process(&Ctx::new(Time::from_millis(millis)), event(&mut None)).expect("a film");
        sent.extend(image.map(|image| (millis, image.stamp.as_nanos() / 1_000_000)));
    }
    // Six images each time, and the next time begins one or two firings after the last one.
    let passes: Vec<i64> = sent.chunks(6).map(|images| images[0].0).collect();
    assert_eq!((sent.len(), passes.len()), (18, 3), "{sent:?}");
    assert!(passes.windows(2).all(|pair| (510..=520).contains(&(pair[1] - pair[0]))), "{passes:?}");
    assert!(sent[6..].chunks(6).all(|images| images[1..].iter().all(|(at, stamp)| (at - stamp).abs() <= 10)));
    drop(fs::remove_file(path));
}

#[test]
fn the_prototype_runs_on_the_film() {
    let path = filmed("robot", 0.3);
    let mut robot = Prototype::new();
    robot.set_param("bag.file", path.to_str().expect("text").to_owned()).expect("a parameter");
    for name in ["find.threshold.radius", "find.open.radius", "find.close.radius"] {
        robot.set_param(name, 3_usize).expect("a parameter that can be tried while it runs");
    }
    for millis in (0..500).step_by(10) {
        robot.react(Time::from_millis(millis));
    }
    drop(fs::remove_file(path));
}
