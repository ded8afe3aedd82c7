//! What stands below each other: the words, names and arrows of neighbouring statements.

/// More blanks than this are not put in: the eye would lose the line.
const MOST: usize = 12;

/// How many blanks follow each of neighbouring cells, by their widths, so that what stands behind them is in one column.
/// What has no width stands apart. Where widths differ too much, another column begins.
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
