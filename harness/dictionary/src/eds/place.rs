//! What the name of a section says.

/// What a section is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    /// `1018`
    Object(u16),
    /// `1018sub1`
    Entry(u16, u8),
    /// `1003Name`: names of the entries of a compact object.
    Names(u16),
    /// `1003Value`: values of the entries of a compact object, in a DCF.
    Values(u16),
    /// `1003Denotation`: what the entries of a compact object are called in one device.
    Denotations(u16),
    /// `1003ObjectLinks`
    Links(u16),
}

/// The object or entry that a section is about, in hexadecimal digits; `None` if it is about none.
pub(super) fn place(name: &str) -> Option<Place> {
    let index = hexadecimal(name.get(..4)?)?;
    let rest = name.get(4..)?.trim();
    if rest.is_empty() {
        return Some(Place::Object(index));
    }
    if let (Some(word), Some(sub)) = (rest.get(..3), rest.get(3..))
        && word.eq_ignore_ascii_case("sub")
    {
        let sub = u8::try_from(hexadecimal(sub.trim())?).ok()?;
        return Some(Place::Entry(index, sub));
    }
    let words = [
        ("Name", Place::Names(index)),
        ("Value", Place::Values(index)),
        ("Denotation", Place::Denotations(index)),
        ("ObjectLinks", Place::Links(index)),
    ];
    let mut words = words.into_iter();
    words
        .find(|(word, _)| rest.eq_ignore_ascii_case(word))
        .map(|(_, place)| place)
}

fn hexadecimal(digits: &str) -> Option<u16> {
    match digits.starts_with('+') {
        true => None,
        false => u16::from_str_radix(digits, 16).ok(),
    }
}
