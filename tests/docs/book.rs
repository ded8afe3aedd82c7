//! The pages as a book: each stands in the summary, and every link leads somewhere.

use crate::{page, pages, root};
use std::{collections::BTreeSet, path::Path};

/// The text without its blocks of code.
fn prose(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

/// The targets of all links of a page; pictures are links, too.
fn links(name: &str) -> Vec<String> {
    let text = prose(&page(name));
    text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target.to_owned()).collect()
}

/// The anchors of a page: its headings in small letters, without signs, with `-` for blanks.
fn anchors(name: &str) -> BTreeSet<String> {
    let anchor = |heading: &str| -> String {
        let letters = heading.trim().chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        letters.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
    };
    let text = prose(&page(name));
    text.lines().filter(|line| line.starts_with('#')).map(|line| anchor(line.trim_start_matches('#'))).collect()
}

/// A link of page `name` as a path from the root of the repository.
fn resolved(name: &str, target: &str) -> String {
    let mut parts: Vec<&str> = name.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "." => {}
            ".." => assert!(parts.pop().is_some(), "{name}: `{target}` leads out of the repository"),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

#[test]
fn every_page_is_in_the_summary() {
    let listed: BTreeSet<String> =
        links("docs/SUMMARY.md").iter().map(|target| resolved("docs/SUMMARY.md", target)).collect();
    let there = pages().into_iter().filter(|name| !["README.md", "docs/SUMMARY.md"].contains(&name.as_str()));
    let missing: Vec<String> = there.filter(|name| !listed.contains(name)).collect();
    assert!(missing.is_empty(), "docs/SUMMARY.md does not list {missing:?}");
}

#[test]
fn every_link_leads_somewhere() {
    let mut count = 0;
    for name in pages() {
        for target in links(&name).into_iter().filter(|target| !target.contains("://")) {
            count += 1;
            let (path, anchor) = target.split_once('#').map_or((target.as_str(), None), |(p, a)| (p, Some(a)));
            let path = if path.is_empty() { name.clone() } else { resolved(&name, path) };
            assert!(Path::new(&root()).join(&path).exists(), "{name}: there is no `{path}`");
            if let Some(anchor) = anchor {
                assert!(anchors(&path).contains(anchor), "{name}: `{path}` has no heading `#{anchor}`");
            }
        }
    }
    assert!(count > 20, "only {count} links were found");
}
