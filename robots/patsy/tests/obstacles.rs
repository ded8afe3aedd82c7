//! Obstacle detection (thesis 6.5) on simulated scenes, and on recorded clouds.
//!
//! The recordings are not part of the project. Without them their tests print a message and pass, unless they run with
//! `CI=true`.

use apex_nodes::cloud::Label;
use patsy::experiments::obstacles::{Method, RecordedTable, Summary, labelled_scores, recorded_labels};
use std::path::{Path, PathBuf};

/// Folder of the recordings, or `None` (with a message) if it does not exist.
fn recordings(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data").join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", folder.display());
    eprintln!("skipped: {} is missing", folder.display());
    None
}

#[test]
fn obstacles_are_told_from_floor_and_artefacts_better_than_by_a_plane() {
    let scenes: Vec<_> = (1..=4).map(|seed| labelled_scores(seed).expect("a graph")).collect();
    let summary = Summary::new(&scenes, 0.5);
    println!("{summary}");
    let [plane, _, graph] = Method::ALL.map(|method| summary.auc(method).expect("obstacles and floor"));
    assert!(graph > plane && graph > 0.95, "{graph} {plane}");
}

#[test]
fn no_pixel_of_a_recorded_box_is_an_artefact() {
    let Some(folder) = recordings("tof") else { return };
    let ((width, _), labels) = recorded_labels(&folder.join("o3d303_0.pcd")).expect("a cloud");
    // The front of the box, a pixel within its edges.
    let inside = (33..=121).flat_map(|row| (50..=122).map(move |column| row * width + column));
    let artefacts: Vec<(usize, usize)> =
        inside.clone().filter(|i| labels[*i] == Label::Artefact).map(|i| (i / width, i % width)).collect();
    assert!(artefacts.is_empty(), "artefacts at (row, column) {artefacts:?}");
    let inside: Vec<Label> = inside.map(|i| labels[i]).collect();
    let hazards = inside.iter().filter(|label| label.is_hazard()).count();
    assert!(hazards * 10 > inside.len() * 7, "{hazards} of {}", inside.len());
}

#[test]
fn objects_on_recorded_tables_are_obstacles() {
    let Some(folder) = recordings("depth_labelled/small") else { return };
    let mut files: Vec<PathBuf> =
        folder.read_dir().expect("a folder").map(|file| file.expect("a file").path()).collect();
    files.sort();
    let table = RecordedTable::read(&files).expect("clouds");
    println!("{table}");
    assert!(table.areas().all(|[_, _, graph, _]| graph > Some(0.98)));
}
