use apex_rt::{
    Observer, Program,
    record::{Channel, Finished, Recorder, Tap, WhenFull},
};
use std::{fmt, path::Path};

/// Recording of a run, if there is one: an observer of the run.
pub struct Recording(Option<Tap>);

impl Recording {
    /// Begins to record a program to a file, without the channels that `leaves_out` names. If the file exists, a number
    /// is added to its name. Without a path nothing is recorded.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn begin<P: Program>(path: Option<&Path>, leaves_out: impl Fn(&Channel) -> bool) -> Result<Self, String> {
        let Some(path) = path else { return Ok(Self(None)) };
        let recorder = Recorder::to_file_without::<P>(path, WhenFull::Wait, leaves_out);
        recorder.map(|recorder| Self(Some(Tap::Record(recorder)))).map_err(|e| cannot(path, &e))
    }

    /// Ends the recording. A file that has not been finished so is not complete.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn finish(self) -> Result<Option<Finished>, String> {
        let Some(Tap::Record(recorder)) = self.0 else { return Ok(None) };
        let path = recorder.path().to_owned();
        recorder.finish().map(Some).map_err(|e| cannot(&path, &e))
    }
}

fn cannot(path: &Path, error: &dyn fmt::Display) -> String {
    format!("cannot record to {}: {error}", path.display())
}

impl Observer for Recording {
    fn tap(&mut self) -> Option<&mut Tap> {
        self.0.as_mut()
    }
}
