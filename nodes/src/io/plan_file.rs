#[cfg(feature = "dxf")]
use super::dxf;
use super::{CsvReader, Plan, PlanOptions, ReadError, lines::Ending};
use crate::{map::VectorMap, scan::Point2};
use std::path::Path;

/// Reads a plan: a table of segments (`x1,y1,x2,y2`; `.csv` or `.txt`), or with the feature `dxf` a DXF file. Both may
/// be compressed (`.gz`).
///
/// From a DXF file, it takes `LINE`, `LWPOLYLINE`, `POLYLINE`, `ARC`, `CIRCLE`, `ELLIPSE` and `SPLINE`, and blocks
/// placed with `INSERT`, as seen from above and without the paper space. Curves become chords that deviate by at most
/// 1 cm.
/// Meshes, solids and other things that may be walls are left out and counted in [`Plan::left_out`].
///
/// # Errors
/// If the file cannot be read, is incomplete or too large, or if it has no segment in the selected layers.
pub fn read_plan(path: impl AsRef<Path>, options: &PlanOptions) -> Result<Plan, ReadError> {
    let path = path.as_ref();
    if !(options.scale.is_finite() && options.scale > 0.0) {
        return Err(ReadError::open(path, format_args!("a scale of {} m per unit is not positive", options.scale)));
    }
    match Ending::of(path).name.as_str() {
        "csv" | "txt" => read_table(path, options.scale),
        #[cfg(feature = "dxf")]
        "dxf" => dxf::read(path, options),
        #[cfg(not(feature = "dxf"))]
        "dxf" => Err(ReadError::open(path, "DXF files need the feature `dxf` of `apex-nodes`")),
        _ => Err(ReadError::open(path, "a plan ends in .dxf, .csv or .txt")),
    }
}

fn read_table(path: &Path, scale: f64) -> Result<Plan, ReadError> {
    let mut reader = CsvReader::open(path, false)?;
    let (mut map, mut row) = (VectorMap::default(), Vec::new());
    while reader.read(&mut row)? {
        let [ax, ay, bx, by] = row[..] else {
            return Err(reader.error(format_args!("{} numbers where `x1,y1,x2,y2` are expected", row.len())));
        };
        let point = |x: f64, y: f64| Point2::new((x * scale) as f32, (y * scale) as f32);
        map.add(point(ax, ay), point(bx, by)).map_err(|e| reader.error(e))?;
    }
    if map.segments().is_empty() {
        return Err(ReadError::open(path, "the table has no segment"));
    }
    Ok(Plan { map, ..Plan::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str, scale: f64) -> Result<VectorMap, String> {
        let path = std::env::temp_dir().join(format!("apex-plan-{}-{name}", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        read_plan(&path, &PlanOptions { scale, ..PlanOptions::default() })
            .map(|plan| plan.map)
            .map_err(|e| e.to_string().replace(&path.display().to_string(), name))
    }

    #[test]
    fn a_table_is_a_plan() {
        let map = read("walls.csv", "0,0,1000,0\n1000,0,1000,500\n", 0.001).expect("two walls");
        assert_eq!((map.segments().len(), map.bounds().expect("walls").1), (2, Point2::new(1.0, 0.5)));
    }

    #[test]
    fn what_is_no_plan_is_refused() {
        for (name, text, scale, message) in [
            ("a.csv", "0,0,1,1\n1,2,3\n", 1.0, "a.csv:2: 3 numbers where `x1,y1,x2,y2` are expected"),
            ("b.csv", "", 1.0, "b.csv: the table has no segment"),
            ("c.csv", "0,0,x,1\n", 1.0, "c.csv:1: column 3: `x` is not a number"),
            (
                "d.csv",
                "0,0,,1\n",
                1.0,
                "d.csv:1: a coordinate is not a number or more than 100 km from the origin: \
              move the plan to the origin, or scale it",
            ),
            ("e.csv", "0,0,1,1\n", 0.0, "e.csv: a scale of 0 m per unit is not positive"),
            ("f.csv", "0,0,1,1\n", f64::NAN, "f.csv: a scale of NaN m per unit is not positive"),
            ("g.pdf", "", 1.0, "g.pdf: a plan ends in .dxf, .csv or .txt"),
        ] {
            assert_eq!(read(name, text, scale).expect_err(name), message);
        }
    }
}
