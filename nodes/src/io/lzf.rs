//! LZF, the compression of PCD files (the library `liblzf`).

/// Returns the content of compressed data, or `None` if it does not have `size` bytes, or the data are damaged. Needs
/// memory as it reads, and not as it is promised.
pub(super) fn unpack(mut data: &[u8], size: usize) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    while let Some(control) = take(&mut data, 1) {
        let control = usize::from(control[0]);
        if control < 32 {
            out.extend_from_slice(take(&mut data, control + 1)?);
        } else {
            let longer = if control >> 5 == 7 { usize::from(take(&mut data, 1)?[0]) } else { 0 };
            let length = (control >> 5) + longer + 2;
            let distance = ((control & 31) << 8) + usize::from(take(&mut data, 1)?[0]) + 1;
            let start = out.len().checked_sub(distance)?;
            // What is copied may have been written by the same copy.
            (start..start + length).for_each(|at| out.push(out[at]));
        }
        if out.len() > size {
            return None;
        }
    }
    (out.len() == size).then_some(out)
}

fn take<'a>(data: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (taken, rest) = data.split_at_checked(count)?;
    *data = rest;
    Some(taken)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Compressed data; searches repetitions at short distances only.
    pub(crate) fn pack(data: &[u8]) -> Vec<u8> {
        let (mut packed, mut at, mut literals) = (Vec::new(), 0, 0);
        let flush = |packed: &mut Vec<u8>, data: &[u8]| {
            for part in data.chunks(32) {
                packed.push(part.len() as u8 - 1);
                packed.extend_from_slice(part);
            }
        };
        while at < data.len() {
            let same =
                |distance: usize| (at..data.len()).take(264).take_while(|i| data[i - distance] == data[*i]).count();
            let best =
                (1..=at.min(300)).max_by_key(|distance| same(*distance)).map(|distance| (distance, same(distance)));
            match best {
                Some((distance, length)) if length >= 3 => {
                    flush(&mut packed, &data[literals..at]);
                    let (far, long) = ((distance - 1) as u16, length - 2);
                    let [high, low] = far.to_be_bytes();
                    match long < 7 {
                        true => packed.extend([(long as u8) << 5 | high, low]),
                        false => packed.extend([7 << 5 | high, long as u8 - 7, low]),
                    }
                    at += length;
                    literals = at;
                }
                _ => at += 1,
            }
        }
        flush(&mut packed, &data[literals..]);
        packed
    }

    #[test]
    fn repetitions_are_unpacked() {
        // Two literals, and a copy of five bytes from two bytes before.
        assert_eq!(unpack(&[1, b'a', b'b', 3 << 5, 1], 7).as_deref(), Some(&b"abababa"[..]));
        let data: Vec<u8> = (0..5000_u32).map(|i| (i * i / 300) as u8).collect();
        let packed = pack(&data);
        assert!(packed.len() < data.len());
        assert_eq!(unpack(&packed, data.len()), Some(data.clone()));
        assert_eq!(unpack(&packed, data.len() - 1), None);
        assert_eq!(unpack(&packed, usize::MAX), None);
        assert!((0..packed.len()).all(|length| unpack(&packed[..length], data.len()).is_none()));
        assert_eq!(unpack(&[32, 0], 3), None, "a copy from before the beginning");
    }
}
