use super::{
    Detections, Person, Persons,
    kalman::{NEW, SURE, Track},
};
use crate::scan::{Point2, Pose2};
use apex_rt::{Ctx, Event, Out, Time, node};
use heapless::Vec;
use libm::fmaxf;

/// Maximum number of tracks.
const MAX_TRACKS: usize = 96;
/// Maximum number of pairs of a track and a detection that are near each other.
const MAX_PAIRS: usize = 512;
/// Evidence that is lost when a person in view is not detected.
const DOUBT: f32 = 0.15;
/// Evidence with which something is a person to be followed.
const PERSON: f32 = 2.0;
/// Distance up to which a camera is expected to detect a person, in m.
const EXPECTED: f32 = 14.0;
/// Time after which what is not the target and is not seen any more is forgotten, in s.
const FORGET: f32 = 0.8;
/// Distance up to which the scanner may see two persons as one, and from which on they have parted, in m.
const BESIDE: f32 = 1.2;
const APART: f32 = 2.0;
/// Time for which a person beside another one is not seen, before both stand together, in s.
const HIDDEN: f32 = 1.0;
/// Difference of velocities that tells two persons apart, in m/s.
const SURELY: f32 = 0.3;
/// Difference of velocities up to which a person may be the same, in m/s.
const ALIKE: f32 = 1.2;

/// Meeting of the person with another one. The scanner may see one of both.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    other: u32,
    /// Velocity of the person before.
    course: Point2,
}

/// Tracks what is upright around a robot, tells which of it is the person to be followed, and keeps that person while
/// it is hidden (thesis 8.4.2).
///
/// `clusters` are the detections of a scanner, which sees all around, persons and trunks of trees alike. Each is
/// tracked by a Kalman filter of constant velocity; a detection belongs to the nearest track within the `gate`, the
/// nearest pairs first, so that who crosses the way of another one does not become that one. The slot `camera` takes
/// the detections of persons whenever there are some: they are evidence that a track is a person, and correct its
/// position while the scanner does not see it. Their stamps may be older than those of the clusters, and their errors
/// grow with the square of the distance from the pose of their view. Both are in the same fixed frame, that of `pose`.
///
/// The person is the nearest one to the robot of whom there is enough evidence, which triggers `found`. A person who is
/// hidden is predicted, for `keep` at most; one that appears again near the prediction is the same. One who stops so
/// near another one that the scanner sees one of both is kept there; when they part, the one who goes on as before is
/// the person. `lost` says that the person did not appear again. While the node is active, `person` is triggered in
/// each firing in which the person is farther from the robot than `near`. The output `target` is the person now, or ⊥,
/// and `persons` are all persons and all that moves, as far as it is known.
#[node]
#[derive(Debug, Clone)]
pub struct TrackTarget {
    /// Distance from the robot up to which the person is not followed.
    #[param(unit = "m", default = 3.0, range = 0.0..=100.0)]
    near: f32,
    /// Time for which a person who is not seen is kept.
    #[param(unit = "s", default = 4.0, range = 0.0..=60.0)]
    keep: f32,
    /// Standard deviation of the positions of clusters, along each axis.
    #[param(unit = "m", default = 0.12, range = 0.001..=2.0)]
    deviation: f32,
    /// Standard deviation of the range of a camera at 1 m, which grows with the square of the range.
    #[param(unit = "m", default = 0.0025, range = 0.00001..=1.0)]
    camera_depth: f32,
    /// Standard deviation of the direction of a camera.
    #[param(unit = "rad", default = 0.015, range = 0.0001..=1.0)]
    camera_bearing: f32,
    /// Standard deviation of accelerations.
    #[param(unit = "m/s^2", default = 1.5, range = 0.01..=20.0)]
    acceleration: f32,
    /// Maximum Mahalanobis distance of a detection from its track.
    #[param(default = 3.0, range = 0.1..=20.0)]
    gate: f32,
    tracks: Vec<Track, MAX_TRACKS>,
    next: u32,
    /// Time of the states of the tracks.
    now: Time,
    target: Option<u32>,
    /// Other one beside whom the person is.
    meeting: Option<Meeting>,
    /// Person who is lost, where the person was seen last.
    missing: Option<Track>,
    here: Option<Pose2>,
}

#[node]
impl TrackTarget {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        ctx: &Ctx,
        clusters: Option<&Detections>,
        pose: Option<&Pose2>,
        persons: &mut Out<Persons>,
        target: &mut Out<Person>,
        found: Event<()>,
        #[failure] lost: Event<()>,
        person: Event<Person>,
    ) {
        self.here = pose.filter(|pose| pose.is_usable()).copied().or(self.here);
        let had = self.target;
        self.predict(ctx.now());
        if let Some(clusters) = clusters {
            self.associate(clusters);
        }
        self.forget();
        self.meet();
        self.choose();
        match (had, self.target) {
            (None, Some(_)) => found.emit(()),
            (Some(_), None) => lost.emit(()),
            _ => {}
        }
        let all = persons.get_mut();
        all.clear();
        let is_known = |track: &&Track| Some(track.id) == self.target || track.is_someone();
        for track in self.tracks.iter().filter(is_known) {
            // There is room for all tracks.
            let _ = all.push(track.person());
        }
        let Some(followed) = self.followed() else { return };
        let followed = followed.person();
        target.set(followed);
        let distance = self.here.map_or(f32::INFINITY, |here| (followed.position - here.position()).norm());
        if ctx.active() && distance > self.near {
            person.emit(followed);
        }
    }

    /// Takes the persons that a camera has detected.
    #[slot]
    fn camera(&mut self, detections: &Detections) {
        let age = self.now.since(detections.stamp).as_secs_f32();
        if age > 1.0 {
            return;
        }
        let eye = detections.view.pose.position();
        let mut is_seen = [false; MAX_TRACKS];
        for detection in &detections.positions {
            let ray = *detection - eye;
            let range = ray.norm();
            let along = ray.scaled(1.0 / fmaxf(range, 1e-3));
            let deviations =
                [self.deviation + self.camera_depth * range * range, self.deviation + self.camera_bearing * range];
            let off = |track: &Track| *detection + track.velocity.scaled(age) - track.position;
            let distance = |track: &Track| {
                let (off, own) = (off(track), track.spread[0]);
                let parts = [along.dot(off), along.perpendicular().dot(off)];
                let squares = parts.iter().zip(deviations).map(|(part, d)| part * part / (d * d + own));
                squares.sum::<f32>()
            };
            let mut best: Option<(usize, f32)> = None;
            for (i, track) in self.tracks.iter().enumerate() {
                let d = distance(track);
                if d < self.gate * self.gate && best.is_none_or(|(_, least)| d < least) {
                    best = Some((i, d));
                }
            }
            if let Some((i, _)) = best {
                is_seen[i] = true;
                let off = off(&self.tracks[i]);
                let now = self.now;
                let track = &mut self.tracks[i];
                track.evidence = (track.evidence + 1.0).min(SURE);
                if now.since(track.seen).as_secs_f32() > 0.25 {
                    let parts =
                        [along.scaled(along.dot(off)), along.perpendicular().scaled(along.perpendicular().dot(off))];
                    track.correct(parts, deviations.map(|d| d * d));
                    track.seen = now;
                }
            } else {
                let spread = deviations[0] * deviations[0];
                let new = self.born(*detection, spread);
                if let Some(i) = new {
                    self.tracks[i].evidence = 1.0;
                    is_seen[i] = true;
                }
            }
        }
        for (track, is_seen) in self.tracks.iter_mut().zip(is_seen) {
            let is_near = (track.position - eye).norm() < EXPECTED;
            if !is_seen && is_near && detections.view.contains(track.position) {
                track.evidence = fmaxf(track.evidence - DOUBT, 0.0);
            }
        }
    }

    fn predict(&mut self, now: Time) {
        // The clock was set back.
        if now < self.now {
            self.reset();
        }
        let dt = now.since(self.now).as_secs_f32();
        self.now = now;
        let noise = self.acceleration * self.acceleration;
        self.tracks.iter_mut().for_each(|track| track.predict(dt, noise));
    }

    /// Gives each detection to a track, the nearest pairs first. A detection without one begins a new track.
    fn associate(&mut self, clusters: &Detections) {
        let noise = self.deviation * self.deviation;
        let most = self.gate * self.gate;
        let mut pairs: Vec<(f32, u8, u8), MAX_PAIRS> = Vec::new();
        for (i, track) in self.tracks.iter_mut().enumerate() {
            track.is_taken = false;
            for (k, detection) in clusters.positions.iter().enumerate() {
                let off = (*detection - track.position).norm_squared();
                let d = off / (noise + track.spread[0]);
                // However uncertain a track is, what is far away is something else.
                if d < most && off < 4.0 {
                    // Pairs beyond the room for them are left out.
                    let _ = pairs.push((d, i as u8, k as u8));
                }
            }
        }
        pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut is_used = [false; super::MAX_DETECTIONS];
        for (_, i, k) in &pairs {
            let (i, k) = (usize::from(*i), usize::from(*k));
            if self.tracks[i].is_taken || is_used[k] {
                continue;
            }
            is_used[k] = true;
            let now = self.now;
            let track = &mut self.tracks[i];
            let off = clusters.positions[k] - track.position;
            track.correct([off, Point2::default()], [noise; 2]);
            (track.is_taken, track.seen) = (true, now);
            track.hits += 1;
        }
        for (detection, _) in clusters.positions.iter().zip(is_used).filter(|(_, is_used)| !is_used) {
            self.born(*detection, noise);
        }
    }

    /// Begins a track, and returns its index.
    fn born(&mut self, position: Point2, spread: f32) -> Option<usize> {
        let id = self.next;
        self.next = self.next.wrapping_add(1);
        self.tracks.push(Track::new(id, position, spread, self.now)).ok().map(|()| self.tracks.len() - 1)
    }

    fn forget(&mut self) {
        let (now, target, keep) = (self.now, self.target, self.keep);
        if let Some(followed) = self.followed().filter(|track| now.since(track.seen).as_secs_f32() > keep) {
            // The prediction since the person was seen last is taken back.
            let unseen = now.since(followed.seen).as_secs_f32();
            let position = followed.position + followed.velocity.scaled(-unseen);
            self.missing = Some(Track { position, ..*followed });
            self.target = None;
        }
        self.tracks.retain(|track| {
            let age = now.since(track.seen).as_secs_f32();
            age <= if Some(track.id) == target { keep } else { FORGET }
        });
    }

    fn followed(&self) -> Option<&Track> {
        self.tracks.iter().find(|track| Some(track.id) == self.target)
    }

    /// Keeps a person who stands so near another one that the scanner sees one of both, and decides who is who when
    /// they part: the person goes on as before, or stands, and the other one goes elsewhere.
    fn meet(&mut self) {
        let met = self.meeting.take();
        let Some(mine) = self.followed().copied() else { return };
        let unseen = |track: &Track| self.now.since(track.seen).as_secs_f32();
        let apart = |track: &Track| (track.position - mine.position).norm();
        let is_mine_seen = unseen(&mine) == 0.0;
        let others = self.tracks.iter().filter(|track| track.id != mine.id && unseen(track) == 0.0);
        let Some(Meeting { other, course }) = met else {
            let beside = others.filter(|track| is_mine_seen && track.is_someone() && apart(track) < BESIDE);
            let nearest = beside.min_by(|a, b| apart(a).total_cmp(&apart(b)));
            self.meeting = nearest.map(|other| Meeting { other: other.id, course: mine.velocity });
            return;
        };
        let Some(other) = others.copied().find(|track| track.id == other) else {
            // It may be seen again in the next turn, until it is forgotten.
            self.meeting = met.filter(|met| self.tracks.iter().any(|track| track.id == met.other));
            return;
        };
        let is_over =
            is_mine_seen && apart(&other) > BESIDE && (mine.moves() || other.moves() || apart(&other) > APART);
        if is_over {
            let off = |track: &Track| (track.velocity - course).norm();
            if off(&other) + SURELY < off(&mine) {
                self.target = Some(other.id);
            }
            return;
        }
        self.meeting = met;
        if unseen(&mine) > HIDDEN
            && let Some(mine) = self.tracks.iter_mut().find(|track| track.id == mine.id)
        {
            mine.stop_at(other.position);
        }
    }

    /// Chooses the person to be followed, or finds the present one again.
    fn choose(&mut self) {
        let now = self.now;
        let since = |time: Time| now.since(time).as_secs_f32();
        if let Some(followed) = self.followed().copied() {
            let unseen = since(followed.seen);
            // What stands in view of the camera, and is not a person, is something that hid the person.
            let is_thing = followed.evidence == 0.0 && followed.velocity.norm() < 0.3;
            if unseen < 0.3 && !is_thing {
                return;
            }
            let reach = 1.0 + 1.5 * unseen;
            let is_again = |track: &&Track| {
                let alike = (track.velocity - followed.velocity).norm() < ALIKE;
                let moves = track.moves() && alike;
                let may_be = since(track.born) < unseen + NEW && (track.evidence >= PERSON || moves);
                let may_be = may_be && self.meeting.is_none_or(|meeting| track.id != meeting.other);
                track.id != followed.id && since(track.seen) < 0.3 && may_be
            };
            let distance = |track: &Track| (track.position - followed.position).norm();
            let again = self.tracks.iter().filter(is_again).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(again) = again.filter(|track| distance(track) < reach) {
                self.target = Some(again.id);
                self.tracks.retain(|track| track.id != followed.id);
            } else if is_thing && unseen < 0.3 {
                self.target = None;
            }
            return;
        }
        let near = match &self.missing {
            Some(missing) => missing.position + missing.velocity.scaled(since(missing.seen)),
            None => self.here.map(|pose| pose.position()).unwrap_or_default(),
        };
        let distance = |track: &Track| (track.position - near).norm();
        let is_person = |track: &&Track| track.evidence >= PERSON && since(track.seen) < 0.5;
        let may_be = |track: &&Track| self.missing.is_none_or(|missing| missing.may_be(track, now));
        let sure = self.tracks.iter().filter(is_person).filter(may_be);
        self.target = sure.min_by(|a, b| distance(a).total_cmp(&distance(b))).map(|track| track.id);
        if self.target.is_some() {
            self.missing = None;
        }
    }

    /// Forgets everything.
    #[slot]
    fn reset(&mut self) {
        self.tracks.clear();
        (self.target, self.missing, self.meeting) = (None, None, None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::persons::View;
    use apex_rt::Construct;
    use std::{collections::BTreeSet, vec, vec::Vec as List};

    struct Test {
        node: TrackTarget,
        ms: i64,
        random: crate::math::Random,
        said: List<(&'static str, i64)>,
        ids: BTreeSet<u32>,
        target: Option<Person>,
        persons: usize,
    }

    impl Test {
        fn new() -> Self {
            let node = TrackTarget::construct((3.0, 4.0, 0.12, 0.0025, 0.015, 1.5, 3.0));
            Self {
                node,
                ms: 0,
                random: crate::math::Random::new(4),
                said: vec![],
                ids: BTreeSet::new(),
                target: None,
                persons: 0,
            }
        }

        fn around(&mut self, places: &[Point2], noise: f32) -> Detections {
            let mut detections = Detections { stamp: Time::from_millis(self.ms), ..Detections::default() };
            for place in places {
                let off = Point2::new(self.random.normal(noise), self.random.normal(noise));
                detections.positions.push(*place + off).expect("room");
            }
            detections
        }

        /// A turn of the scanner, and every other one an image.
        fn step(&mut self, clusters: &[Point2], camera: &[Point2]) {
            self.ms += 100;
            let detections = self.around(clusters, 0.05);
            let (mut persons, mut target) = (Out::new(), Out::new());
            let (mut found, mut lost, mut person) = (None, None, None);
            self.node.process(
                &Ctx::new(Time::from_millis(self.ms)).of_node(true),
                Some(&detections),
                Some(&Pose2::default()),
                &mut persons,
                &mut target,
                apex_rt::event(&mut found),
                apex_rt::event(&mut lost),
                apex_rt::event(&mut person),
            );
            self.said.extend(found.map(|()| ("found", self.ms)));
            self.said.extend(lost.map(|()| ("lost", self.ms)));
            self.target = target.get().copied();
            assert!(person.is_none() || person == self.target);
            self.ids.extend(person.map(|p| p.id));
            self.persons = persons.get().expect("persons").len();
            if self.ms % 200 == 0 {
                let view = View { angle: 1.2, nearest: 1.0, range: 20.0, ..View::default() };
                let detections = Detections { view, ..self.around(camera, 0.1) };
                self.node.camera(&detections);
            }
        }
    }

    const TREES: [Point2; 2] = [Point2::new(6.0, 1.6), Point2::new(9.0, -1.5)];

    #[test]
    fn a_person_among_trees_is_found_and_followed() {
        let mut test = Test::new();
        for i in 0..60 {
            let person = Point2::new(5.0 + 0.1 * i as f32, 0.0);
            test.step(&[TREES[0], person, TREES[1]], &[person]);
        }
        let target = test.target.expect("it is followed");
        assert!((target.position.x - 10.9).abs() < 0.2 && (target.velocity.x - 1.0).abs() < 0.15, "{target:?}");
        assert_eq!((test.said.len(), test.said[0].0, test.ids.len(), test.persons), (1, "found", 1, 1));
    }

    #[test]
    fn who_stands_too_near_for_the_camera_stays_the_person() {
        let mut test = Test::new();
        let person = |i: usize| Point2::new((5.0 - 0.15 * i as f32).max(0.7), 0.1);
        for i in 0..600 {
            let place = person(i);
            let seen = [place];
            test.step(&[TREES[0], place], if place.norm() > 1.0 { &seen } else { &[] });
        }
        let target = test.target.expect("it is followed");
        assert!((target.position - person(600)).norm() < 0.2 && test.said.len() == 1, "{target:?} {:?}", test.said);
        // What stands in view, and is not seen by the camera, is not the person.
        let mut test = Test::new();
        let place = [Point2::new(3.0, 0.1)];
        (0..20).for_each(|_| test.step(&place, &place));
        (0..200).for_each(|_| test.step(&place, &[]));
        assert!(test.target.is_none() && test.said.len() == 2, "{:?}", test.said);
    }

    #[test]
    fn a_hidden_person_is_kept_and_lost_in_time() {
        let mut test = Test::new();
        let person = |i: usize| Point2::new(5.0 + 0.2 * i as f32, 0.0);
        (0..20).for_each(|i| test.step(&[TREES[0], person(i)], &[person(i)]));
        (20..35).for_each(|i| {
            test.step(&TREES[..1], &[]);
            let off = (test.target.expect("it is kept").position - person(i)).norm();
            assert!(off < 0.5, "{off} m after {i}");
        });
        (35..45).for_each(|i| test.step(&[TREES[0], person(i)], &[]));
        assert!((test.target.expect("it is found again").position - person(44)).norm() < 0.2);
        assert_eq!(test.said.len(), 1);
        let until = test.ms;
        (0..50).for_each(|_| test.step(&TREES[..1], &[]));
        assert!(test.target.is_none());
        let (word, ms) = test.said[1];
        assert!(word == "lost" && (4000..4300).contains(&(ms - until)), "{word} {}", ms - until);
    }

    #[test]
    fn who_stands_near_the_robot_is_not_the_person_who_was_lost() {
        let mut test = Test::new();
        let person = |i: usize| Point2::new(5.0 + 0.2 * i as f32, 0.0);
        let other = Point2::new(3.0, 1.5);
        (0..20).for_each(|i| test.step(&[person(i)], &[person(i)]));
        (20..50).for_each(|i| test.step(&[person(i), other], &[person(i), other]));
        (0..60).for_each(|_| test.step(&[other], &[other]));
        assert!(test.target.is_none(), "{:?}", test.target);
        assert_eq!(test.said.len(), 2);
        // The person stands still where one comes to in that time.
        let place = Point2::new(18.0, 2.0);
        (0..10).for_each(|_| test.step(&[other, place], &[other, place]));
        let found = test.target.expect("it is found again");
        assert!((found.position - place).norm() < 0.3 && test.said.len() == 3, "{found:?} {:?}", test.said);
    }

    #[test]
    fn who_crosses_does_not_become_the_person() {
        let mut test = Test::new();
        for i in 0..80 {
            let t = 0.1 * i as f32;
            let person = Point2::new(5.0 + t, 0.1);
            // Both are at the same place after 4 s, and the scanner sees one of them only.
            let other = Point2::new(9.0, -4.8 + 1.2 * t);
            if (person - other).norm() < 0.4 {
                test.step(&[person], &[person]);
            } else {
                test.step(&[other, person], &[person, other]);
            }
        }
        assert!((test.target.expect("it is followed").position.x - 12.9).abs() < 0.3, "{:?}", test.target);
        assert_eq!(test.said.len(), 1);
    }

    /// The scanner sees both as one while they stand together. Then one goes on, and the other one stays for a moment.
    #[test]
    fn who_stands_beside_another_one_is_known_when_they_part() {
        let meets = Point2::new(9.0, 0.0);
        for (goes_first, way) in [(true, 1.2), (false, 1.2), (false, -1.2)] {
            let mut test = Test::new();
            let person = |t: f32| Point2::new(if t < 4.0 { 5.0 + t } else { 9.0 + (t - 8.0).max(0.0) }, 0.0);
            let other = |t: f32| {
                let begins = if goes_first { 10.0 } else { 7.0 };
                let y = if t < 4.0 { 1.2 * (t - 4.0) } else { way * (t - begins).max(0.0) };
                meets + Point2::new(0.1, y)
            };
            for i in 0..120 {
                let t = 0.1 * i as f32;
                let (mine, theirs) = (person(t), other(t));
                let middle = (mine + theirs).scaled(0.5);
                let both = if (mine - theirs).norm() < 0.5 { vec![middle] } else { vec![theirs, mine] };
                test.step(&both, &both);
                let off = test.target.filter(|_| t > 1.0).map_or(0.0, |target| (target.position - mine).norm());
                assert!(off < 1.5, "{off} m at {t} s: {goes_first} {way}");
            }
            let off = (test.target.expect("it is followed").position - person(12.0)).norm();
            assert!(off < 0.4 && test.said.len() == 1, "{off} m: {goes_first} {way}");
        }
    }

    /// The other one was hidden by the person, and then the scanner sees both as one for a moment.
    #[test]
    fn who_passes_someone_who_stands_is_not_taken_for_him() {
        for aside in [0.1, 0.3, 0.5] {
            let mut test = Test::new();
            let other = Point2::new(9.0, aside);
            for i in 0..80 {
                let mine = Point2::new(5.0 + 0.13 * i as f32, 0.0);
                let gap = (mine - other).norm();
                let seen = if gap < 0.55 {
                    vec![(mine + other).scaled(0.5)]
                } else if mine.x < 7.5 {
                    vec![mine]
                } else {
                    vec![other, mine]
                };
                test.step(&seen, &seen);
            }
            let off = (test.target.expect("it is followed").position.x - 15.27).abs();
            assert!(off < 0.4 && test.said.len() == 1, "{off} m, {aside} m aside");
        }
    }

    #[test]
    fn false_alarms_and_trees_are_not_followed() {
        let mut test = Test::new();
        for i in 0..100 {
            let alarm = [Point2::new(4.0 + 0.07 * i as f32, 0.5)];
            test.step(&TREES, if i % 20 == 1 { &alarm } else { &[] });
        }
        assert!(test.said.is_empty() && test.target.is_none());
    }
}
