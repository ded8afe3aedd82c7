use super::{
    ReadError,
    lines::{Lines, shown},
};
use apex_rt::{Event, Out, node};
use std::path::Path;

/// Reads rows of numbers from a comma-separated file (`.csv`, `.csv.gz`).
///
/// An empty cell is NaN. Quotes are not supported, as the format is for tables of numbers.
#[derive(Debug)]
pub struct CsvReader {
    lines: Lines,
}

impl CsvReader {
    /// Opens a file. With `header`, its first line is skipped.
    ///
    /// # Errors
    /// If the file cannot be opened, or its header cannot be read.
    pub fn open(path: impl AsRef<Path>, header: bool) -> Result<Self, ReadError> {
        let mut lines = Lines::open(path.as_ref())?;
        if header {
            lines.next()?;
        }
        Ok(Self { lines })
    }

    /// Replaces `row` by the next one. Returns `false` at the end of the file.
    ///
    /// # Errors
    /// If a cell is not a number, or the file cannot be read further. The next call continues after the error.
    pub fn read(&mut self, row: &mut Vec<f64>) -> Result<bool, ReadError> {
        row.clear();
        if self.lines.next()?.is_none() {
            return Ok(false);
        }
        for (column, cell) in self.lines.current().split(',').map(str::trim).enumerate() {
            match cell.parse() {
                Ok(number) => row.push(number),
                Err(_) if cell.is_empty() => row.push(f64::NAN),
                Err(_) => {
                    let cell = shown(cell);
                    return Err(self.lines.error(format_args!("column {}: `{cell}` is not a number", column + 1)));
                }
            }
        }
        Ok(true)
    }

    /// Creates an error at the last row.
    pub(super) fn error(&self, message: impl std::fmt::Display) -> ReadError {
        self.lines.error(message)
    }
}

/// Sends the rows of a comma-separated file of numbers, one per firing (see [`CsvReader`]). After the last row it
/// triggers `done` and sends ⊥.
#[node]
#[derive(Debug)]
pub struct CsvLog {
    /// Path of the file.
    #[param]
    path: &'static str,
    /// `true` if the first line is a header.
    #[param(default = false)]
    header: bool,
    reader: Option<CsvReader>,
    finished: bool,
}

#[node]
impl CsvLog {
    fn process(&mut self, row: &mut Out<Vec<f64>>, done: Event<()>) -> Result<(), ReadError> {
        if self.finished {
            return Ok(());
        }
        let reader = match &mut self.reader {
            Some(reader) => reader,
            None => {
                self.finished = true;
                let reader = self.reader.insert(CsvReader::open(self.path, self.header)?);
                self.finished = false;
                reader
            }
        };
        let read = reader.read(row.get_mut());
        if !matches!(read, Ok(true)) {
            row.clear();
        }
        self.finished = !read?;
        if self.finished {
            done.emit(());
        }
        Ok(())
    }

    /// Returns `true` if all rows have been sent, or if the file could not be opened.
    pub fn finished(&self) -> bool {
        self.finished
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::Construct;

    fn file(name: &str, text: &str) -> &'static str {
        let path = std::env::temp_dir().join(format!("apex-csv-{}-{name}", std::process::id()));
        std::fs::write(&path, text).expect("a temporary file");
        path.to_str().expect("a readable path").to_owned().leak()
    }

    #[test]
    fn rows_one_by_one_then_bottom() {
        let path = file("rows.csv", "a,b\n1,2\n\n 3 , \n");
        let mut node = CsvLog::construct((path, true));
        let mut out = Out::new();
        node.process(&mut out, Event::unconnected()).expect("row 1");
        assert_eq!(out.get(), Some(&vec![1.0, 2.0]));
        node.process(&mut out, Event::unconnected()).expect("row 2");
        let row = out.get().expect("a row");
        assert!(row[0] == 3.0 && row[1].is_nan() && !node.finished());
        let mut done = None;
        node.process(&mut out, apex_rt::event(&mut done)).expect("the end");
        assert!(out.get().is_none() && node.finished() && done.is_some());
    }

    #[test]
    fn a_bad_cell_is_an_error_with_its_place_and_reading_goes_on() {
        let path = file("bad.csv", "1,2\n3,x\n5,6\n");
        let mut reader = CsvReader::open(path, false).expect("the file");
        let mut row = Vec::new();
        assert_eq!(reader.read(&mut row), Ok(true));
        let error = reader.read(&mut row).expect_err("a bad cell");
        assert_eq!((error.line, error.message.as_str()), (Some(2), "column 2: `x` is not a number"));
        assert_eq!((reader.read(&mut row), row.as_slice()), (Ok(true), &[5.0, 6.0][..]));
        assert_eq!(reader.read(&mut row), Ok(false));
    }

    #[test]
    fn the_tables_of_office_programs_are_read() {
        for (name, text) in [
            ("mark.csv", "\u{feff}1,2\r\n3,4\r\n"),
            ("header.csv", "\u{feff}\u{e4},b\n1,2\n3,4\n"),
            ("mac.csv", "1,2\r3,4\r"),
        ] {
            let mut reader = CsvReader::open(file(name, text), name == "header.csv").expect("the file");
            let (mut row, mut rows) = (Vec::new(), Vec::new());
            while reader.read(&mut row).expect("numbers") {
                rows.push(row.clone());
            }
            assert_eq!(rows, [[1.0, 2.0], [3.0, 4.0]], "{name}");
        }
    }

    #[test]
    fn a_missing_file_fails_once() {
        let mut node = CsvLog::construct(("/nowhere/at-all.csv", false));
        let mut out = Out::new();
        let error = node.process(&mut out, Event::unconnected()).expect_err("no such file");
        assert!(error.line.is_none() && error.to_string().starts_with("/nowhere/at-all.csv: "));
        assert!(node.finished());
        assert_eq!(node.process(&mut out, Event::unconnected()), Ok(()));
    }
}
