//! Pieces of HTML for all pages.

/// Style of all pages: light and dark, for screens and phones.
const STYLE: &str = include_str!("style.css");

/// Escapes text for HTML, also for attributes.
pub fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}

/// Code in a line.
pub fn code(text: &str) -> String {
    format!("<code>{}</code>", escaped(text))
}

/// Code in lines of its own.
pub fn block(text: &str) -> String {
    format!("<pre><code>{}</code></pre>\n", escaped(text))
}

/// A link to a page.
pub fn link(page: &str, inner: &str) -> String {
    format!("<a href=\"{}\">{inner}</a>", escaped(page))
}

/// A part of a page under a heading, or nothing if `inner` is empty.
pub fn section(title: &str, inner: &str) -> String {
    if inner.is_empty() { String::new() } else { format!("<h2>{}</h2>\n{inner}", escaped(title)) }
}

/// A part of a page that is closed at first.
pub fn folded(title: &str, inner: &str) -> String {
    format!("<details>\n<summary>{}</summary>\n{inner}</details>\n", escaped(title))
}

/// End of every page, by which pages that were made here are recognised.
pub const SIGNATURE: &str = "<footer>Made by <code>apex doc</code>.</footer>\n</body>\n</html>\n";

/// A whole page. `path` are links to the pages above it. Its security policy forbids scripts and external resources.
pub fn page(title: &str, path: &[String], body: &str) -> String {
    let title = escaped(title);
    let path: String = path.iter().map(|link| format!("{link} › ")).collect();
    let nav = if path.is_empty() { String::new() } else { format!("<nav>{path}{title}</nav>\n") };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n{nav}<main>\n{body}</main>\n{SIGNATURE}"
    )
}
