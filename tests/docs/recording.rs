use apex_macros::graph;
use apex_messages::{
    Message, Reason,
    cdr::{Reader, Writer},
    sensor_msgs::Temperature,
    std_msgs::Header,
};
use apex_rt::{
    drive_with,
    prelude::*,
    record::{Recorder, Tap, WhenFull, replay},
};

/// Temperature, in °C.
pub struct Warmth(pub f64);

impl Message for Warmth {
    const NAME: &'static str = Temperature::NAME;
    const DEFINITION: &'static str = Temperature::DEFINITION;

    fn write(&self, message: &mut Writer<'_>) {
        let header = Header::new(Time::ZERO, "stove");
        Temperature { header, temperature: self.0, variance: 0.0 }.write(message);
    }

    fn read(message: &mut Reader<'_>) -> Result<Self, Reason> {
        Temperature::read(message).map(|message| Self(message.temperature))
    }
}

/// A thermometer.
#[node]
pub fn thermometer(ctx: &Ctx) -> Warmth {
    Warmth(20.0 + ctx.now().as_secs_f64())
}

/// Returns `true` if it is too warm.
#[node]
pub fn too_warm(warmth: &Warmth) -> bool {
    warmth.0 > 20.5
}

graph! {
    use apex_nodes::flow::Signal;
    use crate::recording::{thermometer, too_warm};

    robot Stove {
        node warmth = thermometer() every 100ms;
        node warm   = too_warm();

        warmth -> warm -> Signal();

        record "stove.mcap" {
            warm;
        }
    }
}

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::temp_dir().join(format!("stove-{}.mcap", std::process::id()));

    // A robot cannot wait until its file is written; a simulation can.
    let mut tap = Tap::Record(Recorder::to_file::<Stove>(&file, WhenFull::Wait)?);
    drive_with(Stove::new(), SimClock::until(Time::from_secs(1)), &mut tap);
    if let Tap::Record(recorder) = tap {
        let finished = recorder.finish()?;
        assert!(finished.dropped.is_empty());
    }

    let report = replay(Stove::new(), &file, ())?;
    assert!(report.is_same());
    assert_eq!(report.reactions, 10);
    std::fs::remove_file(file)?;
    Ok(())
}
