use apex_nodes::localize::{Settings, TableSettings};
use apex_sim::Building;
use std::{num::NonZero, path::PathBuf, str::FromStr};

const HELP: &str = "\
Measures the localization on plans.

Usage: localize MAP LOG...  [OPTIONS]    on recordings; MAP is .dxf, .csv (x1,y1,x2,y2) or .pgm
       localize --building  [OPTIONS]    in a simulated building with furniture: starts anywhere, and kidnappings
       localize --speed     [OPTIONS]    computing time of an update
       localize --draw FILE [OPTIONS]    picture of a start anywhere in the building

  --plan FILE        building in place of the project's own one
  --scale M          length of a unit of the map in m (1)
  --layers A,B       layers of a DXF map (all)
  --pixel M or X,Y   size of a pixel of a .pgm map in m, the same in x and y or not (0.05)
  --origin X,Y       lower left corner of a .pgm map in m (0,0)
  --cell M           side of a cell of the look-up table in m (0.5)
  --reach M          maximum distance of the walls that are looked up in m (30)
  --furniture N      tries to place furniture in the building (300)
  --first-seed N     first seed (1)
  --seeds N          number of seeds (5)
  --jobs N           threads (all cores); the table does not depend on it
  --set NAME=VALUE   setting of the filter: beams, sigma, hit, short, short-range, trust, slip, veer, skid, min, max,
                     divergence, travel, turn, search-sigma, search-trust, positions, certain, agreement
  --trace            one line per used scan
";

/// Measurement.
pub enum Task {
    Logs { map: PathBuf, logs: Vec<PathBuf> },
    Building { plan: PathBuf },
    Speed { plan: PathBuf },
    Draw { plan: PathBuf, file: PathBuf },
}

pub struct Options {
    pub task: Task,
    pub scale: f64,
    pub layers: Vec<String>,
    pub pixel: (f32, f32),
    pub origin: (f32, f32),
    pub furniture: usize,
    pub first_seed: u64,
    pub seeds: u64,
    pub jobs: Option<NonZero<usize>>,
    pub settings: Settings,
    pub table: TableSettings,
    pub trace: bool,
}

/// File into which the project's own plan is written.
const OFFICE: &str = "out/building.dxf";

impl Options {
    pub fn read() -> Result<Self, String> {
        use lexopt::prelude::*;
        let mut parser = lexopt::Parser::from_env();
        let (mut files, mut plan, mut task) = (Vec::new(), None, None);
        let (mut options, mut picture) = (Self::standard(), None);
        while let Some(argument) = parser.next().map_err(|e| e.to_string())? {
            match argument {
                Long("help") | Short('h') => {
                    print!("{HELP}");
                    std::process::exit(0);
                }
                Value(file) => files.push(PathBuf::from(file)),
                Long("building") => task = Some("building"),
                Long("speed") => task = Some("speed"),
                Long("trace") => options.trace = true,
                Long("draw") => picture = Some(PathBuf::from(parser.value().map_err(|e| e.to_string())?)),
                Long("plan") => plan = Some(PathBuf::from(parser.value().map_err(|e| e.to_string())?)),
                Long(name) => {
                    let name = name.to_owned();
                    let value = parser.value().map_err(|e| e.to_string())?;
                    let value = value.into_string().map_err(|_| format!("`--{name}` is no text"))?;
                    options.take(&name, &value)?;
                }
                other => return Err(format!("{}; `--help` lists the options", other.unexpected())),
            }
        }
        let plan = || match plan {
            Some(plan) => Ok(plan),
            None => Building::office(OFFICE).map(|_| PathBuf::from(OFFICE)).map_err(|e| e.to_string()),
        };
        options.task = match (task, picture) {
            (_, Some(file)) => Task::Draw { plan: plan()?, file },
            (Some("building"), _) => Task::Building { plan: plan()? },
            (Some(_), _) => Task::Speed { plan: plan()? },
            _ if files.len() > 1 => Task::Logs { map: files.remove(0), logs: files },
            _ => return Err("a map and a recording are needed; `--help` lists the options".to_owned()),
        };
        Ok(options)
    }

    fn standard() -> Self {
        Self {
            task: Task::Building { plan: PathBuf::new() },
            scale: 1.0,
            layers: Vec::new(),
            pixel: (0.05, 0.05),
            origin: (0.0, 0.0),
            furniture: 300,
            first_seed: 1,
            seeds: 5,
            jobs: None,
            settings: Settings::default(),
            table: TableSettings::default(),
            trace: false,
        }
    }

    fn take(&mut self, name: &str, value: &str) -> Result<(), String> {
        match name {
            "scale" => self.scale = number(name, value)?,
            "layers" => self.layers = value.split(',').map(|layer| layer.trim().to_owned()).collect(),
            "pixel" => self.pixel = pair(name, value.split_once(',').unwrap_or((value, value)))?,
            "origin" => self.origin = pair(name, value.split_once(',').ok_or("`--origin` is X,Y")?)?,
            "furniture" => self.furniture = number(name, value)?,
            "cell" => self.table.cell = number(name, value)?,
            "reach" => self.table.reach = number(name, value)?,
            "first-seed" => self.first_seed = number(name, value)?,
            "seeds" => self.seeds = number(name, value)?,
            "jobs" => self.jobs = Some(number(name, value)?),
            "set" => {
                let (name, value) = value.split_once('=').ok_or("`--set` is NAME=VALUE")?;
                set(&mut self.settings, name, value)?;
            }
            _ => return Err(format!("`--{name}` is no option; `--help` lists the options")),
        }
        Ok(())
    }
}

fn pair(name: &str, (x, y): (&str, &str)) -> Result<(f32, f32), String> {
    Ok((number(name, x)?, number(name, y)?))
}

fn number<T: FromStr>(name: &str, value: &str) -> Result<T, String> {
    value.parse().map_err(|_| format!("`{name}`: `{value}` is no valid number"))
}

fn set(settings: &mut Settings, name: &str, value: &str) -> Result<(), String> {
    let f = || number::<f32>(name, value);
    match name {
        "beams" => settings.beams = number(name, value)?,
        "min" => settings.particles[0] = number(name, value)?,
        "max" => settings.particles[1] = number(name, value)?,
        "positions" => settings.positions = number(name, value)?,
        "sigma" => settings.model.sigma = f()?,
        "hit" => settings.model.hit = f()?,
        "short" => settings.model.short = f()?,
        "short-range" => settings.model.short_range = f()?,
        "trust" => settings.trust = f()?,
        "slip" => settings.motion.slip = f()?,
        "veer" => settings.motion.veer = f()?,
        "skid" => settings.motion.skid = f()?,
        "divergence" => settings.divergence = f()?,
        "travel" => settings.travel = f()?,
        "turn" => settings.turn = f()?,
        "search-sigma" => settings.search.sigma = f()?,
        "search-trust" => settings.search.trust = f()?,
        "certain" => settings.certain = f()?,
        "agreement" => settings.agreement = f()?,
        _ => return Err(format!("`{name}` is no setting; `--help` lists them")),
    }
    Ok(())
}
