//! The pages as a book: each is in the summary, and every link has a target.

use crate::{page, pages, root};
use std::collections::BTreeSet;

/// Text without its blocks of code.
fn prose(text: &str) -> String {
    text.split("```").step_by(2).collect()
}

/// Targets of all links of a page, including pictures.
fn links(name: &str) -> Vec<String> {
    let text = prose(&page(name));
    text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target.to_owned()).collect()
}

/// Anchors of a page: its headings in small letters, without punctuation, with `-` for blanks.
fn anchors(name: &str) -> BTreeSet<String> {
    let anchor = |heading: &str| -> String {
        let letters = heading.trim().chars().filter(|c| c.is_alphanumeric() || [' ', '-', '_'].contains(c));
        letters.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
    };
    let text = prose(&page(name));
    text.lines().filter(|line| line.starts_with('#')).map(|line| anchor(line.trim_start_matches('#'))).collect()
}

/// Link of the page `name` as a path from the root of the repository.
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
    let there = pages().into_iter().filter(|name| name.starts_with("docs/") && name != "docs/SUMMARY.md");
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
            let file = root().join(&path);
            assert!(file.exists(), "{name}: there is no `{path}`");
            // The book contains the files below `docs`; all other links would work in the repository only.
            let in_book = path.starts_with("docs/") && file.is_file();
            assert!(in_book || !name.starts_with("docs/"), "{name}: `{target}` leads out of the book");
            if let Some(anchor) = anchor {
                assert!(anchors(&path).contains(anchor), "{name}: `{path}` has no heading `#{anchor}`");
            }
        }
    }
    assert!(count > 20, "only {count} links were found");
}

#[test]
fn the_licences_of_the_manifest_are_there() {
    let manifest = page("Cargo.toml");
    let (_, licence) = manifest.split_once("\nlicense = \"").expect("the manifest names its licences");
    let names: Vec<&str> = licence.split('"').next().unwrap_or_default().split(" OR ").collect();
    for name in &names {
        let short = name.split('-').next().unwrap_or_default().to_uppercase();
        assert!(page(&format!("LICENSE-{short}")).lines().count() > 15, "{name}");
        assert!(page("README.md").contains(&format!("[{name}](LICENSE-{short})")), "{name}");
    }
    assert_eq!(names.len(), 2);
}

/// Features that a page describes exist: no page for newcomers from other systems calls them missing.
#[test]
fn what_is_there_is_not_denied() {
    let topics = [
        ("docs/recording.md", &["record", "replay", "rosbag"][..]),
        ("docs/threads.md", &["thread"]),
        ("docs/tools.md", &["profil"]),
        ("docs/editors.md", &["completion"]),
    ];
    let names = pages().into_iter().filter(|name| name.starts_with("docs/from/"));
    let mut denied = vec![];
    for name in names {
        let text = page(&name).to_lowercase();
        let (before, missing) = text.split_once("## what is not there").expect("there is such a section");
        let rows = before.lines().filter(|line| ["not there", "not yet", "not run"].iter().any(|no| line.contains(no)));
        // The first words of a point name the missing feature; the rest describes an alternative.
        let points = missing.lines().filter_map(|line| line.strip_prefix("- "));
        let points = points.map(|point| point.split(['.', ':', ';']).next().unwrap_or(point));
        for said in rows.chain(points) {
            let topic = topics.iter().find(|(_, words)| words.iter().any(|word| said.contains(word)));
            denied.extend(topic.map(|(described, _)| format!("{name}: `{said}`, but see {described}")));
        }
    }
    assert_eq!(denied, Vec::<String>::new());
}
