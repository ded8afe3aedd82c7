//! Targets, from the image to the pose (thesis 4.3.1).

use apex_nodes::{
    image::{Camera, GrayImage, Target},
    math::Random,
    scan::{Point2, Pose2, Scan},
};
use apex_rt::Time;
use cross::FindCross;
use image::{ImageBuffer, Luma};
use pose::FindTarget;
use std::f32::consts::PI;

mod cross {
    #![allow(missing_docs)]
    apex_rt::graph!("find_cross.afg");
}

mod pose {
    #![allow(missing_docs)]
    apex_rt::graph!("find_target.afg");
}

/// The sign: a white plate with two black rings, and with a cross if it is a target.
fn sign(x: f32, y: f32, cross: bool) -> f32 {
    let (r, stroke) = (x.hypot(y), 0.006);
    let ring = |radius: f32| (r - radius).abs() < stroke;
    let arm = cross && (x.abs() < stroke || y.abs() < stroke) && r < 0.095;
    match () {
        () if ring(0.08) || ring(0.045) || arm => 30.0,
        () if x.abs().max(y.abs()) < 0.12 => 220.0,
        () => 120.0,
    }
}

/// What a camera sees of a sign in the middle of a wall at a pose, with some noise.
fn view(camera: &Camera, pose: &Pose2, cross: bool, seed: u64) -> GrayImage {
    let mut random = Random::new(seed);
    let normal = Point2::polar(1.0, pose.theta);
    let eye = Point2::new(camera.position[0], camera.position[1]);
    let shade = |u: f32, v: f32| {
        let [x, y, z] = camera.ray(u, v);
        let far = (pose.position() - eye).dot(normal) / Point2::new(x, y).dot(normal);
        let across = (eye + Point2::new(x, y).scaled(far) - pose.position()).dot(normal.perpendicular());
        if far > 0.0 { sign(across, camera.position[2] + far * z - 0.5, cross) } else { 60.0 }
    };
    let sub = [-0.25, 0.25];
    let mean = |u: f32, v: f32| sub.iter().flat_map(|a| sub.map(|b| shade(u + a, v + b))).sum::<f32>() / 4.0;
    let pixels = ImageBuffer::from_fn(camera.width, camera.height, |u, v| {
        Luma([(0.8 * mean(u as f32, v as f32) + random.normal(4.0)) as u8])
    });
    pixels.into()
}

fn camera() -> Camera {
    Camera { position: [0.1, 0.0, 0.4], ..Camera::new(640, 480, 1.0) }
}

/// Poses in front of the robot, up to 2 m away, the wall turned up to 23°.
fn poses() -> impl Iterator<Item = Pose2> {
    let mut random = Random::new(5);
    (0..20).map(move |_| {
        let (far, side) = (random.uniform(0.7, 2.0), random.uniform(-0.25, 0.25));
        Pose2::new(0.1 + far, side * far, PI + random.uniform(-0.4, 0.4))
    })
}

/// The wall in which a target hangs, as a scanner at the origin sees it, with noise of 1 cm.
fn wall(pose: &Pose2, seed: u64) -> Scan {
    let mut random = Random::new(seed);
    let mut scan = Scan { angle_min: -1.0, angle_increment: 0.01, range_min: 0.05, range_max: 30.0, ..Scan::default() };
    let normal = Point2::polar(1.0, pose.theta);
    let range = |i: usize| pose.position().dot(normal) / Point2::polar(1.0, -1.0 + 0.01 * i as f32).dot(normal);
    scan.ranges.extend((0..201).map(|i| range(i) + random.normal(0.01)));
    scan
}

fn detect(image: GrayImage) -> Option<Target> {
    let mut program = FindCross::new();
    assert!(program.inputs().image.put(image).is_ok());
    program.react(Time::ZERO);
    program.outputs().target
}

fn locate(image: GrayImage, camera: Camera, scan: Scan) -> Option<Pose2> {
    let mut program = FindTarget::new();
    assert!(program.inputs().image.put(image).is_ok());
    assert!(program.inputs().camera.put(camera).is_ok());
    assert!(program.inputs().scan.put(scan).is_ok());
    program.react(Time::ZERO);
    program.outputs().pose
}

#[test]
fn targets_are_located_up_to_two_metres() {
    let mut found = 0;
    for (seed, pose) in (0..).zip(poses()) {
        let Some(located) = locate(view(&camera(), &pose, true, seed), camera(), wall(&pose, seed)) else {
            println!("not found: {pose:?}");
            continue;
        };
        let error = located.relative_to(&pose);
        assert!(error.position().norm() < 0.03 && error.theta.abs() < 0.1, "{pose:?}: {error:?}");
        found += 1;
    }
    println!("{found} of 20 targets located");
    assert!(found >= 18);
}

#[test]
fn rings_without_a_cross_are_no_target() {
    for (seed, pose) in (0..).zip(poses()) {
        assert_eq!(detect(view(&camera(), &pose, false, seed)), None, "{pose:?}");
    }
}

#[test]
fn other_rings_are_no_targets() {
    let Some(folder) = super::data("fiducials") else { return };
    for name in ["01.png", "maxicode/1.png", "maxicode/MODE3.png", "maxicode/MODE5.png"] {
        assert_eq!(detect(super::open(folder.join(name))), None, "{name}");
    }
}

#[test]
fn images_of_nothing_hold_no_target() {
    let pose = Pose2::new(1.5, 0.0, PI);
    for (width, height) in [(0, 0), (1, 1), (640, 1), (100, 100), (640, 480)] {
        for gray in [0, 255] {
            let image = || GrayImage::from(ImageBuffer::from_pixel(width, height, Luma([gray])));
            assert_eq!(detect(image()), None);
            assert_eq!(locate(image(), camera(), wall(&pose, 0)), None);
        }
    }
    let mut random = Random::new(2);
    let noise = ImageBuffer::from_fn(320, 240, |_, _| Luma([random.bits() as u8]));
    assert_eq!(detect(noise.into()), None);
    let seen = view(&camera(), &pose, true, 0);
    assert_eq!(locate(seen, camera(), Scan::default()), None, "nothing is left of the image without a scan");
}
