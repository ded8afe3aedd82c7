//! Every link in the book leads to an existing page of the book and an existing heading.

use std::{
    collections::{BTreeMap, BTreeSet},
    env, fs,
    path::{Component, Path, PathBuf},
    process,
};

/// HTML pages below a folder, by relative path.
fn pages(folder: &Path) -> BTreeMap<PathBuf, String> {
    let (mut open, mut found) = (vec![folder.to_owned()], BTreeMap::new());
    while let Some(inner) = open.pop() {
        for path in fs::read_dir(&inner).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|end| end == "html") {
                let name = path.strip_prefix(folder).unwrap().to_owned();
                found.insert(name, fs::read_to_string(&path).unwrap());
            }
        }
    }
    found
}

/// Values of an attribute in a page.
fn values<'a>(page: &'a str, attribute: &str) -> impl Iterator<Item = &'a str> {
    let begin = format!(" {attribute}=\"");
    let starts: Vec<usize> = page.match_indices(&begin).map(|(at, _)| at + begin.len()).collect();
    starts.into_iter().filter_map(|at| page[at..].split_once('"').map(|(value, _)| value))
}

/// Target of a link as a path in the book.
fn resolved(page: &Path, target: &str) -> Option<PathBuf> {
    let mut path = page.parent()?.to_owned();
    for part in Path::new(target).components() {
        match part {
            Component::Normal(name) => path.push(name),
            Component::CurDir => {}
            Component::ParentDir if path.pop() => {}
            _ => return None,
        }
    }
    Some(path)
}

/// Fault of a link, if it has one.
fn fault(folder: &Path, pages: &BTreeMap<PathBuf, String>, page: &Path, link: &str) -> Option<String> {
    let (target, anchor) = link.split_once('#').map_or((link, None), |(target, anchor)| (target, Some(anchor)));
    let path = if target.is_empty() { Some(page.to_owned()) } else { resolved(page, target) };
    let fault = |what: &str| Some(format!("{}: `{link}` {what}", page.display()));
    let Some(path) = path else { return fault("leads out of the book") };
    if !folder.join(&path).is_file() {
        return fault("leads nowhere");
    }
    let anchor = anchor.filter(|anchor| !anchor.is_empty())?;
    let ids: BTreeSet<&str> = pages.get(&path).map(|text| values(text, "id").collect()).unwrap_or_default();
    if ids.contains(anchor) { None } else { fault("leads to a heading that is not there") }
}

#[test]
fn every_link_stays_in_the_book_and_leads_somewhere() {
    let folder = env::temp_dir().join(format!("apex-book-{}", process::id()));
    let built = apex_book::build(Some(&folder)).unwrap();
    let pages = pages(&built);
    let (mut count, mut faults) = (0, vec![]);
    // The page for missing pages has links from the root of the server.
    for (page, text) in pages.iter().filter(|(page, _)| page.as_path() != Path::new("404.html")) {
        for link in values(text, "href").chain(values(text, "src")).filter(|link| !link.contains("://")) {
            count += 1;
            faults.extend(fault(&built, &pages, page, link));
        }
    }
    fs::remove_dir_all(&folder).unwrap();
    assert_eq!(faults, Vec::<String>::new());
    assert!(pages.len() > 60 && count > 1000, "only {} pages with {count} links", pages.len());
}
