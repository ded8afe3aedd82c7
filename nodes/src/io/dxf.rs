//! Plans from DXF files.

use super::{Plan, PlanOptions, ReadError, lines::reader, spline};
use crate::{map::MapError, scan::Point2};
use ::dxf::{
    Drawing, Point, Vector,
    entities::{Ellipse, Entity, EntityType, Insert, Polyline, Spline},
};
use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    f64::consts::TAU,
    io::Read,
    panic,
    path::Path,
};

/// Maximum size of a file, in bytes, and of its text if it is compressed.
const MAX_BYTES: u64 = 256 << 20;
/// Maximum number of entities in a file, so that reading it needs neither minutes nor gigabytes.
const MAX_ENTITIES: usize = 200_000;
/// Maximum nesting of blocks.
const MAX_DEPTH: usize = 8;
/// Maximum deviation of a chord from its arc, in m.
const SAGITTA: f64 = 0.01;

/// Affine map from a block to the plan: x, y and 1 to each coordinate, in m.
type Affine = [[f64; 3]; 2];

pub(super) fn read(path: &Path, options: &PlanOptions) -> Result<Plan, ReadError> {
    let mut bytes = Vec::new();
    reader(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(|e| ReadError::open(path, e))?;
    let selection = Selection::new(options);
    let found = check(&bytes, &selection).map_err(|message| ReadError::open(path, message))?;
    // The parser of the library is not proved to be free of panics.
    let drawing = panic::catch_unwind(|| Drawing::load(&mut &bytes[..]))
        .map_err(|_| ReadError::open(path, "the file is not a valid DXF"))?
        .map_err(|e| ReadError::open(path, format_args!("the file is not a valid DXF: {e}")))?;
    let blocks = drawing.blocks().map(|block| (block.name.as_str(), block)).collect();
    let mut walls = Walls { selection: &selection, blocks, plan: Plan::default(), visited: 0 };
    let scale = options.scale;
    let metres = [[scale, 0.0, 0.0], [0.0, scale, 0.0]];
    drawing
        .entities()
        .try_for_each(|entity| walls.add(entity, &metres, None, 0))
        .map_err(|e| ReadError::open(path, e))?;
    let mut plan = walls.plan;
    if plan.map.segments().is_empty() {
        return Err(ReadError::open(path, found.nothing(options)));
    }
    plan.left_out.extend(found.kinds.into_iter().filter(|(kind, _)| is_unknown_surface(kind)));
    Ok(plan)
}

/// Returns `true` for a type of entities that may be a wall, and that the library does not read.
fn is_unknown_surface(kind: &str) -> bool {
    kind == "MESH" || kind.ends_with("SURFACE")
}

/// Layers that are read.
struct Selection {
    /// Names in lower case; empty for all.
    layers: Vec<String>,
}

impl Selection {
    fn new(options: &PlanOptions) -> Self {
        Self { layers: options.layers.iter().map(|layer| layer.to_lowercase()).collect() }
    }

    fn has(&self, layer: &str) -> bool {
        self.layers.is_empty() || self.layers.contains(&layer.to_lowercase())
    }
}

/// Entities of a file outside of blocks.
#[derive(Default)]
struct Found {
    /// Number of the entities of each type in the selected layers.
    kinds: BTreeMap<String, usize>,
    layers: BTreeSet<String>,
}

impl Found {
    fn add(&mut self, kind: &[u8], layer: &[u8], selection: &Selection) {
        let [kind, layer] = [kind, layer].map(text);
        // Parts of other entities.
        if ["VERTEX", "SEQEND", "ATTRIB"].contains(&&*kind) {
            return;
        }
        if selection.has(&layer) {
            *self.kinds.entry(kind).or_default() += 1;
        }
        self.layers.insert(layer);
    }

    /// Message for a drawing without a segment, with its contents.
    fn nothing(&self, options: &PlanOptions) -> String {
        if self.layers.is_empty() {
            return "the drawing is empty".to_owned();
        }
        let layers: Vec<String> = self.layers.iter().take(20).map(|layer| format!("`{layer}`")).collect();
        let only = if self.kinds.is_empty() { String::new() } else { format!(", only {}", Plan::counts(&self.kinds)) };
        match options.layers.is_empty() {
            true => format!("the drawing has no line{only} in {}", layers.join(", ")),
            false => {
                let wanted = options.layers.join("`, `");
                format!("no line{only} in the layers `{wanted}`; the drawing has {}", layers.join(", "))
            }
        }
    }
}

/// Text in UTF-8, or in the encoding of the first versions.
fn text(bytes: &[u8]) -> String {
    str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(|byte| char::from(*byte)).collect(), str::to_owned)
}

/// Checks the size and the end of a text file before it is parsed, and collects its types and layers.
fn check(bytes: &[u8], selection: &Selection) -> Result<Found, String> {
    if bytes.len() as u64 > MAX_BYTES {
        return Err(format!("the file has more than {} MiB: export only the layers of the walls", MAX_BYTES >> 20));
    }
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err("the file is a binary DXF: export it as text".to_owned());
    }
    const CUT: &str = "the file is cut off or not a DXF: it has no `EOF` at its end";
    if !bytes.trim_ascii_end().ends_with(b"EOF") {
        return Err(CUT.to_owned());
    }
    let mut lines = bytes.split(|b| *b == b'\n').map(<[u8]>::trim_ascii).enumerate();
    let (mut found, mut entities) = (Found::default(), 0);
    let (mut section, mut kind, mut layer) = (&b""[..], &b""[..], &b"0"[..]);
    while let (Some((_, code)), Some((line, value))) = (lines.next(), lines.next()) {
        if code == b"0" && section == b"ENTITIES" && !kind.is_empty() {
            found.add(kind, layer, selection);
        }
        if code == b"0" && value == b"EOF" {
            return Ok(found);
        }
        // The library ends its work at such a place without an error.
        let code: Option<i32> = str::from_utf8(code).ok().and_then(|code| code.parse().ok());
        let Some(code) = code else { return Err(format!("line {line} is not a group code")) };
        let is_number = || str::from_utf8(value).is_ok_and(|value| value.parse::<f64>().is_ok());
        if ((10..60).contains(&code) || (210..240).contains(&code)) && !is_number() {
            return Err(format!("line {}: `{}` is not a number", line + 1, String::from_utf8_lossy(value)));
        }
        match (code, kind) {
            (2, b"SECTION") => (section, kind) = (value, b""),
            (8, _) => layer = value,
            (0, _) if value == b"ENDSEC" => (section, kind) = (b"", b""),
            (0, _) => (kind, layer) = (value, b"0"),
            _ => {}
        }
        entities += usize::from(code == 0);
        if entities > MAX_ENTITIES {
            return Err(format!("the file has more than {MAX_ENTITIES} entities: export only the layers of the walls"));
        }
    }
    Err(CUT.to_owned())
}

/// Reader of the entities.
struct Walls<'a> {
    selection: &'a Selection,
    blocks: HashMap<&'a str, &'a ::dxf::Block>,
    plan: Plan,
    /// Number of entities visited: blocks of blocks may repeat each other without end.
    visited: usize,
}

impl Walls<'_> {
    /// Adds an entity. `layer` is that of the inserted block: it applies to what the block has in layer `0`.
    fn add(&mut self, entity: &Entity, at: &Affine, layer: Option<&str>, depth: usize) -> Result<(), MapError> {
        self.visited += 1;
        if self.visited > 10 * MAX_ENTITIES {
            return Err(MapError::TooMany);
        }
        // A sheet of paper with a frame and views of the drawing.
        if entity.common.is_in_paper_space {
            return Ok(());
        }
        let own = entity.common.layer.as_str();
        let layer = layer.filter(|_| own == "0").unwrap_or(own);
        if let EntityType::Insert(insert) = &entity.specific {
            let at = facing(at, &insert.extrusion_direction, insert.location.z);
            return self.insert(insert, &at, layer, depth);
        }
        if !self.selection.has(layer) {
            return Ok(());
        }
        match &entity.specific {
            EntityType::Line(line) => self.line(at, (line.p1.x, line.p1.y), (line.p2.x, line.p2.y)),
            EntityType::LwPolyline(line) => {
                let vertices: Vec<_> = line.vertices.iter().map(|v| (v.x, v.y, v.bulge)).collect();
                let at = facing(at, &line.extrusion_direction, entity.common.elevation);
                self.polyline(&at, &vertices, line.is_closed())
            }
            EntityType::Polyline(line) if !(line.is_3d_polygon_mesh() || line.is_polyface_mesh()) => {
                self.old_polyline(at, line)
            }
            EntityType::Arc(arc) => {
                let (from, to) = (arc.start_angle.to_radians(), arc.end_angle.to_radians());
                let at = facing(at, &arc.normal, arc.center.z);
                self.arc(&at, (arc.center.x, arc.center.y), arc.radius, from, turn(from, to))
            }
            EntityType::Circle(circle) => {
                let at = facing(at, &circle.normal, circle.center.z);
                self.arc(&at, (circle.center.x, circle.center.y), circle.radius, 0.0, TAU)
            }
            EntityType::Ellipse(ellipse) => self.ellipse(at, ellipse),
            EntityType::Spline(spline) => self.spline(at, spline),
            other => {
                if let Some(kind) = surface(other) {
                    self.leave_out(kind);
                }
                Ok(())
            }
        }
    }

    fn leave_out(&mut self, kind: &str) {
        *self.plan.left_out.entry(kind.to_owned()).or_default() += 1;
    }

    fn line(&mut self, at: &Affine, a: (f64, f64), b: (f64, f64)) -> Result<(), MapError> {
        let place = |(x, y): (f64, f64)| {
            let [x, y] = at.map(|row| row[0] * x + row[1] * y + row[2]);
            Point2::new(x as f32, y as f32)
        };
        self.plan.map.add(place(a), place(b))
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

    fn old_polyline(&mut self, at: &Affine, line: &Polyline) -> Result<(), MapError> {
        // Control points of a curve, of which the file has the chords, too.
        let vertices = line.vertices().filter(|v| !v.is_spline_frame_control_point());
        let vertices: Vec<_> = vertices.map(|v| (v.location.x, v.location.y, v.bulge)).collect();
        let at = if line.is_3d_polyline() { *at } else { facing(at, &line.normal, line.location.z) };
        self.polyline(&at, &vertices, line.is_closed())
    }

    /// Adds chords of an ellipse, which is the affine image of a circle.
    fn ellipse(&mut self, at: &Affine, ellipse: &Ellipse) -> Result<(), MapError> {
        let Ellipse { center, major_axis: major, minor_axis_ratio: ratio, .. } = ellipse;
        let normal = &ellipse.normal;
        let minor_x = ratio * (normal.y * major.z - normal.z * major.y);
        let minor_y = ratio * (normal.z * major.x - normal.x * major.z);
        let at = compose(at, &[[major.x, minor_x, center.x], [major.y, minor_y, center.y]]);
        let (from, to) = (ellipse.start_parameter, ellipse.end_parameter);
        self.arc(&at, (0.0, 0.0), 1.0, from, turn(from, to))
    }

    /// Adds chords of a spline; one that has only points through which it goes becomes straight lines between them.
    fn spline(&mut self, at: &Affine, spline: &Spline) -> Result<(), MapError> {
        let plane = |points: &[Point]| points.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
        let (control, fitted) = (plane(&spline.control_points), plane(&spline.fit_points));
        let degree = usize::try_from(spline.degree_of_curve).unwrap_or(0);
        let mut last: Option<[f64; 2]> = None;
        let mut add = |[x, y]: [f64; 2]| {
            let before = last.replace([x, y]);
            before.map_or(Ok(()), |[a, b]| self.line(at, (a, b), (x, y)))
        };
        match spline::Spline::new(degree, &spline.knot_values, &control, &spline.weight_values) {
            Some(curve) => curve.chords(SAGITTA / size(at), add),
            None if fitted.len() > 1 => fitted.into_iter().try_for_each(&mut add),
            None => {
                self.leave_out("SPLINE");
                Ok(())
            }
        }
    }

    /// Adds chords of the arc of `turn` rad that begins in the direction `from`.
    fn arc(&mut self, at: &Affine, (x, y): (f64, f64), radius: f64, from: f64, turn: f64) -> Result<(), MapError> {
        let size = radius.abs() * size(at);
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
        let Some(block) = self.blocks.get(insert.name.as_str()).copied() else {
            if self.selection.has(layer) {
                self.leave_out("INSERT of a block that the file does not have");
            }
            return Ok(());
        };
        // An array of nothing may have a billion places.
        if depth >= MAX_DEPTH || block.entities.is_empty() {
            return Ok(());
        }
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

/// Name of an entity that may be a wall, and is not read.
fn surface(entity: &EntityType) -> Option<&'static str> {
    Some(match entity {
        EntityType::Face3D(_) => "3DFACE",
        EntityType::Solid3D(_) => "3DSOLID",
        EntityType::ProxyEntity(_) => "ACAD_PROXY_ENTITY",
        EntityType::Body(_) => "BODY",
        EntityType::Helix(_) => "HELIX",
        EntityType::MLine(_) => "MLINE",
        EntityType::Polyline(_) => "POLYLINE of a mesh",
        EntityType::Region(_) => "REGION",
        EntityType::Solid(_) => "SOLID",
        EntityType::Trace(_) => "TRACE",
        _ => return None,
    })
}

/// Angle of an arc between two directions, in rad; a whole turn if they are the same.
fn turn(from: f64, to: f64) -> f64 {
    let turn = (to - from).rem_euclid(TAU);
    if turn == 0.0 { TAU } else { turn }
}

/// Largest scale of a map.
fn size(at: &Affine) -> f64 {
    at[0][0].hypot(at[1][0]).max(at[0][1].hypot(at[1][1]))
}

/// Map of an entity in a plane of its own, with its height in it, by the arbitrary axis algorithm of DXF. A plane that
/// is seen from below is mirrored, as a CAD program leaves it after its command to mirror.
fn facing(at: &Affine, normal: &Vector, height: f64) -> Affine {
    let length = normal.x.hypot(normal.y).hypot(normal.z);
    if length == 0.0 || !length.is_finite() {
        return *at;
    }
    let [x, y, z] = [normal.x / length, normal.y / length, normal.z / length];
    // The first axis is at right angles to y or, of steep planes, to z.
    let is_flat = x.abs() < 1.0 / 64.0 && y.abs() < 1.0 / 64.0;
    let (across, size) = if is_flat { ([z, 0.0, -x], z.hypot(x)) } else { ([-y, x, 0.0], x.hypot(y)) };
    let [ax, ay, az] = across.map(|value| value / size);
    compose(at, &[[ax, y * az - z * ay, height * x], [ay, z * ax - x * az, height * y]])
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
    use crate::map::{LineSegment, VectorMap};

    fn load(name: &str, text: &str, options: &PlanOptions) -> Result<VectorMap, String> {
        whole(name, text, options).map(|plan| plan.map)
    }

    fn whole(name: &str, text: &str, options: &PlanOptions) -> Result<Plan, String> {
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

    /// Section with a block `window`, whose origin is (1, 0).
    fn blocks(entities: &str) -> String {
        format!(
            "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n8\n0\n2\nwindow\n70\n0\n10\n1\n20\n0\n{entities}0\nENDBLK\n0\nENDSEC\n"
        )
    }

    #[test]
    fn sheets_of_paper_are_not_walls() {
        let wall = line("8\nwalls\n", [0.0, 0.0, 1.0, 0.0]);
        let frame = "0\nINSERT\n67\n1\n8\nsheet\n2\nwindow\n10\n0\n20\n0\n";
        let text = blocks(&line("8\n0\n", [1.0, 0.0, 9.0, 0.0]))
            + &drawing(&(wall + frame + &line("67\n1\n8\nsheet\n", [0.0, 5.0, 9.0, 5.0])));
        assert_eq!(length(&load("sheet", &text, &PlanOptions::default()).expect("a wall")), 1.0);
    }

    #[test]
    fn ellipses_and_splines_become_chords() {
        // The upper half of an ellipse about (2, 0), 4 m long and 2 m wide; Ramanujan's circumference is 9.6884 m.
        let ellipse = "0\nELLIPSE\n8\n0\n10\n2\n20\n0\n11\n2\n21\n0\n40\n0.5\n41\n0\n42\n3.14159265\n";
        let map = all(ellipse);
        assert!((length(&map) - 4.844).abs() < 0.02, "{}", length(&map));
        let (low, high) = map.bounds().expect("chords");
        assert!(low.x.abs() < 0.01 && low.y.abs() < 0.01 && (high.y - 1.0).abs() < 0.01, "{low:?} {high:?}");
        assert!((length(&all(&ellipse.replace("3.14159265", "6.283185307179586"))) - 9.688).abs() < 0.04);
        let below = all(&(ellipse.to_owned() + "210\n0\n220\n0\n230\n-1\n"));
        assert!(below.bounds().expect("chords").0.y < -0.99, "{:?}", below.bounds());
        // A quarter of a circle as a parabola through the same ends.
        let knots: String = [0, 0, 0, 1, 1, 1].iter().map(|knot| format!("40\n{knot}\n")).collect();
        let control = |code: i32| {
            let point = |(x, y)| format!("{code}\n{x}\n{}\n{y}\n{}\n0\n", code + 10, code + 20);
            [(1, 0), (1, 1), (0, 1)].map(point).concat()
        };
        let spline = format!("0\nSPLINE\n8\n0\n70\n8\n71\n2\n72\n6\n73\n3\n74\n0\n{knots}{}", control(10));
        let map = all(&spline);
        assert!((length(&map) - 1.623).abs() < 0.01 && map.segments().len() > 2, "{}", length(&map));
        let fitted = format!("0\nSPLINE\n8\n0\n70\n8\n71\n3\n74\n3\n{}", control(11));
        assert_eq!(length(&all(&fitted)), 2.0);
        // A spline and a circle of which the numbers are odd.
        let odd = spline.replace("71\n2\n", "71\n7\n") + &line("8\n0\n", [0.0, 0.0, 1.0, 0.0]);
        let plan = whole("odd", &drawing(&odd), &PlanOptions::default()).expect("a line");
        assert_eq!((length(&plan.map), plan.left_out["SPLINE"]), (1.0, 1));
        let circle = length(&all("0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n-1\n"));
        assert!((circle - core::f32::consts::TAU).abs() < 0.05, "{circle}");
        let turn = length(&all("0\nARC\n8\n0\n10\n0\n20\n0\n40\n1\n50\n0\n51\n360\n"));
        assert!((turn - core::f32::consts::TAU).abs() < 0.05, "{turn}");
    }

    #[test]
    fn what_may_be_a_wall_and_is_not_read_is_named() {
        let vertex = |flags: i32| format!("0\nVERTEX\n8\nmesh\n10\n5{flags}\n20\n50\n30\n0\n70\n{flags}\n");
        let mesh = |flags: i32| {
            let vertices = vertex(flags) + &vertex(flags + 1);
            format!("0\nPOLYLINE\n8\nmesh\n66\n1\n70\n{flags}\n71\n3\n72\n1\n{vertices}0\nSEQEND\n")
        };
        let other = "0\nMESH\n8\nmesh\n0\nSOLID\n8\nother\n0\nTEXT\n8\nmesh\n0\nINSERT\n8\nmesh\n2\nxref\n";
        let text = drawing(&(line("8\nmesh\n", [0.0, 0.0, 1.0, 0.0]) + &mesh(64) + &mesh(16) + other));
        let plan = whole("mesh", &text, &PlanOptions::of_layers("MESH", 1.0)).expect("a line");
        assert_eq!(plan.map.segments().len(), 1);
        let note = plan.note().expect("a note");
        assert_eq!(
            note,
            "left out: 1 `INSERT of a block that the file does not have`, 1 `MESH`, 2 `POLYLINE of a mesh`"
        );
        let all = whole("mesh", &text, &PlanOptions::default()).expect("a line");
        assert_eq!(all.left_out["SOLID"], 1);
    }

    #[test]
    fn planes_may_have_any_direction() {
        // A rectangle that stands on the y axis: by the arbitrary axis algorithm, its x axis is that of y.
        let upright = "0\nLWPOLYLINE\n8\n0\n90\n3\n70\n0\n38\n5\n10\n1\n20\n0\n10\n3\n20\n0\n10\n3\n20\n7\n210\n1\n220\n0\n230\n0\n";
        let (low, high) = all(upright).bounds().expect("a wall");
        let is_at = |p: Point2, x: f32, y: f32| (p - Point2::new(x, y)).norm() < 1e-5;
        assert!(is_at(low, 5.0, 1.0) && is_at(high, 5.0, 3.0), "{low:?} {high:?}");
        // Half of a quarter turn about the x axis: y is shorter, and the circle an ellipse.
        let tilted = "0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n1\n210\n0\n220\n1\n230\n1\n";
        let (low, high) = all(tilted).bounds().expect("a wall");
        assert!((high.x - 1.0).abs() < 0.01 && (high.y - 0.5_f32.sqrt()).abs() < 0.01, "{low:?} {high:?}");
        let none = all("0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n1\n210\n0\n220\n0\n230\n0\n");
        assert!((length(&none) - core::f32::consts::TAU).abs() < 0.05);
    }

    #[test]
    fn names_of_layers_and_files_have_any_case() {
        let header = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1021\n0\nENDSEC\n";
        let text = header.to_owned() + &drawing(&line("8\nWÄNDE\n", [0.0, 0.0, 1.0, 0.0]));
        assert!(load("case", &text, &PlanOptions::of_layers("wände", 1.0)).is_ok());
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        std::io::Write::write_all(&mut packer, text.as_bytes()).expect("memory");
        let path = std::env::temp_dir().join(format!("apex-dxf-{}-packed.DXF.GZ", std::process::id()));
        std::fs::write(&path, packer.finish().expect("memory")).expect("a temporary file");
        assert_eq!(super::super::read_plan(path, &PlanOptions::default()).expect("a plan").map.segments().len(), 1);
    }

    #[test]
    fn arrays_of_nothing_take_no_time() {
        let array = "0\nINSERT\n8\n0\n2\nwindow\n10\n0\n20\n0\n70\n32767\n71\n32767\n".repeat(20);
        let text = blocks("") + &drawing(&(line("8\n0\n", [0.0, 0.0, 1.0, 0.0]) + &array));
        assert_eq!(load("nothing", &text, &PlanOptions::default()).expect("a line").segments().len(), 1);
        // An array of blocks without a line ends, too.
        let text = blocks("0\nTEXT\n8\n0\n1\na\n") + &drawing(&array);
        assert_eq!(load("texts", &text, &PlanOptions::default()), Err(MapError::TooMany.to_string()));
    }

    #[test]
    fn blocks_are_placed() {
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
            ("text", drawing("0\nTEXT\n8\nnotes\n10\n0\n20\n0\n1\nhello\n"), "no line, only 1 `TEXT` in `notes`"),
            ("hatch", drawing(&"0\nHATCH\n8\na\n0\nMESH\n8\nb\n".repeat(2)), "only 2 `HATCH`, 2 `MESH` in `a`, `b`"),
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
