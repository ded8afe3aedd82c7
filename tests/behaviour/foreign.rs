//! Tokens of a type of a crate on which only a library depends: this package does not depend on `heapless`.

use apex_macros::graph;
use apex_nodes::{
    image::ColorImage,
    map::{Octagon, Station, Stations},
    scan::{Point2, Pose2, Scan},
};
use apex_rt::{Output, Time, node};

/// Stations of a list that are free.
#[node]
pub fn count_free(list: &<Stations as Output<0>>::Token) -> u32 {
    list.iter().filter(|station| station.free).count() as u32
}

/// Pose of a station.
#[node]
pub fn pose_of(station: &Station) -> Pose2 {
    station.pose
}

graph! {
    use apex_nodes::{flow::Latch, map::{Octagon, Station, Stations}, scan::{Pose2, Scan}};
    use crate::foreign::{count_free, pose_of};

    graph Turned {
        in  station: Station;
        out pose: Pose2;
        station -> pose_of() -> pose;
    }

    /// The list goes to another thread group.
    graph Apart {
        in  octagon: Octagon;
        in  pose: Pose2;
        in  scan: Scan;
        out free: u32;

        node stations = Stations() on eyes;
        node last     = Latch() on eyes;
        node later    = Latch();

        octagon  -> stations.octagon;
        pose     -> [stations.start, stations.scanner];
        scan     -> stations.scan;
        stations -> last.set;
        last     -> [later.set, count_free()];
        later    -> count_free() -> free;
    }

    graph Kept {
        in  octagon: Octagon;
        in  pose: Pose2;
        in  scan: Scan;
        out now: u32;
        out kept: u32;

        node stations = Stations();
        node last     = Latch();
        node turned   = Turned() each;
        node poses    = Latch();

        octagon  -> stations.octagon;
        pose     -> [stations.start, stations.scanner];
        scan     -> stations.scan;
        stations -> [last.set, turned.station];
        turned   -> poses.set;
        stations -> count_free() -> now;
        last     -> count_free() -> kept;
    }
}

graph! {
    use apex_nodes::{flow::Latch, image::{ColorImage, GrayImage, to_gray}};

    /// Pixels are of the crate `image`, on which this package does not depend either.
    graph Pictures {
        in    picture: ColorImage;
        slot  asked: ColorImage;
        out   gray: GrayImage;
        out   kept: ColorImage;
        event answered: ColorImage;

        node last = Latch();

        picture -> to_gray() -> gray;
        picture -> last.set;
        last    -> kept;
        asked   -> answered;
    }
}

#[test]
fn an_alias_is_named_where_its_target_cannot_be() {
    let mut program = Pictures::new();
    let picture = ColorImage::default();
    let _ = program.inputs().picture.put(picture.clone());
    let _ = program.inputs().asked.put(picture.clone());
    program.react(Time::ZERO);
    let outputs = program.outputs();
    assert_eq!((outputs.gray.is_some(), &outputs.kept), (true, &Some(picture.clone())));
    assert_eq!(program.events().answered.take(), Some(picture));
}

#[test]
fn a_type_is_reached_through_the_node_that_sends_it() {
    let octagon = Octagon { centre: Point2::new(0.0, 0.0), apothem: 1.0, theta: 0.0 };
    let mut program = Kept::new();
    let mut counts = vec![];
    for second in 1..4 {
        let inputs = program.inputs();
        let _ = inputs.octagon.put(octagon);
        let _ = inputs.pose.put(Pose2::new(3.0, 0.0, 0.0));
        let _ = inputs.scan.put(Scan::default());
        program.react(Time::from_secs(second));
        counts.push((program.outputs().now, program.outputs().kept));
    }
    assert_eq!(counts, [(Some(4), Some(4)); 3]);
}
