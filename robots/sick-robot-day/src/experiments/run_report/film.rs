//! Film of a run: a self-animating SVG without scripts, which browsers also play in a Markdown page.

use super::{Phase, RunReport, seconds};
use crate::world::{
    Arena,
    contest::{RIVALS, Robot},
};
use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;
use std::{
    fmt::{self, Write as _},
    time::Duration,
};

/// Speed of the film relative to the run.
const SPEED: f32 = 6.0;
/// Time of the run between two frames.
const PACE: Duration = Duration::from_millis(500);
/// Pixels per metre.
const SCALE: f32 = 40.0;
/// Half of the visible side of the arena, in m.
const REACH: f32 = 6.6;
/// Width of the column with the phases, in pixels.
const COLUMN: f32 = 190.0;
/// Height of a row of the column, in pixels.
const ROW: f32 = 24.0;
/// Colours of the delivery stations, and of their cubes.
const STATIONS: [&str; 4] = ["#c2410c", "#1d4ed8", "#15803d", "#a21caf"];

const STYLE: &str = "\
text { font-family: Helvetica, Arial, 'DejaVu Sans', sans-serif; font-size: 14px; fill: #222 }
.floor { fill: #fff; stroke: #333; stroke-width: 3 }
.island { fill: #e2e5ea; stroke: #333; stroke-width: 2 }
.rival { fill: #9aa1ab; stroke: #555 }
.ours { fill: #f0b429; stroke: #7a4b00; stroke-width: 2 }
.filling { fill: #555 }
.active { fill: #fdf0d5; stroke: #b3701b }
.small { font-size: 12px; fill: #555 }
.number { fill: #fff; font-weight: bold; text-anchor: middle }
";

/// Frame of the film.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shot {
    at: Time,
    robots: [(Pose2, Option<u32>); 1 + RIVALS],
}

/// Positions of all robots in the course of a run.
#[derive(Debug, Clone, Default)]
pub struct Film {
    shots: Vec<Shot>,
}

impl Film {
    /// Takes a frame if it is due.
    pub fn take(&mut self, now: Time, robots: impl FnOnce() -> [Robot; 1 + RIVALS]) {
        if self.shots.last().is_none_or(|last| now.since(last.at) >= PACE) {
            self.shots.push(Shot { at: now, robots: robots().map(|robot| (robot.pose, robot.cube)) });
        }
    }

    /// Film of a run as SVG.
    pub fn svg(&self, run_report: &RunReport) -> String {
        Picture { film: self, run_report, end: run_report.end().max(1.0) }.to_string()
    }
}

/// Film that is being written.
struct Picture<'a> {
    film: &'a Film,
    run_report: &'a RunReport,
    /// End of the run, in s.
    end: f32,
}

impl fmt::Display for Picture<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = 2.0 * REACH * SCALE;
        let width = side + COLUMN;
        writeln!(f, r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {side}" width="{width}">"#)?;
        writeln!(f, "<style>\n{STYLE}</style>")?;
        writeln!(f, r##"<rect width="{width}" height="{side}" fill="#f4f5f7"/>"##)?;
        arena(f, &self.run_report.arena)?;
        for rival in 1..=RIVALS {
            self.robot(f, rival)?;
        }
        self.robot(f, 0)?;
        self.column(f, side)?;
        writeln!(f, "</svg>")
    }
}

impl Picture<'_> {
    /// Time as a fraction of the run, for the key of an animation.
    fn key(&self, time: Time) -> f32 {
        (seconds(time) / self.end).clamp(0.0, 1.0)
    }

    /// Attributes of an animation with the duration of the film.
    fn always(&self) -> String {
        format!(r#"dur="{:.1}s" repeatCount="indefinite""#, self.end / SPEED)
    }

    /// Writes a moving robot, and the cube in its hopper.
    fn robot(&self, f: &mut fmt::Formatter<'_>, who: usize) -> fmt::Result {
        let shots = || self.film.shots.iter().map(move |shot| (shot.at, shot.robots[who]));
        let Some((_, (begin, _))) = shots().next() else { return Ok(()) };
        let [x, y] = spot(begin.position());
        writeln!(f, r#"<g transform="translate({x:.1} {y:.1})">"#)?;
        self.motion(f, "translate", shots().map(|(at, (pose, _))| (at, spot(pose.position()).to_vec())))?;
        let (class, radius) = if who == 0 { ("ours", 12.0) } else { ("rival", 11.0) };
        writeln!(f, r#"<circle class="{class}" r="{radius}"/>"#)?;
        if who == 0 {
            writeln!(f, r#"<g transform="rotate({:.0})">"#, degrees(&begin))?;
            self.motion(f, "rotate", unwound(shots().map(|(at, (pose, _))| (at, degrees(&pose)))))?;
            writeln!(f, r##"<path d="M20 0L9 -7L9 7Z" fill="#7a4b00"/></g>"##)?;
        }
        for (number, colour) in (1..).zip(STATIONS) {
            let carried: Vec<(Time, bool)> = shots().map(|(at, (_, cube))| (at, cube == Some(number))).collect();
            if carried.iter().any(|(_, is_carried)| *is_carried) {
                write!(f, r#"<g opacity="0">"#)?;
                self.shown(f, &changes(&carried))?;
                write!(f, r#"<rect x="-7" y="-7" width="14" height="14" rx="2" fill="{colour}"/>"#)?;
                writeln!(f, r#"<text class="number" y="5">{number}</text></g>"#)?;
            }
        }
        writeln!(f, "</g>")
    }

    /// Writes a movement through values at times.
    fn motion(
        &self,
        f: &mut fmt::Formatter<'_>,
        kind: &str,
        values: impl Iterator<Item = (Time, Vec<f32>)>,
    ) -> fmt::Result {
        let (mut keys, mut path) = (String::new(), String::new());
        for (at, value) in values {
            let _ = write!(keys, "{}{:.4}", if keys.is_empty() { "" } else { ";" }, self.key(at));
            let value: Vec<String> = value.iter().map(|number| format!("{number:.1}")).collect();
            let _ = write!(path, "{}{}", if path.is_empty() { "" } else { ";" }, value.join(" "));
        }
        // The last value is repeated at the end, also if a frame was taken then.
        let last = path.rsplit(';').next().unwrap_or_default().to_owned();
        let begin = path.split(';').next().unwrap_or_default().to_owned();
        let always = self.always();
        writeln!(
            f,
            r#"<animateTransform attributeName="transform" type="{kind}" {always} keyTimes="0;{keys};1" values="{begin};{path};{last}"/>"#
        )
    }

    /// Shows the enclosing element from each time with `true` to the next time with `false`.
    fn shown(&self, f: &mut fmt::Formatter<'_>, changes: &[(Time, bool)]) -> fmt::Result {
        let (mut keys, mut values) = ("0".to_owned(), "0".to_owned());
        for (at, is_shown) in changes {
            let _ = write!(keys, ";{:.4}", self.key(*at));
            let _ = write!(values, ";{}", u8::from(*is_shown));
        }
        let always = self.always();
        write!(
            f,
            r#"<animate attributeName="opacity" calcMode="discrete" {always} keyTimes="{keys}" values="{values}"/>"#
        )
    }

    /// Writes the column at the right: the active phases of the mission, its deliveries, and the progress of the run.
    fn column(&self, f: &mut fmt::Formatter<'_>, side: f32) -> fmt::Result {
        let left = side + 4.0;
        writeln!(f, r#"<text class="small" x="{left}" y="{:.1}">active in the mission</text>"#, 0.8 * ROW)?;
        for (row, name) in (1_u8..).zip(self.run_report.phase_names()) {
            let y = ROW * f32::from(row) + 8.0;
            let width = COLUMN - 16.0;
            write!(f, r#"<rect class="active" x="{left}" y="{y}" width="{width}" height="20" rx="5" opacity="0">"#)?;
            let phases = self.run_report.phases.iter().filter(|phase| phase.name == name);
            let changes: Vec<(Time, bool)> = phases.flat_map(ends).collect();
            self.shown(f, &changes)?;
            writeln!(f, r#"</rect><text x="{:.1}" y="{:.1}">{}</text>"#, left + 8.0, y + 15.0, escaped(name))?;
        }
        self.deliveries(f, left, side - 54.0)?;
        self.progress(f, left, side - 24.0)
    }

    /// Writes every delivered cube, visible from its time on.
    fn deliveries(&self, f: &mut fmt::Formatter<'_>, left: f32, y: f32) -> fmt::Result {
        const SIZE: f32 = 18.0;
        let in_row = ((COLUMN - 16.0) / SIZE) as usize;
        let deliveries = &self.run_report.report.deliveries;
        let rows = deliveries.len().div_ceil(in_row);
        let top = y - SIZE * rows as f32;
        writeln!(f, r#"<text class="small" x="{left}" y="{:.1}">delivered</text>"#, top - 6.0)?;
        for (index, delivery) in deliveries.iter().enumerate() {
            let at = [left + SIZE * (index % in_row) as f32, top + SIZE * (index / in_row) as f32];
            write!(f, r#"<g opacity="0" transform="translate({:.1} {:.1})">"#, at[0], at[1])?;
            self.shown(f, &[(delivery.at, true)])?;
            let colour = station_colour(delivery.station);
            write!(f, r#"<rect width="14" height="14" rx="2" fill="{colour}"/>"#)?;
            writeln!(f, r#"<text class="number" x="7" y="12">{}</text></g>"#, delivery.station)?;
        }
        Ok(())
    }

    fn progress(&self, f: &mut fmt::Formatter<'_>, left: f32, y: f32) -> fmt::Result {
        let (width, always) = (COLUMN - 16.0, self.always());
        writeln!(f, r##"<rect x="{left}" y="{y}" width="{width}" height="6" fill="#d7dbe0"/>"##)?;
        writeln!(
            f,
            r##"<rect x="{left}" y="{y}" width="0" height="6" fill="#555"><animate attributeName="width" from="0" to="{width}" {always}/></rect>"##
        )?;
        let words = format!("{} min, {SPEED} times as fast", super::clock(self.end));
        writeln!(f, r#"<text class="small" x="{left}" y="{:.1}">{words}</text>"#, y - 8.0)
    }
}

/// Writes the floor, the island and the stations.
fn arena(f: &mut fmt::Formatter<'_>, arena: &Arena) -> fmt::Result {
    polygon(f, "floor", &arena.border)?;
    let walls = arena.world.walls();
    let island: Vec<Point2> = walls.iter().skip(arena.border.len()).map(|wall| wall.a).collect();
    polygon(f, "island", &island)?;
    for station in arena.stations() {
        let [x, y] = spot(station.pose.position());
        match station.number {
            None => writeln!(f, r#"<circle class="filling" cx="{x:.1}" cy="{y:.1}" r="6"/>"#)?,
            Some(number) => {
                let colour = station_colour(number);
                write!(f, r#"<circle cx="{x:.1}" cy="{y:.1}" r="11" fill="{colour}"/>"#)?;
                writeln!(f, r#"<text class="number" x="{x:.1}" y="{:.1}">{number}</text>"#, y + 5.0)?;
            }
        }
    }
    Ok(())
}

fn polygon(f: &mut fmt::Formatter<'_>, class: &str, corners: &[Point2]) -> fmt::Result {
    let corners: Vec<String> = corners.iter().map(|c| spot(*c).map(|x| format!("{x:.1}")).join(",")).collect();
    writeln!(f, r#"<polygon class="{class}" points="{}"/>"#, corners.join(" "))
}

fn station_colour(number: u32) -> &'static str {
    let index = number.saturating_sub(1) as usize;
    STATIONS.get(index).copied().unwrap_or("#555")
}

/// Position of a place of the arena in the picture.
fn spot(place: Point2) -> [f32; 2] {
    [SCALE * (REACH + place.x), SCALE * (REACH - place.y)]
}

/// Heading of a pose in the picture, where y points down, in degrees.
fn degrees(pose: &Pose2) -> f32 {
    -pose.theta.to_degrees()
}

/// Unwrapped angles, so that nothing spins between two of them.
fn unwound(angles: impl Iterator<Item = (Time, f32)>) -> impl Iterator<Item = (Time, Vec<f32>)> {
    let mut last: Option<f32> = None;
    angles.map(move |(at, angle)| {
        let angle = last.map_or(angle, |last| angle + 360.0 * ((last - angle) / 360.0).round());
        last = Some(angle);
        (at, vec![angle])
    })
}

/// Start and end of a phase.
fn ends(phase: &Phase) -> [(Time, bool); 2] {
    [(phase.from, true), (phase.until, false)]
}

/// States that differ from the previous one.
fn changes(states: &[(Time, bool)]) -> Vec<(Time, bool)> {
    let mut is_on = false;
    states.iter().copied().filter(|(_, now)| std::mem::replace(&mut is_on, *now) != *now).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::run_report::tests::run_report;
    use apex_nodes::nav::Twist;

    fn robot(x: f32, theta: f32, cube: Option<u32>) -> Robot {
        Robot { pose: Pose2::new(x, 0.0, theta), twist: Twist::ZERO, radius: 0.3, lamp: false, cube }
    }

    fn filmed() -> Film {
        let mut film = Film::default();
        for step in 0..=1200_i64 {
            let (x, theta) = (0.001 * step as f32, 0.01 * step as f32);
            let cube = (step > 400).then_some(2);
            film.take(Time::from_millis(100 * step), || [0, 1, 2, 3].map(|who| robot(x + who as f32, theta, cube)));
        }
        film
    }

    #[test]
    fn shots_are_taken_at_their_pace() {
        let film = filmed();
        assert_eq!(film.shots.len(), 241);
        assert_eq!(film.shots[1].at, Time::from_millis(500));
    }

    #[test]
    fn keys_are_in_order_and_as_many_as_values() {
        let svg = filmed().svg(&run_report());
        let of = |line: &str, name: &str| {
            let (_, rest) = line.split_once(&format!("{name}=\"")).expect("an attribute");
            rest.split_once('"').expect("its end").0.split(';').map(str::to_owned).collect::<Vec<_>>()
        };
        let animations: Vec<&str> = svg.split("<animate").skip(1).filter(|line| line.contains("keyTimes")).collect();
        assert!(animations.len() > 12, "{}", animations.len());
        for animation in animations {
            let keys: Vec<f32> = of(animation, "keyTimes").iter().map(|key| key.parse().expect("a number")).collect();
            assert_eq!(keys.len(), of(animation, "values").len());
            assert!(keys[0] == 0.0 && keys.is_sorted() && keys.iter().all(|key| *key <= 1.0), "{keys:?}");
        }
    }

    #[test]
    fn nothing_spins_where_a_turn_is_full() {
        let angles = unwound([170.0, -170.0, -10.0, 20.0].into_iter().map(|angle| (Time::ZERO, angle)));
        assert_eq!(angles.map(|(_, angle)| angle[0]).collect::<Vec<_>>(), [170.0, 190.0, 350.0, 380.0]);
    }

    #[test]
    fn a_run_without_anything_has_a_film_too() {
        let mut run_report = run_report();
        (run_report.phases, run_report.report) = (vec![], crate::world::contest::Report::default());
        let svg = Film::default().svg(&run_report);
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{svg}");
    }
}
