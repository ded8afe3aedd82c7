//! `docs/figures.md` and its pictures are up to date. `APEX_UPDATE_PICTURES=1` writes them again.

use crate::{Drawer, root};
use apex_diagram::{Item, News, diagram, mark_new, states, svg};
use std::{
    collections::{BTreeMap, BTreeSet},
    fmt::Write as _,
    fs,
    path::Path,
};

const INTRODUCTION: &str = "# Figures

The figures of the dissertation that concern the model itself. Their source files are in `tests/figures`, and
`apex graph` draws them. The tests run all of them, and write this page.

Data flows from left to right: inputs are on the left of a box, outputs on the right. Slots are at the top, events at
the bottom. Double lines are `=>`, which passes activity on. Solid lines are synchronous, dashed lines asynchronous;
dash-dotted lines lead from one kind to the other. Nodes that can be active are coloured, and a dot marks the beginning
of the activity. A second picture shows the activity alone (`--activity`).
";

/// Header of a text: its first lines without `mark`.
fn header<'a>(text: &'a str, mark: &str) -> String {
    let lines: Vec<&'a str> = text.lines().map_while(|line| line.strip_prefix(mark)).map(str::trim).collect();
    lines.join("\n")
}

/// Pages and pictures by path.
fn written() -> BTreeMap<String, String> {
    let folder = root().join("tests/figures");
    let mut drawer = Drawer::new();
    let mut names: Vec<String> = fs::read_dir(&folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("it can be read").file_name().into_string().expect("names are plain"))
        .filter(|name| name.ends_with(".afg"))
        .collect();
    names.sort();
    let mut files = BTreeMap::new();
    let mut page = INTRODUCTION.to_owned();
    for name in names {
        let text = fs::read_to_string(folder.join(&name)).expect("it can be read");
        let stem = name.trim_end_matches(".afg");
        let number = stem.trim_start_matches("fig_").split('_').map(|n| n.trim_start_matches('0')).collect::<Vec<_>>();
        let words = header(&text, "//!");
        let words = words.split_once(": ").map_or(words.as_str(), |(_, words)| words);
        let mut begin = words.chars();
        let words: String = begin.next().into_iter().flat_map(char::to_uppercase).chain(begin).collect();
        let source: Vec<&str> = text.lines().skip_while(|line| line.starts_with("//!")).collect();
        let source = source.join("\n");
        let _ = write!(page, "\n## {}\n\n{words}\n\n```afg\n{}\n```\n", number.join("."), source.trim());
        for graph in drawer.graphs(&folder, &text).unwrap_or_else(|errors| panic!("{errors}")) {
            let picture = diagram(&graph, &drawer.1, &drawer.0);
            let docs = graph.docs.trim();
            let docs = if docs.is_empty() { String::new() } else { format!(": {}", docs.replace('\n', " ")) };
            let _ = write!(page, "\n`{}`{docs}\n", graph.name);
            let path = format!("images/figures/{stem}_{}", graph.name.to_lowercase());
            let _ = write!(page, "\n![{}]({path}.svg)\n", graph.name);
            files.insert(format!("docs/{path}.svg"), svg(&picture));
            if let Some(activity) = states(&picture) {
                let _ = write!(page, "\n![The activity of {}]({path}_activity.svg)\n", graph.name);
                files.insert(format!("docs/{path}_activity.svg"), svg(&activity));
            }
        }
    }
    files.insert("docs/figures.md".to_owned(), page);
    let patsy = drawn("robots/patsy", "mission.afg", "Mission");
    files.insert("docs/images/mission.svg".to_owned(), svg(&patsy));
    let mission = drawn("robots/sick-robot-day", "mission.afg", "Mission");
    files.insert("docs/images/competition.svg".to_owned(), svg(&mission.clone().closed(1)));
    let activity = states(&mission.closed(2)).expect("there is activity");
    files.insert("docs/images/competition_activity.svg".to_owned(), svg(&activity));
    for newer in NEWER {
        let levels = newer.levels;
        files.insert(format!("docs/images/{}_new.svg", newer.page), svg(&newer.marked().0.closed(levels)));
    }
    files.extend(patterns());
    files
}

/// Pictures of `docs/patterns.md`, each of the last graph of an example.
fn patterns() -> BTreeMap<String, String> {
    let folder = root().join("tests/docs/texts");
    let page = fs::read_to_string(root().join("docs/patterns.md")).expect("it can be read");
    let mut drawer = Drawer::new();
    let names = page.lines().filter_map(|line| line.split_once("](images/patterns/")?.1.strip_suffix(".svg)"));
    let picture = |name: &str| {
        let text = fs::read_to_string(folder.join(format!("{name}.afg"))).expect("each picture has an example");
        let graphs = drawer.graphs(&folder, &text).unwrap_or_else(|errors| panic!("{errors}"));
        let graph = graphs.last().expect("the example has a graph");
        (format!("docs/images/patterns/{name}.svg"), svg(&diagram(graph, &drawer.1, &drawer.0)))
    };
    names.map(picture).collect()
}

/// Diagram of a graph of a robot.
fn drawn(folder: &str, file: &str, name: &str) -> Item {
    let folder = root().join(folder);
    let text = fs::read_to_string(folder.join(file)).expect("it can be read");
    let mut drawer = Drawer::of(&folder);
    let graphs = drawer.graphs(&folder, &text).unwrap_or_else(|errors| panic!("{errors}"));
    let graph = graphs.iter().find(|graph| graph.name == name).expect("it is in the text");
    diagram(graph, &drawer.1, &drawer.0)
}

/// A robot that was built after others.
struct Newer {
    /// Its page in the documentation.
    page: &'static str,
    robot: Place,
    others: &'static [Place],
    /// Levels of its picture.
    levels: usize,
}

/// Folder, text and name of a robot.
type Place = (&'static str, &'static str, &'static str);

const PATSY: Place = ("robots/patsy", "clinic.afg", "Patsy");
const COMPETITION: Place = ("robots/sick-robot-day", "competition.afg", "Competition");
const EXPLORER: Place = ("robots/explorer", "planet.afg", "Explorer");
const SUMMIT: Place = ("robots/follow", "follow.afg", "Summit");

const NEWER: [Newer; 2] = [
    Newer { page: "explorer", robot: EXPLORER, others: &[PATSY, COMPETITION], levels: 2 },
    Newer { page: "follow", robot: SUMMIT, others: &[PATSY, COMPETITION, EXPLORER], levels: 1 },
];

impl Newer {
    /// The picture of the robot, with what the others lack, and how much that is.
    fn marked(&self) -> (Item, News) {
        let drawn = |place: &Place| drawn(place.0, place.1, place.2);
        let others: Vec<Item> = self.others.iter().map(drawn).collect();
        let mut item = drawn(&self.robot);
        let news = mark_new(&mut item, &others);
        (item, news)
    }
}

/// Files that declare the node types of an item: new ones, and others.
fn files_of(item: &Item, files: &mut [BTreeSet<String>; 2]) {
    if let (Some((file, _)), None) = (item.ty.rsplit_once(':'), &item.inside) {
        files[usize::from(!item.new)].insert(file.to_owned());
    }
    item.items().for_each(|inner| files_of(inner, files));
}

/// Lines of code in a file, without its tests.
fn lines_of_code(file: &String) -> usize {
    let text = fs::read_to_string(root().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    code.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

#[test]
fn what_is_new_in_a_robot_is_what_its_page_says() {
    for newer in NEWER {
        let (item, News { new, all }) = newer.marked();
        let mut files = <[BTreeSet<String>; 2]>::default();
        files_of(&item, &mut files);
        let lines = files.each_ref().map(|files| files.iter().map(lines_of_code).sum::<usize>());
        let said = format!("{} of its {all} nodes are of types of the other robots", all - new);
        let page = fs::read_to_string(root().join(format!("docs/{}.md", newer.page))).expect("it can be read");
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(page.contains(&said), "docs/{}.md lacks: {said}", newer.page);
        // Of lines the page has round numbers, as they change with each change of a node.
        let (_, also) = page.split_once("declare these types have ").expect("numbers of lines");
        let said = also.split(' ').filter_map(|word| word.trim_end_matches([',', '.']).parse::<f64>().ok());
        for (is, said) in [lines[1], lines[0]].into_iter().zip(said) {
            let ratio = said / f64::from(u32::try_from(is).expect("a small number"));
            assert!((0.8..1.25).contains(&ratio), "docs/{}.md says {said} instead of {is} lines", newer.page);
        }
    }
}

#[test]
fn the_pictures_of_the_documentation_are_up_to_date() {
    let files = written();
    let update = std::env::var_os("APEX_UPDATE_PICTURES").is_some();
    for (path, text) in &files {
        let file = root().join(path);
        if update {
            fs::create_dir_all(file.parent().unwrap_or(Path::new("."))).expect("the folder can be made");
            fs::write(&file, text).expect("it can be written");
        }
        let is = fs::read_to_string(&file).unwrap_or_default().replace("\r\n", "\n");
        assert!(is == *text, "{path} is not what is drawn today: run this test with APEX_UPDATE_PICTURES=1");
    }
    let folder = fs::read_dir(root().join("docs/images/figures")).expect("the folder is there");
    for entry in folder {
        let name = entry.expect("it can be read").file_name().into_string().expect("names are plain");
        assert!(files.contains_key(&format!("docs/images/figures/{name}")), "{name} is the picture of nothing");
    }
}
