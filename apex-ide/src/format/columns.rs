//! Alignment of neighbouring lines in columns: keywords, names, arrows and comments.

/// Largest number of blanks that are inserted: wider gaps are hard to read across.
const MOST: usize = 12;

/// Numbers of blanks that align the text behind neighbouring cells, by the widths of the cells. A cell without a width
/// is not aligned. A new column begins where the widths differ too much.
pub fn pads(widths: &[Option<usize>]) -> Vec<usize> {
    let mut pads = vec![];
    let mut rest = widths;
    while !rest.is_empty() {
        let (mut low, mut high, mut count) = (usize::MAX, 0, 0);
        for width in rest {
            let (lower, higher) = width.map_or((low, high), |w| (low.min(w), high.max(w)));
            if higher > lower.saturating_add(MOST) {
                break;
            }
            (low, high, count) = (lower, higher, count + 1);
        }
        let (column, behind) = rest.split_at(count);
        pads.extend(column.iter().map(|width| width.map_or(0, |w| high - w)));
        rest = behind;
    }
    pads
}
