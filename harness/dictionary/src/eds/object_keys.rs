//! The keys of the section of an object or entry.

use super::{Key, Section};

/// What CiA 306 says of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Word {
    ParameterName,
    ObjectType,
    SubNumber,
    CompactSubObj,
    DataType,
    AccessType,
    LowLimit,
    HighLimit,
    DefaultValue,
    PdoMapping,
    ParameterValue,
    Denotation,
    ObjFlags,
}

impl Word {
    /// The words in the order of the enum.
    const ALL: [(Word, &'static str); 13] = [
        (Word::ParameterName, "ParameterName"),
        (Word::ObjectType, "ObjectType"),
        (Word::SubNumber, "SubNumber"),
        (Word::CompactSubObj, "CompactSubObj"),
        (Word::DataType, "DataType"),
        (Word::AccessType, "AccessType"),
        (Word::LowLimit, "LowLimit"),
        (Word::HighLimit, "HighLimit"),
        (Word::DefaultValue, "DefaultValue"),
        (Word::PdoMapping, "PDOMapping"),
        (Word::ParameterValue, "ParameterValue"),
        (Word::Denotation, "Denotation"),
        (Word::ObjFlags, "ObjFlags"),
    ];

    /// The word that `key` is, in any case and with any blanks in it.
    pub(super) fn of(key: Key<'_>) -> Option<Word> {
        let mut words = Word::ALL.iter();
        let found = words.find(|(_, name)| key.name.eq_ignore_ascii_case(name));
        let found = found.or_else(|| {
            let mut words = Word::ALL.iter().filter(|_| key.has_blanks());
            words.find(|(_, name)| key.is(name))
        });
        found.map(|(word, _)| *word)
    }
}

/// The keys of one section by their word, found in one pass. Of two with one word the first counts.
#[derive(Default)]
pub(super) struct ObjectKeys<'t>([Option<Key<'t>>; Word::ALL.len()]);

impl<'t> ObjectKeys<'t> {
    pub(super) fn of(section: Section<'t>) -> ObjectKeys<'t> {
        let mut keys = ObjectKeys::default();
        for key in section.keys() {
            if let Some(word) = Word::of(key)
                && let Some(slot) = keys.0.get_mut(word as usize)
            {
                slot.get_or_insert(key);
            }
        }
        keys
    }

    /// The key that is `word`; `None` if it is missing or if nothing is behind its `=`.
    pub(super) fn get(&self, word: Word) -> Option<Key<'t>> {
        let key = self.0.get(word as usize).copied().flatten();
        key.filter(|key| !key.value.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::{ObjectKeys, Word};

    #[test]
    fn each_word_has_its_slot() {
        for (at, (word, _)) in Word::ALL.iter().enumerate() {
            assert_eq!(*word as usize, at);
        }
    }

    #[test]
    fn the_first_counts_even_if_it_is_empty() {
        let text = "[2000]\nData Type=5\ndatatype=6\nLowLimit=\nLowLimit=1\n";
        let (sections, _) = crate::ini::parse(text);
        let keys = ObjectKeys::of(sections.at(1).unwrap());
        assert_eq!(keys.get(Word::DataType).unwrap().line, 2);
        assert_eq!(keys.get(Word::LowLimit), None);
        assert_eq!(keys.get(Word::HighLimit), None);
    }
}
