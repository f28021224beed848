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
    /// `1003Value`: values of the entries of a compact object.
    Values(u16),
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
    for (word, place) in [
        ("Name", Place::Names(index)),
        ("Value", Place::Values(index)),
        ("ObjectLinks", Place::Links(index)),
    ] {
        if rest.eq_ignore_ascii_case(word) {
            return Some(place);
        }
    }
    let sub = rest
        .get(..3)
        .filter(|word| word.eq_ignore_ascii_case("sub"))
        .and_then(|_| rest.get(3..))?;
    let sub = u8::try_from(hexadecimal(sub.trim())?).ok()?;
    Some(Place::Entry(index, sub))
}

fn hexadecimal(digits: &str) -> Option<u16> {
    digits
        .bytes()
        .all(|digit| digit.is_ascii_hexdigit())
        .then(|| u16::from_str_radix(digits, 16).ok())?
}
