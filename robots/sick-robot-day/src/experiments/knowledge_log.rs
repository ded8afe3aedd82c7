use super::run_report::{Frame, Mark};
use crate::NumberSign;
use apex_nodes::{
    image::{GrayImage, Target},
    map::{Grid, Occupancy, Octagon, Signs, Station},
};
use apex_rt::{Ctx, Time, node};
use std::time::Duration;

/// Maximum number of images of targets, and of signs.
const FRAMES: usize = 4;
/// Initial minimum time between two images.
const APART: Duration = Duration::from_secs(10);

/// Records the knowledge of the robot for inspection after a run: a sink.
#[node]
#[derive(Debug, Default)]
pub struct KnowledgeLog {
    map: Option<Grid<Occupancy>>,
    island: Option<Octagon>,
    stations: heapless::Vec<Station, 4>,
    signs: Signs,
    /// Last image of the camera.
    image: GrayImage,
    crosses: Frames,
    numbers: Frames,
}

/// A few images, spread over the time in which images came.
#[derive(Debug, Default)]
struct Frames {
    kept: Vec<(Time, Frame)>,
    apart: Duration,
}

#[node]
impl KnowledgeLog {
    /// Stores the present map.
    #[slot]
    fn map(&mut self, map: &Grid<Occupancy>) {
        self.map = Some(map.clone());
    }

    /// Stores the pose of the island.
    #[slot]
    fn island(&mut self, island: &Octagon) {
        self.island = Some(*island);
    }

    /// Stores the filling stations.
    #[slot]
    fn stations(&mut self, stations: &heapless::Vec<Station, 4>) {
        self.stations.clone_from(stations);
    }

    /// Stores all detected signs.
    #[slot]
    fn signs(&mut self, signs: &Signs) {
        self.signs.clone_from(signs);
    }

    /// Stores the present image of the camera.
    #[slot]
    fn image(&mut self, image: &GrayImage) {
        self.image.clone_from(image);
    }

    /// Records a target in the image.
    #[slot]
    fn cross(&mut self, cross: &Target, ctx: &Ctx) {
        let mark = Mark::Cross(cross.centre);
        self.crosses.add(ctx.now(), "a target", &self.image, mark);
    }

    /// Records a sign in the image.
    #[slot]
    fn sign(&mut self, sign: &NumberSign, ctx: &Ctx) {
        let mark = Mark::Box(sign.region, sign.number.to_string());
        self.numbers.add(ctx.now(), "a sign", &self.image, mark);
    }
}

impl KnowledgeLog {
    /// Last map, or `None` before the first one.
    pub const fn last_map(&self) -> Option<&Grid<Occupancy>> {
        self.map.as_ref()
    }

    /// Last detected island.
    pub const fn last_island(&self) -> Option<Octagon> {
        self.island
    }

    /// Last detected filling stations.
    pub fn last_stations(&self) -> &[Station] {
        &self.stations
    }

    /// Last map of the signs.
    pub const fn last_signs(&self) -> &Signs {
        &self.signs
    }

    /// Some images with detections, in the order of time.
    pub fn frames(&self) -> Vec<Frame> {
        let mut all: Vec<&(Time, Frame)> = self.crosses.kept.iter().chain(&self.numbers.kept).collect();
        all.sort_by_key(|(time, _)| *time);
        all.into_iter().map(|(_, frame)| frame.clone()).collect()
    }
}

impl Frames {
    /// Keeps an image, unless the previous one is too recent. When there are too many, every other one is removed, and
    /// from then on the minimum time between images is doubled.
    fn add(&mut self, now: Time, what: &str, image: &GrayImage, mark: Mark) {
        self.apart = self.apart.max(APART);
        if self.kept.last().is_some_and(|(last, _)| now.since(*last) < self.apart) {
            return;
        }
        if self.kept.len() == FRAMES {
            let mut stays = false;
            self.kept.retain(|_| {
                stays = !stays;
                stays
            });
            self.apart *= 2;
        }
        let name = format!("{what} at {:.1} s", now.as_secs_f64());
        self.kept.push((now, Frame { name, image: image.clone(), marks: vec![mark] }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::image::Region;

    #[test]
    fn images_are_few_and_spread_over_the_run() {
        let mut knowledge_log = KnowledgeLog::default();
        let region = Region { left: 1, top: 1, width: 2, height: 2, area: 4 };
        for second in 0..600 {
            let ctx = Ctx::new(Time::from_secs(second));
            knowledge_log.image(&GrayImage { stamp: ctx.now(), ..GrayImage::default() });
            knowledge_log.cross(&Target { centre: [1.0, 2.0], region }, &ctx);
            if second > 300 {
                knowledge_log.sign(&NumberSign { number: 3, confidence: 1.0, region, ..NumberSign::default() }, &ctx);
            }
        }
        let frames = knowledge_log.frames();
        let times: Vec<f64> = frames.iter().map(|frame| frame.image.stamp.as_secs_f64()).collect();
        assert!(frames.len() <= 2 * FRAMES && times.is_sorted(), "{times:?}");
        for part in [0.0..1.0, 100.0..300.0, 300.0..450.0, 450.0..600.0] {
            assert!(times.iter().any(|time| part.contains(time)), "nothing in {part:?} of {times:?}");
        }
        assert!(frames[0].marks == [Mark::Cross([1.0, 2.0])]);
        assert!(frames.iter().any(|frame| frame.marks == [Mark::Box(region, "3".to_owned())]));
    }
}
