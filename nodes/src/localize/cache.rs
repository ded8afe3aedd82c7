//! Look-up tables in files.

use super::{TableError, TableSettings, VisibilityTable};
use crate::map::VectorMap;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// First bytes of a file, with the version of its format and of the algorithm that built it.
const MAGIC: &[u8; 16] = b"apex visible 001";

/// Table that was loaded or built.
#[derive(Debug, Clone, PartialEq)]
pub struct Cached {
    /// Table.
    pub table: VisibilityTable,
    /// File of the table.
    pub file: PathBuf,
    /// `true` if the table was in the file.
    pub loaded: bool,
    /// Problem with the file, if any: it was damaged, or could not be written.
    pub note: Option<String>,
}

impl VisibilityTable {
    /// Loads the table of a map from the folder `cache`, or builds it and stores it there. The name of the file is a
    /// hash of the map and of the settings. A damaged file is replaced.
    ///
    /// # Errors
    /// The errors of [`VisibilityTable::build`]. A file that cannot be read or written is only noted.
    pub fn cached(
        map: &VectorMap,
        settings: TableSettings,
        cache: &Path,
        progress: impl Fn(f32) + Sync,
    ) -> Result<Cached, TableError> {
        let empty = Self::empty(map, settings)?;
        let key = empty.key();
        let file = cache.join(format!("{key:016x}.visible"));
        let mut note = None;
        match fs::read(&file) {
            Ok(bytes) => match empty.decode(&bytes, key) {
                Some(table) => return Ok(Cached { table, file, loaded: true, note }),
                None => note = Some(format!("{}: the file is damaged and was replaced", file.display())),
            },
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {}
            Err(e) => note = Some(format!("{}: {e}", file.display())),
        }
        let table = Self::build(map, settings, progress)?;
        if let Err(e) = write(&file, &table.encode(key)) {
            note = Some(format!("{}: the table could not be stored: {e}", file.display()));
        }
        Ok(Cached { table, file, loaded: false, note })
    }

    /// Hash of the map and of the settings.
    fn key(&self) -> u64 {
        let TableSettings { cell, sectors, reach } = self.settings;
        let settings = [cell.to_bits(), u32::from(sectors), reach.to_bits()];
        let ends = self.segments.iter().flat_map(|s| [s.a.x, s.a.y, s.b.x, s.b.y]).map(f32::to_bits);
        let bytes: Vec<u8> = settings.into_iter().chain(ends).flat_map(u32::to_le_bytes).collect();
        hash(&bytes)
    }

    fn encode(&self, key: u64) -> Vec<u8> {
        let lists = [&self.starts, &self.visible, &self.inside];
        let mut bytes = MAGIC.to_vec();
        bytes.extend(key.to_le_bytes());
        lists.iter().for_each(|list| bytes.extend((list.len() as u64).to_le_bytes()));
        lists.iter().for_each(|list| bytes.extend(list.iter().flat_map(|value| value.to_le_bytes())));
        let sum = hash(&bytes);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    /// The table with the lists of a file, or `None` if the file is damaged or belongs to another table.
    fn decode(mut self, bytes: &[u8], key: u64) -> Option<Self> {
        let (content, sum) = bytes.split_last_chunk::<8>()?;
        if u64::from_le_bytes(*sum) != hash(content) {
            return None;
        }
        let (magic, rest) = content.split_first_chunk::<16>()?;
        let (numbers, mut rest) = rest.split_first_chunk::<32>()?;
        let (numbers, _) = numbers.as_chunks::<8>();
        let [stored, lengths @ ..] = numbers else { return None };
        if magic != MAGIC || u64::from_le_bytes(*stored) != key {
            return None;
        }
        for (list, length) in [&mut self.starts, &mut self.visible, &mut self.inside].into_iter().zip(lengths) {
            let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
            let (part, next) = rest.split_at_checked(length.checked_mul(4)?)?;
            list.extend(part.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)));
            rest = next;
        }
        let lists = self.width * self.height * usize::from(self.settings.sectors);
        (self.starts.len() == lists + 1 && rest.is_empty()).then_some(self)
    }
}

/// Writes a file at once: a reader finds all of it or nothing.
fn write(file: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let part = file.with_extension(format!("part{}", std::process::id()));
    fs::write(&part, bytes)?;
    fs::rename(&part, file)
}

/// FNV-1a (Fowler, Noll, Vo), over words of 8 bytes for speed.
fn hash(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let words = words.iter().map(|word| u64::from_le_bytes(*word)).chain(rest.iter().map(|byte| u64::from(*byte)));
    words.fold(0xcbf2_9ce4_8422_2325, |hash, word| {
        let mixed = (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3);
        // High bits of a word would reach only the high bits of the hash.
        mixed ^ (mixed >> 29)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::localize::table::tests::maze;

    #[test]
    fn a_table_is_built_once_and_a_damaged_one_again() {
        let cache = std::env::temp_dir().join(format!("apex-visible-{}", std::process::id()));
        let _ = fs::remove_dir_all(&cache);
        let settings = TableSettings::default();
        let get = |map: &VectorMap, settings| VisibilityTable::cached(map, settings, &cache, |_| ()).expect("a table");
        let first = get(&maze(1, 20), settings);
        assert!(!first.loaded && first.note.is_none());
        let second = get(&maze(1, 20), settings);
        assert!(second.loaded && second.table == first.table);
        assert!(!get(&maze(2, 20), settings).loaded, "another map");
        assert!(!get(&maze(1, 20), TableSettings { sectors: 35, ..settings }).loaded, "other settings");

        let whole = fs::read(&first.file).expect("the file");
        let mut flipped = whole.clone();
        flipped[whole.len() / 2] ^= 1;
        let longer = [&whole[..], &[0; 8]].concat();
        for damaged in [&whole[..whole.len() - 1], &whole[..20], &[], &flipped, &longer] {
            fs::write(&first.file, damaged).expect("the file");
            let again = get(&maze(1, 20), settings);
            assert!(!again.loaded && again.note.expect("a note").contains("damaged") && again.table == first.table);
            assert!(get(&maze(1, 20), settings).loaded, "it was replaced");
        }
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_noted() {
        let file = std::env::temp_dir().join(format!("apex-visible-file-{}", std::process::id()));
        fs::write(&file, "no folder").expect("a file");
        let cached = VisibilityTable::cached(&maze(1, 0), TableSettings::default(), &file, |_| ()).expect("a table");
        assert!(cached.note.is_some() && !cached.loaded);
    }
}
