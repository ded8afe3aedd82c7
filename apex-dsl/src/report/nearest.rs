//! Names that resemble other names.

/// Longer names are not compared: the comparison takes time, and such names are hardly ever mistyped.
const MAX_NAME: usize = 64;
/// Largest number of names that are compared with a given one.
const MAX_CANDIDATES: usize = 4000;

/// The name in `candidates` most similar to `name`, if it is similar enough to be meant.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    nearest_within(name, candidates, 3)
}

/// The name in `candidates` most similar to `name`, if no more than one letter in `part` differs.
pub fn nearest_within<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>, part: usize) -> Option<&'a str> {
    let limit = (name.chars().count() / part).max(1);
    if name.len() > MAX_NAME {
        return None;
    }
    candidates
        .into_iter()
        .take(MAX_CANDIDATES)
        .filter(|c| c.len().abs_diff(name.len()) <= limit)
        .map(|c| (distance(name, c), c))
        // A name of one letter is equally far from all others.
        .filter(|(d, _)| *d <= limit && *d < name.len())
        .min()
        .map(|(_, c)| c)
}

/// Edit distance, regardless of case, in which swapping two adjacent letters counts as one edit.
fn distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.to_lowercase().chars().collect();
    let b: Vec<char> = b.to_lowercase().chars().collect();
    let mut rows = vec![(0..=b.len()).collect::<Vec<_>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replace = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = replace.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            row.push(best);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}
