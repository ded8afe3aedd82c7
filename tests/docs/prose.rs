//! Habits of the prose in comments and pages: one test for each. A failure lists file and line.

use crate::{files::names, root};
use std::fs;

/// Largest number of characters in a line of a comment or of a page; code has the width of rustfmt.
const WIDTH: usize = 120;

/// Words that a doc comment does not begin with: the noun or the verb comes first.
const CLAUSES: [&str; 6] = ["What", "Who", "How", "Where", "Which", "Whether"];

/// Words for which the project has better ones, each with the replacement.
const WORDS: [(&str, &str); 4] = [
    ("nobody", "`nothing`, `no node`, `no thread`"),
    ("somebody", "the noun"),
    ("anew", "`again`"),
    ("for ever", "`forever`"),
];

/// Pages that tell a story, which may use [`WORDS`].
const NARRATIVE: [&str; 2] = ["docs/tour.md", "docs/competition.md"];

/// Page that a command writes from the documentation of nodes, a paragraph in each line.
const GENERATED: &str = "docs/nodes-index.md";

/// Words behind `is no` that make it right: `is no longer`.
const COMPARATIVES: [&str; 9] =
    ["longer", "more", "less", "better", "worse", "faster", "slower", "greater", "different"];

/// Line of prose with its number. A paragraph is a list of them.
type Line<'a> = (usize, &'a str);

/// Comment: its mark (`//`, `///` or `//!`) and its paragraphs.
type Comment<'a> = (&'static str, Vec<Vec<Line<'a>>>);

/// Source file with its path from the root of the repository.
struct File {
    name: String,
    text: String,
}

/// All files of the repository with this extension, in the order of their names.
fn files(extension: &str) -> Vec<File> {
    let found = names(extension);
    assert!(found.len() > 10, "only {} files `*.{extension}` were found", found.len());
    let read = |name: String| {
        let text = fs::read_to_string(root().join(&name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        File { name, text }
    };
    found.into_iter().map(read).collect()
}

/// Text of a line that is a comment as a whole, with its mark (`//`, `///` or `//!`).
fn comment(line: &str) -> Option<(&'static str, &str)> {
    let line = line.trim_start();
    // Four slashes are an ordinary comment.
    let mark = match () {
        () if line.starts_with("////") => "//",
        () => *["///", "//!", "//"].iter().find(|mark| line.starts_with(**mark))?,
    };
    Some((mark, &line[mark.len()..]))
}

/// Comments of a Rust file, without blocks of code in them: each with its mark. Lines that follow each other with
/// the same mark are one comment; an empty line in it ends a paragraph.
fn comments(text: &str) -> Vec<Comment<'_>> {
    let mut found: Vec<Comment> = vec![];
    let (mut last, mut in_code) = (None, false);
    for (index, line) in text.lines().enumerate() {
        let here = comment(line);
        if here.map(|(mark, _)| mark) != last {
            last = here.map(|(mark, _)| mark);
            in_code = false;
            found.extend(last.map(|mark| (mark, vec![vec![]])));
        }
        let (Some((_, words)), Some((_, paragraphs))) = (here, found.last_mut()) else { continue };
        add(words.trim(), index + 1, &mut in_code, paragraphs);
    }
    found
}

/// Paragraphs of a page, without tables, pictures and blocks of code.
fn paragraphs(text: &str) -> Vec<Vec<Line<'_>>> {
    let (mut found, mut in_code) = (vec![vec![]], false);
    for (index, line) in text.lines().enumerate() {
        add(line.trim_end(), index + 1, &mut in_code, &mut found);
    }
    found
}

/// Adds a line of Markdown to the last paragraph, or begins another one.
fn add<'a>(line: &'a str, number: usize, in_code: &mut bool, paragraphs: &mut Vec<Vec<Line<'a>>>) {
    let fence = line.trim_start().starts_with("```");
    if fence {
        *in_code = !*in_code;
    }
    if fence || *in_code || line.is_empty() || line.starts_with(['|', '#']) || line.starts_with("![") {
        paragraphs.push(vec![]);
    } else if let Some(paragraph) = paragraphs.last_mut() {
        // Four blanks at the beginning of a paragraph make it a block of code.
        if !paragraph.is_empty() || !line.starts_with("    ") {
            paragraph.push((number, line));
        }
    }
}

/// Words of a paragraph, each with the number of its line. What is quoted in a code span becomes one word of `x`.
fn words(paragraph: &[Line<'_>]) -> Vec<(usize, String)> {
    let mut quoted = false;
    let mut found: Vec<(usize, String)> = vec![];
    for (number, line) in paragraph {
        let mut begins = true;
        for c in line.chars() {
            if c == '`' {
                quoted = !quoted;
            }
            if c.is_whitespace() && !quoted {
                begins = true;
                continue;
            }
            if begins {
                found.push((*number, String::new()));
                begins = false;
            }
            let c = if quoted && c != '`' { 'x' } else { c };
            found.last_mut().expect("a word has begun").1.push(c);
        }
    }
    found
}

/// Word without punctuation around it, in small letters.
fn plain(word: &str) -> String {
    word.trim_matches(|c: char| !c.is_alphanumeric() && c != '`').to_lowercase()
}

/// Lines with `is no` or `are no` before a noun: `is not a name` is English. `there is no` and `is no longer` are, too.
fn denials(paragraph: &[Line<'_>]) -> Vec<usize> {
    let words: Vec<(usize, String)> = words(paragraph).into_iter().map(|(at, word)| (at, plain(&word))).collect();
    let denied = |i: &usize| {
        let (is, no, noun) = (&words[*i].1, &words[i + 1].1, &words[i + 2].1);
        let there = *i > 0 && words[i - 1].1 == "there";
        let begins = noun.starts_with(|c: char| c.is_alphabetic() || c == '`');
        (is == "is" || is == "are") && no == "no" && begins && !there && !COMPARATIVES.contains(&noun.as_str())
    };
    (0..words.len().saturating_sub(2)).filter(denied).map(|i| words[i + 1].0).collect()
}

/// Lines with one of [`WORDS`], each with the word and its replacement.
fn dialect(paragraph: &[Line<'_>]) -> Vec<(usize, &'static str, &'static str)> {
    let words: Vec<(usize, String)> = words(paragraph).into_iter().map(|(at, word)| (at, plain(&word))).collect();
    let mut found = vec![];
    for (i, (at, word)) in words.iter().enumerate() {
        let pair = words.get(i + 1).map(|(_, next)| format!("{word} {next}"));
        let is = |known: &str| word == known || pair.as_deref() == Some(known);
        found.extend(WORDS.iter().filter(|(known, _)| is(known)).map(|(known, better)| (*at, *known, *better)));
    }
    found
}

/// Number of characters of a line of a page, without the targets of its links, which cannot be broken.
fn width(line: &str) -> usize {
    let mut parts = line.split("](");
    let text = parts.next().map_or(0, |part| part.chars().count());
    let rest = parts.map(|part| part.split_once(')').map_or(part, |(_, behind)| behind).chars().count() + "]()".len());
    text + rest.sum::<usize>()
}

/// Paragraphs of all doc comments and pages, with the name of their file.
fn for_each_paragraph(mut look: impl FnMut(&str, &[Line<'_>])) {
    for file in files("rs") {
        let docs = comments(&file.text).into_iter().filter(|(mark, _)| *mark != "//");
        docs.flat_map(|(_, paragraphs)| paragraphs).for_each(|paragraph| look(&file.name, &paragraph));
    }
    for file in files("md") {
        paragraphs(&file.text).iter().for_each(|paragraph| look(&file.name, paragraph));
    }
}

/// Fails with all places, if there are any.
fn assert_none(found: &[String], rule: &str) {
    assert!(found.is_empty(), "{rule}\n{}\n{} places", found.join("\n"), found.len());
}

#[test]
fn doc_comments_begin_with_a_noun_or_a_verb() {
    let mut found = vec![];
    for file in files("rs") {
        for (_, paragraphs) in comments(&file.text).into_iter().filter(|(mark, _)| *mark != "//") {
            let Some((line, text)) = paragraphs.first().and_then(|first| first.first()) else { continue };
            let begin: String = text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            if CLAUSES.contains(&begin.as_str()) {
                found.push(format!("{}:{line}: {text}", file.name));
            }
        }
    }
    assert_none(&found, "a doc comment begins with the noun it documents, or with a verb:");
}

#[test]
fn prose_denies_with_not() {
    let mut found = vec![];
    for_each_paragraph(|name, paragraph| {
        found.extend(denials(paragraph).into_iter().map(|line| format!("{name}:{line}")));
    });
    assert_none(&found, "`is not a name`, or `there is no name`, instead of `is no name`:");
}

#[test]
fn prose_has_none_of_the_words_that_are_replaced() {
    let mut found = vec![];
    for_each_paragraph(|name, paragraph| {
        let is_exempt = NARRATIVE.contains(&name);
        for (line, word, better) in dialect(paragraph).into_iter().filter(|_| !is_exempt) {
            found.push(format!("{name}:{line}: `{word}`: better {better}"));
        }
    });
    assert_none(&found, "words for which there are better ones:");
}

#[test]
fn comments_have_lines_of_the_width_of_the_code() {
    let mut found = vec![];
    for file in files("rs") {
        let long = |(_, line): &(usize, &str)| line.chars().count() > WIDTH && comment(line).is_some();
        let long = file.text.lines().enumerate().filter(long);
        found.extend(long.map(|(i, line)| format!("{}:{}: {} columns", file.name, i + 1, line.chars().count())));
    }
    assert_none(&found, &format!("a line of a comment has at most {WIDTH} columns:"));
}

#[test]
fn pages_have_lines_of_the_width_of_the_code() {
    let mut found = vec![];
    for file in files("md").into_iter().filter(|file| file.name != GENERATED) {
        let all = paragraphs(&file.text).into_iter().flatten();
        let long = all.map(|(at, line)| (at, width(line))).filter(|(_, width)| *width > WIDTH);
        found.extend(long.map(|(at, width)| format!("{}:{at}: {width} columns", file.name)));
    }
    assert_none(&found, &format!("a line of prose has at most {WIDTH} columns, without the targets of its links:"));
}

#[test]
fn habits_are_told_from_good_english() {
    let denied = |text: &str| denials(&[(1, text)]).len();
    let wrong = ["`9x` is no name", "they are no programs", "this is no `graph`", "is no good"];
    assert_eq!(wrong.map(denied), [1; 4]);
    let right = [
        "there is no name",
        "If there are no errors",
        "it is no longer active",
        "a region is no faster, and is no more than that",
        "says `x is no name`",
        "is not a name",
    ];
    assert_eq!(right.map(denied), [0; 6]);
    // Also over the end of a line, and with the number of the line in which `no` stands.
    assert_eq!(denials(&[(3, "what there"), (4, "is no"), (5, "name for is"), (6, "no name")]), [6]);

    let dialect = |text: &str| dialect(&[(1, text)]).len();
    assert_eq!(["Nobody, and somebody", "made anew.", "for ever"].map(dialect), [2, 1, 1]);
    assert_eq!(["for everything", "renewed"].map(dialect), [0; 2]);

    let text = "/// Noun.\n///\n/// ```\n/// is no code\n/// ```\n//! Other.\nlet x = 1; // What\n// Why.\n";
    let lines: Vec<(&str, usize)> =
        comments(text).iter().map(|(mark, paragraphs)| (*mark, paragraphs.concat().len())).collect();
    assert_eq!(lines, [("///", 1), ("//!", 1), ("//", 1)]);
    let page = "# A title\nprose\n| a | table |\n```afg\ncode\n```\n![A picture](x.svg)\nmore\n\n    code\n";
    assert_eq!(paragraphs(page).concat(), [(2, "prose"), (8, "more")]);
    assert_eq!(["a word", "a [link](page.md#anchor) and [another](x) one"].map(width), [6, 30]);
}
