//! Division of a [`Doc`] into lines.

use super::{
    columns,
    doc::{Doc, width},
};
use apex_dsl::syntax::cst::opens;
use std::iter;

/// Longest line, if there is a choice.
pub const WIDTH: usize = 100;
/// Blanks per level of indentation.
const INDENT: usize = 4;

/// The lines of `doc`, each ended by `newline`.
pub fn print(doc: &Doc<'_>, newline: &str) -> String {
    let mut printer = Printer { newline, lines: vec![], line: String::new(), column: 0, empty: true, comment: None };
    printer.run(doc);
    printer.fresh();
    let mut text = String::new();
    for neighbours in printer.lines.chunk_by(Line::has_column_with) {
        let widths: Vec<Option<usize>> = neighbours.iter().map(|line| Some(width(&line.text))).collect();
        for (line, pad) in neighbours.iter().zip(columns::pads(&widths)) {
            text.push_str(&line.text);
            if let Some(comment) = &line.comment {
                text.extend(iter::repeat_n(' ', pad + 1));
                text.push_str(comment);
            }
            text.push_str(newline);
        }
    }
    text
}

/// A finished line.
struct Line {
    text: String,
    /// The comment at its end.
    comment: Option<String>,
    /// `true` if it ends with an opening bracket.
    opens: bool,
}

impl Line {
    /// Returns `true` if the comments at the ends of two neighbouring lines are aligned.
    fn has_column_with(&self, next: &Self) -> bool {
        let indent = |line: &Self| line.text.len() - line.text.trim_start().len();
        self.comment.is_some() && next.comment.is_some() && indent(self) == indent(next)
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Flat,
    Broken,
}

/// A piece of work that is left.
#[derive(Clone, Copy)]
enum Work<'d, 't> {
    Doc(&'d Doc<'t>),
    /// An item of a fill.
    Item(&'d Doc<'t>),
    /// The items of a fill after the first one.
    Fill(&'d [Doc<'t>]),
}

type Step<'d, 't> = (usize, Mode, Work<'d, 't>);

struct Printer<'n> {
    newline: &'n str,
    lines: Vec<Line>,
    /// The current line with its indentation.
    line: String,
    column: usize,
    /// `true` if the current line contains nothing but indentation.
    empty: bool,
    /// The comment at the end of the current line.
    comment: Option<String>,
}

impl Printer<'_> {
    fn run(&mut self, doc: &Doc<'_>) {
        let mut steps = vec![(0, Mode::Broken, Work::Doc(doc))];
        while let Some((indent, mode, work)) = steps.pop() {
            match work {
                Work::Doc(doc) => self.step(indent, mode, doc, &mut steps),
                Work::Item(item) => {
                    let fits = self.fits(indent, &[(mode, Work::Doc(item))], &steps);
                    steps.push((indent, if fits { Mode::Flat } else { Mode::Broken }, Work::Doc(item)));
                }
                Work::Fill([]) => {}
                Work::Fill([item, rest @ ..]) => {
                    steps.push((indent, mode, Work::Fill(rest)));
                    steps.push((indent, Mode::Flat, Work::Item(item)));
                    let next = [(Mode::Flat, Work::Doc(item)), (Mode::Flat, Work::Doc(&Doc::Line))];
                    if self.fits(indent, &next, &steps[..steps.len() - 1]) {
                        self.space(indent)
                    } else {
                        self.end_line()
                    }
                }
            }
        }
    }

    fn step<'d, 't>(&mut self, indent: usize, mode: Mode, doc: &'d Doc<'t>, steps: &mut Vec<Step<'d, 't>>) {
        match doc {
            Doc::Text(text) => self.write(text, indent),
            Doc::Space => self.space(indent),
            Doc::Line | Doc::SoftLine if mode == Mode::Broken => self.end_line(),
            Doc::Line => self.space(indent),
            Doc::SoftLine => {}
            Doc::Fresh => self.fresh(),
            Doc::Blank if mode == Mode::Broken => self.blank_line(),
            Doc::Broken(text) if mode == Mode::Broken => self.write(text, indent),
            Doc::Blank | Doc::Broken(_) => {}
            Doc::Comment { text, is_line } => self.comment(text, *is_line, indent),
            Doc::Concat(parts) => steps.extend(parts.iter().rev().map(|part| (indent, mode, Work::Doc(part)))),
            Doc::Indent(inner) => steps.push((indent + INDENT, mode, Work::Doc(inner))),
            Doc::Group(inner) => {
                let fits = mode == Mode::Flat || self.fits(indent, &[(Mode::Flat, Work::Doc(inner))], steps);
                steps.push((indent, if fits { Mode::Flat } else { Mode::Broken }, Work::Doc(inner)));
            }
            Doc::Fill(items) if mode == Mode::Flat => {
                for item in items.iter().skip(1).rev() {
                    steps.extend([(indent, mode, Work::Doc(item)), (indent, mode, Work::Doc(&Doc::Line))]);
                }
                steps.extend(items.first().map(|item| (indent, mode, Work::Doc(item))));
            }
            Doc::Fill(items) => {
                let Some((first, rest)) = items.split_first() else { return };
                steps.push((indent, mode, Work::Fill(rest)));
                steps.push((indent, Mode::Flat, Work::Item(first)));
            }
        }
    }

    /// Returns `true` if `next` (first item last) fits into the current line, with everything behind it up to the next
    /// line break.
    fn fits<'d, 't>(&self, indent: usize, next: &[(Mode, Work<'d, 't>)], rest: &[Step<'d, 't>]) -> bool {
        let column = if self.line.is_empty() { indent } else { self.column };
        let mut fit = Fit { left: WIDTH.saturating_sub(column), comment: self.comment.is_some(), open: vec![] };
        fit.open.extend_from_slice(next);
        while let Some((mode, work)) = fit.open.pop() {
            if let Some(fits) = fit.step(mode, work) {
                return fits;
            }
        }
        for (_, mode, work) in rest.iter().rev() {
            fit.open.push((*mode, *work));
            while let Some((mode, work)) = fit.open.pop() {
                if let Work::Doc(Doc::Fresh | Doc::Blank) = work {
                    return true;
                }
                if let Some(fits) = fit.step(mode, work) {
                    return fits;
                }
            }
        }
        true
    }

    fn write(&mut self, text: &str, indent: usize) {
        if text.is_empty() {
            return;
        }
        self.indent(indent);
        self.line.push_str(text);
        self.empty = false;
        self.column = match text.rsplit_once('\n') {
            Some((_, last)) => width(last),
            None => self.column + width(text),
        };
    }

    fn indent(&mut self, indent: usize) {
        if self.line.is_empty() {
            self.line.extend(iter::repeat_n(' ', indent));
            self.column = indent;
        }
    }

    fn space(&mut self, indent: usize) {
        if !self.empty {
            self.write(" ", indent);
        }
    }

    fn comment(&mut self, text: &str, is_line: bool, indent: usize) {
        // Comments keep their order: none may overtake the one that is kept for the end of the line.
        if self.comment.is_some() {
            self.end_line();
        }
        if is_line {
            self.indent(indent);
            self.comment = Some(text.to_owned());
        } else {
            self.space(indent);
            self.write(&text.replace("\r\n", "\n").replace('\n', self.newline), indent);
        }
    }

    fn fresh(&mut self) {
        if !self.empty || self.comment.is_some() {
            self.end_line();
        }
    }

    fn end_line(&mut self) {
        let mut comment = self.comment.take();
        let mut text = std::mem::take(&mut self.line);
        text.truncate(text.trim_end_matches(' ').len());
        let opens = text.chars().last().is_some_and(|c| opens(c.encode_utf8(&mut [0; 4])));
        if self.empty
            && let Some(comment) = comment.take()
        {
            text = " ".repeat(self.column) + &comment;
        }
        self.lines.push(Line { text, comment, opens });
        (self.column, self.empty) = (0, true);
    }

    fn blank_line(&mut self) {
        self.fresh();
        if self.lines.last().is_some_and(|last| !last.text.is_empty() && !last.opens) {
            self.end_line();
        }
    }
}

/// State of looking ahead in a line.
struct Fit<'d, 't> {
    left: usize,
    /// `true` if a comment is kept for the end of the line, which must end as soon as possible.
    comment: bool,
    open: Vec<(Mode, Work<'d, 't>)>,
}

impl<'d, 't> Fit<'d, 't> {
    /// Takes one step. Returns the result as soon as it is known.
    fn step(&mut self, mode: Mode, work: Work<'d, 't>) -> Option<bool> {
        let doc = match work {
            Work::Doc(doc) | Work::Item(doc) => doc,
            Work::Fill(items) => return self.fill(items, mode),
        };
        match doc {
            Doc::Text(text) => return self.take(text),
            Doc::Space => return self.take(" "),
            Doc::Line | Doc::SoftLine if mode == Mode::Broken => return Some(true),
            Doc::Line | Doc::SoftLine if self.comment => return Some(false),
            Doc::Line => return self.take(" "),
            Doc::SoftLine | Doc::Blank => {}
            Doc::Fresh => return Some(false),
            Doc::Broken(text) if mode == Mode::Broken => return self.take(text),
            Doc::Broken(_) => {}
            Doc::Comment { .. } if self.comment => return Some(false),
            Doc::Comment { is_line: true, .. } => self.comment = true,
            Doc::Comment { text, .. } => return self.take(" ").or_else(|| self.take(text)),
            Doc::Concat(parts) => self.open.extend(parts.iter().rev().map(|part| (mode, Work::Doc(part)))),
            Doc::Indent(inner) | Doc::Group(inner) => self.open.push((mode, Work::Doc(inner))),
            Doc::Fill(items) => {
                let (first, rest) = items.split_first()?;
                self.open.extend([(mode, Work::Fill(rest)), (mode, Work::Doc(first))]);
            }
        }
        None
    }

    fn fill(&mut self, items: &'d [Doc<'t>], mode: Mode) -> Option<bool> {
        let (first, rest) = items.split_first()?;
        self.open.extend([(mode, Work::Fill(rest)), (mode, Work::Doc(first)), (mode, Work::Doc(&Doc::Line))]);
        None
    }

    fn take(&mut self, text: &str) -> Option<bool> {
        // Text with a line break does not fit into a line.
        match self.left.checked_sub(width(text)) {
            Some(left) if !text.contains('\n') => self.left = left,
            _ => return Some(false),
        }
        None
    }
}
