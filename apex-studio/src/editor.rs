//! The source files on a page: their texts, what the language server says about them, and their changes.

use crate::{
    language::{Language, Place, Said},
    picture::Picture,
    source::Source,
};
use apex_ide::{Paint, paint, statement};
use serde::Serialize;
use serde_json::Value;
use std::{
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

/// Interval between looks at the files.
const LOOK: Duration = Duration::from_millis(700);
/// Maximum number of completions that a page gets.
const MAX_COMPLETIONS: usize = 200;

/// A message to the page about source files.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Written {
    /// Files that have changed on the disk, with their texts.
    Disk(Vec<(usize, String)>),
    /// Colours of a text of the page: the length of each piece in UTF-16 code units, and its kind.
    Paint { file: usize, version: u32, pieces: Vec<(usize, u8)> },
    /// Errors and warnings in the newest text of a file.
    Found { file: usize, found: Vec<Found> },
    /// Description of what is at a place; empty for nothing.
    Hover { place: Place, text: String },
    /// Completions at a place.
    Completions { place: Place, items: Vec<Completion> },
    /// A text was saved, or the reason why not; `changed` if the file has another text by now.
    Kept { file: usize, error: Option<String>, changed: bool },
}

/// An error or a warning in a text. Lines and columns are from 0, in UTF-16 code units.
#[derive(Debug, Serialize)]
pub struct Found {
    from: (u64, u64),
    to: (u64, u64),
    is_error: bool,
    text: String,
    /// Nodes and connections of the picture that it concerns.
    concerns: Vec<Concern>,
}

/// A node, or a chain of connected ones, in one of the graphs of the picture.
#[derive(Debug, PartialEq, Eq, Serialize)]
pub struct Concern {
    /// Full name of the graph; empty for the whole.
    pub within: String,
    /// Names of the nodes, or of ports of the graph.
    pub names: Vec<String>,
    /// `true` for the connections between them.
    pub connects: bool,
}

/// A completion: what it replaces, and by what.
#[derive(Serialize)]
pub struct Completion {
    label: String,
    detail: String,
    docs: String,
    from: (u64, u64),
    to: (u64, u64),
    text: String,
    /// An import that it needs: its line, and its text.
    import: Option<(u64, String)>,
}

/// The source files on a page.
pub struct Editor {
    source: Arc<dyn Source>,
    files: Vec<File>,
    language: Option<Language>,
    looked: Instant,
}

/// A source file.
struct File {
    name: String,
    /// Its path if it may be changed.
    path: Option<PathBuf>,
    /// The text on the disk, as the page knows it.
    disk: String,
    /// The text on the page, if it is another one.
    text: Option<String>,
}

impl Editor {
    pub fn new(source: Arc<dyn Source>) -> Self {
        Self { source, files: vec![], language: None, looked: Instant::now() }
    }

    /// Begins with the source files of a robot. Returns their texts, and which of them may be changed.
    pub fn begin(&mut self, files: &[String]) -> (Vec<String>, Vec<bool>) {
        let texts = self.source.texts(files);
        let is_same = files.iter().eq(self.files.iter().map(|file| &file.name));
        let files = files.iter().zip(&texts).enumerate().map(|(at, (name, text))| File {
            name: name.clone(),
            path: self.source.path(name),
            disk: text.clone(),
            text: if is_same { self.files[at].text.take() } else { None },
        });
        self.files = files.collect();
        if !is_same {
            self.language = None;
        }
        (texts, self.files.iter().map(|file| file.path.is_some()).collect())
    }

    /// Colours of the text on the disk, if the page has that.
    pub fn colours(&self, file: usize, version: u32, text: &str) -> Option<Written> {
        let of = self.files.get(file).filter(|of| of.disk == text)?;
        Some(Written::Paint { file, version, pieces: of.pieces(text) })
    }

    /// Takes note of a text of the page. Returns its colours.
    pub fn edit(&mut self, file: usize, version: u32, text: String) -> Option<Written> {
        let of = self.files.get_mut(file)?;
        let pieces = of.pieces(&text);
        of.text = Some(text);
        self.tell(file);
        Some(Written::Paint { file, version, pieces })
    }

    /// Asks for a description of what is at a place.
    pub fn hover(&mut self, place: Place) {
        self.language.iter_mut().for_each(|language| language.hover(place));
    }

    /// Asks for completions at a place.
    pub fn complete(&mut self, place: Place) {
        self.language.iter_mut().for_each(|language| language.complete(place));
    }

    /// Saves a text, unless the file was changed by others meanwhile; `over` overwrites that.
    pub fn keep(&mut self, file: usize, text: &str, over: bool) -> Written {
        let changed = self.files.get(file).is_some_and(|of| {
            let now = self.source.texts(std::slice::from_ref(&of.name)).pop().unwrap_or_default();
            now != of.disk && now != text
        });
        if changed && !over {
            let error = Some("the file was changed on the disk meanwhile".to_owned());
            return Written::Kept { file, error, changed };
        }
        let Some(of) = self.files.get_mut(file).filter(|of| of.path.is_some()) else {
            let error = Some("this file does not belong to the package of the robot".to_owned());
            return Written::Kept { file, error, changed: false };
        };
        let written = self.source.write_text(&of.name, text);
        if written.is_ok() {
            text.clone_into(&mut of.disk);
            of.text = Some(text.to_owned());
            self.language.iter_mut().for_each(|language| language.saved(file));
        }
        Written::Kept { file, error: written.err(), changed: false }
    }

    /// Lets all files be checked, so that the errors have places.
    pub fn check(&mut self) {
        (0..self.files.len()).for_each(|file| self.tell(file));
    }

    /// All that has happened since the last call.
    pub fn news(&mut self, picture: Option<&Picture>) -> Vec<Written> {
        let mut news = vec![];
        if self.looked.elapsed() > LOOK {
            self.looked = Instant::now();
            let changed = self.changed();
            if !changed.is_empty() {
                news.push(Written::Disk(changed));
            }
        }
        let said = self.language.iter_mut().flat_map(Language::said).collect::<Vec<_>>();
        news.extend(said.into_iter().map(|said| match said {
            Said::Diagnostics(file, found) => {
                let text = self.files.get(file).map_or("", File::now);
                Written::Found { file, found: found.iter().map(|one| Found::new(one, text, picture)).collect() }
            }
            Said::Hover(place, text) => Written::Hover { place, text },
            Said::Completions(place, items) => {
                let mut items: Vec<&Value> = items.iter().collect();
                items.sort_by_key(|item| item["sortText"].as_str().unwrap_or_default());
                let items = items.into_iter().take(MAX_COMPLETIONS).filter_map(Completion::new).collect();
                Written::Completions { place, items }
            }
        }));
        news
    }

    /// Files whose texts on the disk have changed.
    fn changed(&mut self) -> Vec<(usize, String)> {
        let names: Vec<String> = self.files.iter().map(|file| file.name.clone()).collect();
        let texts = self.source.texts(&names);
        let mut changed = vec![];
        for (at, text) in texts.into_iter().enumerate().filter(|(_, text)| !text.is_empty()) {
            let file = &mut self.files[at];
            if file.disk == text {
                continue;
            }
            if file.text.as_ref().is_none_or(|own| *own == file.disk) {
                file.text = file.text.take().map(|_| text.clone());
            }
            file.disk.clone_from(&text);
            changed.push((at, text));
        }
        if self.language.is_some() {
            changed.iter().for_each(|(at, _)| self.tell(*at));
        }
        changed
    }

    /// Tells the language server the newest text of a file, if it is one for it.
    fn tell(&mut self, file: usize) {
        let Some(of) = self.files.get(file).filter(|of| is_source(&of.name)) else { return };
        let Some(uri) = of.path.as_deref().and_then(apex_lsp::from_path) else { return };
        if self.language.is_none() {
            // Without one, the text can still be edited and saved.
            self.language = Language::start().ok();
        }
        if let Some(language) = &mut self.language {
            language.text(file, uri.as_str(), of.now());
        }
    }
}

impl File {
    fn pieces(&self, text: &str) -> Vec<(usize, u8)> {
        if is_source(&self.name) { painted(text) } else { vec![(text.encode_utf16().count(), 0)] }
    }

    /// The newest text.
    fn now(&self) -> &str {
        self.text.as_ref().unwrap_or(&self.disk)
    }
}

fn is_source(name: &str) -> bool {
    name.ends_with(".afg")
}

/// Colours of a text.
fn painted(text: &str) -> Vec<(usize, u8)> {
    let kind = |paint| match paint {
        Paint::Plain => 0,
        Paint::Comment => 1,
        Paint::Docs => 2,
        Paint::Keyword => 3,
        Paint::Type => 4,
        Paint::Text => 5,
        Paint::Number => 6,
        Paint::Arrow => 7,
    };
    paint(text).into_iter().map(|(text, paint)| (text.encode_utf16().count(), kind(paint))).collect()
}

/// A position as the protocol has it.
fn position(position: &Value) -> (u64, u64) {
    (position["line"].as_u64().unwrap_or(0), position["character"].as_u64().unwrap_or(0))
}

impl Found {
    fn new(found: &Value, text: &str, picture: Option<&Picture>) -> Self {
        let (from, to) = (position(&found["range"]["start"]), position(&found["range"]["end"]));
        let is_error = found["severity"] == 1;
        let concerned = statement(text, offset(text, from), offset(text, to)).filter(|_| is_error);
        let concerns = concerned.into_iter().flat_map(|concerned| {
            let names: Vec<String> = concerned.names.iter().map(|&name| name.to_owned()).collect();
            let within = picture.map_or(vec![], |picture| picture.instances(concerned.graph));
            let connects = concerned.connects;
            within.into_iter().map(move |within| Concern { within, names: names.clone(), connects })
        });
        let concerns = concerns.collect();
        Self { from, to, is_error, text: found["message"].as_str().unwrap_or_default().to_owned(), concerns }
    }
}

impl Completion {
    fn new(item: &Value) -> Option<Self> {
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let (edit, import) = (&item["textEdit"], &item["additionalTextEdits"][0]);
        Some(Self {
            label: item["label"].as_str()?.to_owned(),
            detail: text(&item["detail"]),
            docs: text(&item["documentation"]["value"]),
            from: position(&edit["range"]["start"]),
            to: position(&edit["range"]["end"]),
            text: edit["newText"].as_str()?.to_owned(),
            import: import["newText"].as_str().map(|text| (position(&import["range"]["start"]).0, text.to_owned())),
        })
    }
}

/// Byte offset of a line and a column in UTF-16 code units.
fn offset(text: &str, (line, column): (u64, u64)) -> usize {
    let line = usize::try_from(line).unwrap_or(usize::MAX);
    let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
    let mut units = 0;
    let column = text[start..].char_indices().find(|(_, c)| {
        units += c.len_utf16() as u64;
        units > column || *c == '\n'
    });
    column.map_or(text.len(), |(at, _)| start + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_utf_16_code_units() {
        let text = "a😀b\néc";
        assert_eq!(
            [(0, 0), (0, 1), (0, 3), (0, 9), (1, 0), (1, 1), (7, 0)].map(|at| offset(text, at)),
            [0, 1, 5, 6, 7, 9, 10]
        );
        assert_eq!(painted("a // 😀"), [(1, 0), (1, 0), (5, 1)]);
    }
}
