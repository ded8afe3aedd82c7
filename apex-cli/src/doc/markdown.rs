//! Documentation as HTML. It may come from a third party: HTML in it is escaped, images become their descriptions, and
//! links lead only to pages of this documentation or to the web.

use super::html::escaped;
use pulldown_cmark::{BrokenLink, CowStr, Event, HeadingLevel, LinkType, Options, Parser, Tag, TagEnd, html};

/// Schemes that links may have.
const SCHEMES: [&str; 3] = ["https://", "http://", "mailto:"];

/// Converts Markdown to HTML; `page` finds the page of a name in square brackets.
pub fn html(markdown: &str, page: &dyn Fn(&str) -> Option<String>) -> String {
    let mut known = |link: BrokenLink<'_>| named(&link, page);
    let options = Options::ENABLE_TABLES | Options::ENABLE_STRIKETHROUGH;
    let parser = Parser::new_with_broken_link_callback(markdown.trim(), options, Some(&mut known));
    // For each open link, `true` if it is kept.
    let mut open = vec![];
    let events = parser.filter_map(move |event| harmless(event, &mut open));
    let mut text = String::new();
    html::push_html(&mut text, events);
    text
}

/// Target of a name in square brackets: its page, or an empty target for code without a page.
fn named<'a>(link: &BrokenLink<'_>, page: &dyn Fn(&str) -> Option<String>) -> Option<(CowStr<'a>, CowStr<'a>)> {
    let found = page(link.reference.trim_matches('`').rsplit("::").next()?);
    // Without a page, the brackets around code are removed.
    let found = found.or_else(|| link.reference.starts_with('`').then(String::new));
    found.map(|page| (CowStr::from(page), CowStr::from("")))
}

/// The first sentence as HTML without links and blocks.
pub fn first_sentence(markdown: &str) -> String {
    let mut text = String::new();
    let mut known = |link: BrokenLink<'_>| named(&link, &|_| None);
    for event in Parser::new_with_broken_link_callback(markdown.trim(), Options::empty(), Some(&mut known)) {
        match event {
            Event::Text(words) | Event::Html(words) | Event::InlineHtml(words) => match end_of_sentence(&words) {
                Some(end) => return text + &escaped(&words[..end]),
                None => text += &escaped(&words),
            },
            Event::Code(code) => text += &format!("<code>{}</code>", escaped(&code)),
            Event::SoftBreak | Event::HardBreak if text.ends_with('.') => break,
            Event::SoftBreak | Event::HardBreak => text.push(' '),
            Event::End(
                TagEnd::Paragraph | TagEnd::Heading(_) | TagEnd::Item | TagEnd::CodeBlock | TagEnd::HtmlBlock,
            ) => break,
            _ => {}
        }
    }
    text.trim_end().to_owned()
}

/// End of the first sentence. Before a small letter or a number (`fig. 4.10`) a period does not end one.
fn end_of_sentence(words: &str) -> Option<usize> {
    let begins = |rest: &str| rest.chars().next().is_some_and(|c| !c.is_lowercase() && !c.is_numeric());
    words.match_indices(". ").find(|(at, _)| begins(&words[at + 2..])).map(|(at, _)| at + 1)
}

/// A harmless replacement for an event, or `None` if the event is left out.
fn harmless<'a>(event: Event<'a>, open: &mut Vec<bool>) -> Option<Event<'a>> {
    match event {
        Event::Html(text) | Event::InlineHtml(text) => Some(Event::Text(text)),
        Event::Start(Tag::HtmlBlock) => Some(Event::Start(Tag::Paragraph)),
        Event::End(TagEnd::HtmlBlock) => Some(Event::End(TagEnd::Paragraph)),
        Event::Start(Tag::Image { .. }) | Event::End(TagEnd::Image) => None,
        Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
            // A link without a written target leads to a page of this documentation, or is removed.
            let is_kept = match link_type {
                LinkType::ReferenceUnknown | LinkType::CollapsedUnknown | LinkType::ShortcutUnknown => {
                    !dest_url.is_empty()
                }
                _ => SCHEMES.iter().any(|scheme| dest_url.starts_with(scheme)) || link_type == LinkType::Email,
            };
            open.push(is_kept);
            is_kept.then_some(Event::Start(Tag::Link { link_type, dest_url, title, id }))
        }
        Event::End(TagEnd::Link) => open.pop().unwrap_or(false).then_some(event),
        // The headings of the page itself are on higher levels.
        Event::Start(Tag::Heading { level, .. }) => {
            Some(Event::Start(Tag::Heading { level: lower(level), id: None, classes: vec![], attrs: vec![] }))
        }
        Event::End(TagEnd::Heading(level)) => Some(Event::End(TagEnd::Heading(lower(level)))),
        other => Some(other),
    }
}

fn lower(level: HeadingLevel) -> HeadingLevel {
    match level {
        HeadingLevel::H1 => HeadingLevel::H3,
        HeadingLevel::H2 => HeadingLevel::H4,
        HeadingLevel::H3 => HeadingLevel::H5,
        _ => HeadingLevel::H6,
    }
}

#[cfg(test)]
mod tests {
    use super::{first_sentence, html};

    fn page(name: &str) -> Option<String> {
        (name == "Base").then(|| "base.html".to_owned())
    }

    #[test]
    fn html_is_text() {
        for (markdown, shown) in [
            ("<script>alert(1)</script>", "<p>&lt;script&gt;alert(1)&lt;/script&gt;</p>\n"),
            ("a <img src=x onerror=y> b", "<p>a &lt;img src=x onerror=y&gt; b</p>\n"),
            ("`<b>` & \"c\"", "<p><code>&lt;b&gt;</code> &amp; \"c\"</p>\n"),
            ("![a `b`](https://x.org/y.png)", "<p>a <code>b</code></p>\n"),
        ] {
            assert_eq!(html(markdown, &page), shown);
        }
    }

    #[test]
    fn links_lead_to_pages_or_to_the_web() {
        for (markdown, shown) in [
            ("[a](https://x.org)", "<p><a href=\"https://x.org\">a</a></p>\n"),
            ("<https://x.org>", "<p><a href=\"https://x.org\">https://x.org</a></p>\n"),
            ("[a](javascript:alert(1)) b", "<p>a b</p>\n"),
            ("[a](JavaScript:x) [b](data:x) [c](other.html)", "<p>a b c</p>\n"),
            ("<me@x.org>", "<p><a href=\"mailto:me@x.org\">me@x.org</a></p>\n"),
            (
                "[`Base`], [`crate::Base`], [Base]",
                "<p><a href=\"base.html\"><code>Base</code></a>, <a href=\"base.html\"><code>crate::Base</code></a>, <a href=\"base.html\">Base</a></p>\n",
            ),
            ("[`Other`] of [0, 1] and [x]", "<p><code>Other</code> of [0, 1] and [x]</p>\n"),
        ] {
            assert_eq!(html(markdown, &page), shown);
        }
    }

    #[test]
    fn headings_stand_below_those_of_the_page() {
        assert_eq!(html("# A\n\n#### B", &page), "<h3>A</h3>\n<h6>B</h6>\n");
    }

    #[test]
    fn first_sentences() {
        for (markdown, sentence) in [
            ("One. Two.", "One."),
            ("One,\nstill `one.` here. Two", "One, still <code>one.</code> here."),
            ("# Title\n\nMore", "Title"),
            ("See [`Other`] of [x]. More", "See <code>Other</code> of [x]."),
            ("Drives at 1.5 m/s\n\nMore.", "Drives at 1.5 m/s"),
            ("A <b>x</b> [a](b) & c.\nMore", "A &lt;b&gt;x&lt;/b&gt; a &amp; c."),
            ("<script>\nx\n</script>\n\nMore", "&lt;script&gt;\nx\n&lt;/script&gt;"),
            ("Thesis fig. 4.10, e.g. in small. More", "Thesis fig. 4.10, e.g. in small."),
            ("", ""),
        ] {
            assert_eq!(first_sentence(markdown), sentence);
        }
    }
}
