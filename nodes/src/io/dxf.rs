//! Plans from DXF files.

use super::{PlanOptions, ReadError};
use crate::{
    map::{MapError, VectorMap},
    scan::Point2,
};
use ::dxf::{
    Drawing,
    entities::{Entity, EntityType, Insert},
};
use std::{collections::HashMap, f64::consts::TAU, panic, path::Path};

/// Maximum number of entities in a file, so that reading it needs neither minutes nor gigabytes.
const MAX_ENTITIES: usize = 200_000;
/// Maximum nesting of blocks.
const MAX_DEPTH: usize = 8;
/// Maximum deviation of a chord from its arc, in m.
const SAGITTA: f64 = 0.01;

/// Affine map from a block to the plan: x, y and 1 to each coordinate, in m.
type Affine = [[f64; 3]; 2];

pub(super) fn read(path: &Path, options: &PlanOptions) -> Result<VectorMap, ReadError> {
    let bytes = std::fs::read(path).map_err(|e| ReadError::open(path, e))?;
    check(&bytes).map_err(|message| ReadError::open(path, message))?;
    // The parser of the library is not proved to be free of panics.
    let drawing = panic::catch_unwind(|| Drawing::load(&mut &bytes[..]))
        .map_err(|_| ReadError::open(path, "the file is not a valid DXF"))?
        .map_err(|e| ReadError::open(path, format_args!("the file is not a valid DXF: {e}")))?;
    let blocks = drawing.blocks().map(|block| (block.name.as_str(), block)).collect();
    let mut plan = Plan { options, blocks, map: VectorMap::default(), visited: 0 };
    let scale = options.scale;
    let metres = [[scale, 0.0, 0.0], [0.0, scale, 0.0]];
    drawing
        .entities()
        .try_for_each(|entity| plan.add(entity, &metres, None, 0))
        .map_err(|e| ReadError::open(path, e))?;
    if plan.map.segments().is_empty() {
        return Err(ReadError::open(path, nothing_selected(&drawing, options)));
    }
    Ok(plan.map)
}

/// Checks the size and the end of a text file before it is parsed.
fn check(bytes: &[u8]) -> Result<(), String> {
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err("the file is a binary DXF: export it as text".to_owned());
    }
    const CUT: &str = "the file is cut off or not a DXF: it has no `EOF` at its end";
    if !bytes.trim_ascii_end().ends_with(b"EOF") {
        return Err(CUT.to_owned());
    }
    let mut lines = bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).enumerate();
    let mut entities = 0;
    while let (Some((_, code)), Some((line, value))) = (lines.next(), lines.next()) {
        if code == b"0" && value == b"EOF" {
            return Ok(());
        }
        // The library ends its work at such a place without an error.
        let code: Option<i32> = str::from_utf8(code).ok().and_then(|code| code.parse().ok());
        let Some(code) = code else { return Err(format!("line {line} is not a group code")) };
        let is_number = || str::from_utf8(value).is_ok_and(|value| value.parse::<f64>().is_ok());
        if ((10..60).contains(&code) || (210..240).contains(&code)) && !is_number() {
            return Err(format!("line {}: `{}` is not a number", line + 1, String::from_utf8_lossy(value)));
        }
        entities += usize::from(code == 0);
        if entities > MAX_ENTITIES {
            return Err(format!("the file has more than {MAX_ENTITIES} entities: export only the layers of the walls"));
        }
    }
    Err(CUT.to_owned())
}

/// Message for a drawing without a segment, with the names of its layers.
fn nothing_selected(drawing: &Drawing, options: &PlanOptions) -> String {
    let mut layers: Vec<&str> = drawing.entities().map(|e| e.common.layer.as_str()).collect();
    layers.sort_unstable();
    layers.dedup();
    layers.truncate(20);
    let found = layers.iter().map(|layer| format!("`{layer}`")).collect::<Vec<_>>().join(", ");
    match (options.layers.is_empty(), layers.is_empty()) {
        (_, true) => "the drawing is empty".to_owned(),
        (true, false) => format!("the drawing has no line, only other things in {found}"),
        (false, false) => {
            format!("no line in the layers `{}`; the drawing has {found}", options.layers.join("`, `"))
        }
    }
}

struct Plan<'a> {
    options: &'a PlanOptions,
    blocks: HashMap<&'a str, &'a ::dxf::Block>,
    map: VectorMap,
    /// Number of entities visited: blocks of blocks may repeat each other without end.
    visited: usize,
}

impl Plan<'_> {
    /// Adds an entity. `layer` is that of the inserted block: it applies to what the block has in layer `0`.
    fn add(&mut self, entity: &Entity, at: &Affine, layer: Option<&str>, depth: usize) -> Result<(), MapError> {
        self.visited += 1;
        if self.visited > 10 * MAX_ENTITIES {
            return Err(MapError::TooMany);
        }
        let own = entity.common.layer.as_str();
        let layer = layer.filter(|_| own == "0").unwrap_or(own);
        if let EntityType::Insert(insert) = &entity.specific {
            return self.insert(insert, &facing(at, &insert.extrusion_direction), layer, depth);
        }
        let selected =
            self.options.layers.is_empty() || self.options.layers.iter().any(|l| l.eq_ignore_ascii_case(layer));
        if !selected || entity.common.is_in_paper_space {
            return Ok(());
        }
        match &entity.specific {
            EntityType::Line(line) => self.line(at, (line.p1.x, line.p1.y), (line.p2.x, line.p2.y)),
            EntityType::LwPolyline(line) => {
                let vertices: Vec<_> = line.vertices.iter().map(|v| (v.x, v.y, v.bulge)).collect();
                self.polyline(&facing(at, &line.extrusion_direction), &vertices, line.is_closed())
            }
            EntityType::Polyline(line) => {
                let vertices: Vec<_> = line.vertices().map(|v| (v.location.x, v.location.y, v.bulge)).collect();
                self.polyline(&facing(at, &line.normal), &vertices, line.is_closed())
            }
            EntityType::Arc(arc) => {
                let (from, to) = (arc.start_angle.to_radians(), arc.end_angle.to_radians());
                let turn = (to - from).rem_euclid(TAU);
                self.arc(&facing(at, &arc.normal), (arc.center.x, arc.center.y), arc.radius, from, turn)
            }
            EntityType::Circle(circle) => {
                let centre = (circle.center.x, circle.center.y);
                self.arc(&facing(at, &circle.normal), centre, circle.radius, 0.0, TAU)
            }
            _ => Ok(()),
        }
    }

    fn line(&mut self, at: &Affine, a: (f64, f64), b: (f64, f64)) -> Result<(), MapError> {
        let place = |(x, y): (f64, f64)| {
            let [x, y] = at.map(|row| row[0] * x + row[1] * y + row[2]);
            Point2::new(x as f32, y as f32)
        };
        self.map.add(place(a), place(b))
    }

    /// Adds a polyline with vertices of x, y and bulge: the tangent of a quarter of the angle of the arc that follows.
    fn polyline(&mut self, at: &Affine, vertices: &[(f64, f64, f64)], closed: bool) -> Result<(), MapError> {
        let next = vertices.iter().cycle().skip(1);
        let sides = if closed { vertices.len() } else { vertices.len().saturating_sub(1) };
        for (&(ax, ay, bulge), &(bx, by, _)) in vertices.iter().zip(next).take(sides) {
            let (dx, dy) = (bx - ax, by - ay);
            let length = dx.hypot(dy);
            if bulge == 0.0 || length == 0.0 || !bulge.is_finite() {
                self.line(at, (ax, ay), (bx, by))?;
                continue;
            }
            // Distance of the centre from the middle of the chord, to the left.
            let aside = (1.0 / bulge - bulge) / 4.0;
            let (x, y) = (0.5 * (ax + bx) - aside * dy, 0.5 * (ay + by) + aside * dx);
            let radius = length * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
            self.arc(at, (x, y), radius, (ay - y).atan2(ax - x), 4.0 * bulge.atan())?;
        }
        Ok(())
    }

    /// Adds chords of the arc of `turn` rad that begins in the direction `from`.
    fn arc(&mut self, at: &Affine, (x, y): (f64, f64), radius: f64, from: f64, turn: f64) -> Result<(), MapError> {
        let size = radius * (at[0][0].hypot(at[1][0])).max(at[0][1].hypot(at[1][1]));
        let step = if size > SAGITTA { 2.0 * (1.0 - SAGITTA / size).acos() } else { 2.0 };
        // A cast of NaN gives 0.
        let chords = ((turn.abs() / step).ceil() as usize).clamp(1, 720);
        let point = |i: usize| {
            let (sin, cos) = (from + turn * i as f64 / chords as f64).sin_cos();
            (x + radius * cos, y + radius * sin)
        };
        (0..chords).try_for_each(|i| self.line(at, point(i), point(i + 1)))
    }

    fn insert(&mut self, insert: &Insert, at: &Affine, layer: &str, depth: usize) -> Result<(), MapError> {
        let Some(block) = self.blocks.get(insert.name.as_str()).copied().filter(|_| depth < MAX_DEPTH) else {
            return Ok(());
        };
        let (sin, cos) = insert.rotation.to_radians().sin_cos();
        let (sx, sy) = (insert.x_scale_factor, insert.y_scale_factor);
        let linear = [[cos * sx, -sin * sy], [sin * sx, cos * sy]];
        for row in 0..insert.row_count.max(1) {
            for column in 0..insert.column_count.max(1) {
                let (u, v) = (f64::from(column) * insert.column_spacing, f64::from(row) * insert.row_spacing);
                let shift = [insert.location.x + cos * u - sin * v, insert.location.y + sin * u + cos * v];
                let base = [block.base_point.x, block.base_point.y];
                let inner: Affine = core::array::from_fn(|i| {
                    let [a, b] = linear[i];
                    [a, b, shift[i] - a * base[0] - b * base[1]]
                });
                let whole = compose(at, &inner);
                block.entities.iter().try_for_each(|entity| self.add(entity, &whole, Some(layer), depth + 1))?;
            }
        }
        Ok(())
    }
}

/// Map of an entity that is seen from below: mirrored, as a CAD program leaves it after its command to mirror.
fn facing(at: &Affine, normal: &::dxf::Vector) -> Affine {
    if normal.z < 0.0 { compose(at, &[[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]) } else { *at }
}

fn compose(outer: &Affine, inner: &Affine) -> Affine {
    outer.map(|[a, b, c]| {
        let [x, y] = inner;
        [a * x[0] + b * y[0], a * x[1] + b * y[1], a * x[2] + b * y[2] + c]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::LineSegment;

    fn load(name: &str, text: &str, options: &PlanOptions) -> Result<VectorMap, String> {
        let path = std::env::temp_dir().join(format!("apex-dxf-{}-{name}.dxf", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        read(&path, options).map_err(|e| e.message)
    }

    fn drawing(entities: &str) -> String {
        format!("0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n")
    }

    fn line(layer: &str, [ax, ay, bx, by]: [f32; 4]) -> String {
        format!("0\nLINE\n{layer}10\n{ax}\n20\n{ay}\n11\n{bx}\n21\n{by}\n")
    }

    fn all(entities: &str) -> VectorMap {
        load("all", &drawing(entities), &PlanOptions::default()).expect("a plan")
    }

    fn length(map: &VectorMap) -> f32 {
        map.segments().iter().map(|LineSegment { a, b }| (*b - *a).norm()).sum()
    }

    #[test]
    fn layers_are_selected_and_units_are_a_scale() {
        let text =
            drawing(&(line("8\nwalls\n", [0.0, 0.0, 2000.0, 0.0]) + &line("8\ndoors\n", [0.0, 0.0, 0.0, 1000.0])));
        let options =
            |layers: &[&str]| PlanOptions { scale: 0.001, layers: layers.iter().map(|l| (*l).to_owned()).collect() };
        assert_eq!(length(&load("walls", &text, &options(&["Walls"])).expect("one line")), 2.0);
        assert_eq!(length(&load("both", &text, &options(&[])).expect("two lines")), 3.0);
        let error = load("none", &text, &options(&["roof"])).expect_err("no such layer");
        assert_eq!(error, "no line in the layers `roof`; the drawing has `doors`, `walls`");
        assert_eq!(length(&all(&line("", [0.0, 0.0, 3.0, 4.0]))), 5.0, "a line without a layer");
    }

    #[test]
    fn arcs_and_polylines_become_chords() {
        let arc = all("0\nARC\n8\n0\n10\n1\n20\n0\n40\n2\n50\n270\n51\n90\n");
        let half = 2.0 * core::f32::consts::PI;
        assert!((length(&arc) - half).abs() < 0.05, "{}", length(&arc));
        assert!(arc.segments().iter().all(|s| ((s.a - Point2::new(1.0, 0.0)).norm() - 2.0).abs() < 1e-4));
        let bounds = arc.bounds().expect("chords");
        assert!(bounds.0.x > 0.99 && bounds.1.x > 2.98, "it is the right half: {bounds:?}");
        let mirrored = all("0\nARC\n8\n0\n10\n1\n20\n0\n40\n2\n50\n270\n51\n90\n210\n0\n220\n0\n230\n-1\n");
        assert!(mirrored.bounds().expect("chords").0.x < -2.98, "{:?}", mirrored.bounds());
        // Half a circle to the right of the way from the origin to (0, 2), and back along a chord.
        let bulge = all("0\nLWPOLYLINE\n8\n0\n90\n2\n70\n1\n10\n0\n20\n0\n42\n1\n10\n0\n20\n2\n");
        assert!((length(&bulge) - core::f32::consts::PI - 2.0).abs() < 0.05, "{}", length(&bulge));
        assert!(bulge.bounds().expect("chords").1.x > 0.97, "{:?}", bulge.bounds());
        let vertex = |x: f32, y: f32| format!("0\nVERTEX\n8\n0\n10\n{x}\n20\n{y}\n");
        let old = format!(
            "0\nPOLYLINE\n8\n0\n66\n1\n70\n0\n{}{}{}0\nSEQEND\n",
            vertex(0.0, 0.0),
            vertex(1.0, 0.0),
            vertex(1.0, 1.0)
        );
        assert_eq!(length(&all(&old)), 2.0);
    }

    #[test]
    fn blocks_are_placed() {
        let blocks = |entities: &str| {
            format!(
                "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nwindow\n70\n0\n10\n1\n20\n0\n{entities}0\nENDBLK\n0\nENDSEC\n"
            )
        };
        let insert = "0\nINSERT\n8\nwindows\n2\nwindow\n10\n5\n20\n5\n41\n2\n42\n1\n50\n90\n";
        let text = blocks(&line("8\n0\n", [1.0, 0.0, 2.0, 0.0])) + &drawing(insert);
        let options = PlanOptions { layers: vec!["windows".to_owned()], ..PlanOptions::default() };
        let map = load("block", &text, &options).expect("a window");
        let LineSegment { a, b } = map.segments()[0];
        assert!((a - Point2::new(5.0, 5.0)).norm() < 1e-5 && (b - Point2::new(5.0, 7.0)).norm() < 1e-5, "{a:?} {b:?}");
        // A block of itself ends at some depth.
        let endless = blocks(&(line("8\n0\n", [1.0, 0.0, 2.0, 0.0]) + insert)) + &drawing(insert);
        assert!(load("endless", &endless, &PlanOptions::default()).expect("windows").segments().len() <= MAX_DEPTH);
        let many = insert.to_owned() + "70\n3000\n71\n3000\n44\n1\n45\n1\n";
        let error = load("many", &(blocks(&line("", [1.0, 0.0, 2.0, 0.0])) + &drawing(&many)), &PlanOptions::default());
        assert_eq!(error, Err(MapError::TooMany.to_string()));
    }

    #[test]
    fn bad_files_are_refused() {
        let whole = drawing(&line("8\n0\n", [0.0, 0.0, 1.0, 1.0]).repeat(5));
        for length in 0..whole.len() - 5 {
            let error = load("cut", &whole[..length], &PlanOptions::default()).expect_err("it is cut off");
            assert!(error.contains("cut off"), "{length}: {error}");
        }
        let lines = line("8\n0\n", [0.0, 0.0, 1.0, 1.0]).repeat(1_000_000);
        let error = load("million", &drawing(&lines), &PlanOptions::default()).expect_err("a million lines");
        assert_eq!(error, "the file has more than 200000 entities: export only the layers of the walls");
        for (name, text, part) in [
            ("empty", drawing(""), "the drawing is empty"),
            ("text", drawing("0\nTEXT\n8\nnotes\n10\n0\n20\n0\n1\nhello\n"), "no line, only other things in `notes`"),
            ("number", drawing("0\nLINE\n8\n0\n10\nx\n"), "line 10: `x` is not a number"),
            ("far", drawing(&line("8\n0\n", [0.0, 0.0, 1e9, 1.0])), "more than 100 km"),
            ("binary", "AutoCAD Binary DXF\r\n".to_owned(), "binary"),
        ] {
            let error = load(name, &text, &PlanOptions::default()).expect_err(name);
            assert!(error.contains(part), "{name}: {error}");
        }
    }

    /// Random changes of a plan give a plan or an error.
    #[test]
    fn damaged_files_do_not_panic() {
        let mut random = crate::math::Random::new(1);
        let blocks = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nb\n10\n1\n20\n0\n0\nENDBLK\n0\nENDSEC\n";
        let whole = blocks.to_owned()
            + &drawing(
                &(line("8\n0\n", [0.0, 0.0, 1.0, 1.0])
                    + "0\nARC\n8\n0\n40\n2\n0\nINSERT\n2\nb\n70\n2\n0\nLWPOLYLINE\n10\n0\n42\n1\n10\n3\n"),
            );
        for _ in 0..2000 {
            let mut bytes = whole.clone().into_bytes();
            for _ in 0..1 + random.bits() % 3 {
                let at = random.bits() as usize % bytes.len();
                bytes[at] = b"0123456789-.eNI\n"[random.bits() as usize % 16];
            }
            let _ = load("damaged", &String::from_utf8_lossy(&bytes), &PlanOptions::default());
        }
    }
}
