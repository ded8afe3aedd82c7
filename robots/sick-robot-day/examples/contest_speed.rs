//! Measures the computing time of ten simulated minutes of the competition, by driver, at the rates of the robot.

use apex_nodes::{
    image::{Camera, GrayImage},
    nav::Twist,
    scan::{Pose2, Scan},
};
use apex_rt::{Ctx, Out, Time};
use sick_robot_day::world::contest::{Base, Drivers, Hall};
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let hall = Hall::new(1, vec![])?;
    let Drivers { mut front_laser, mut rear_laser, mut wheel_odometry, mut front_camera, mut hopper_camera, .. } =
        Drivers::new(&hall);
    let mut base = Base::new(&hall);
    let (mut scan, mut pose) = (Out::<Scan>::new(), Out::<Pose2>::new());
    let (mut image, mut camera) = (Out::<GrayImage>::new(), Out::<Camera>::new());
    let mut spent = [Duration::ZERO; 6];
    let mut timed = |what: usize, run: &mut dyn FnMut()| {
        let start = Instant::now();
        run();
        spent[what] += start.elapsed();
    };
    for tick in 0..25 * 600_i64 {
        let ctx = Ctx::new(Time::from_millis(40 * tick));
        timed(0, &mut || hall.advance(ctx.now()));
        base.drive(&Twist::new(0.0, 0.1, 0.3), &ctx);
        timed(1, &mut || front_laser.process(&ctx, &mut scan));
        timed(2, &mut || rear_laser.process(&ctx, &mut scan));
        timed(3, &mut || wheel_odometry.process(&ctx, &mut pose));
        if tick % 5 == 0 {
            timed(4, &mut || front_camera.process(&ctx, &mut image, &mut camera));
        }
        if tick % 12 == 0 {
            timed(5, &mut || hopper_camera.process(&ctx, &mut image));
        }
    }
    let names = ["contest", "front scanner", "rear scanner", "odometry", "front camera", "hopper camera"];
    for (name, time) in names.iter().zip(spent) {
        println!("{name:<14} {:6.2} s", time.as_secs_f64());
    }
    println!("{:<14} {:6.2} s", "all", spent.iter().sum::<Duration>().as_secs_f64());
    Ok(())
}
