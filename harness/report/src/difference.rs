//! What was expected above what came, with the bytes that differ marked.

/// Two lines, and under them the marks where the second differs from the first; `None` where the two are not frames
/// or bytes, or do not differ.
pub(crate) struct Comparison {
    pub(crate) expected: String,
    pub(crate) came: String,
    pub(crate) marks: Option<String>,
}

/// `expected` and `came` are each a frame or bytes and, two spaces later, what they mean; or plain words.
pub(crate) fn compare(expected: &str, came: &str) -> Comparison {
    let (expected_raw, expected_words) = split(expected);
    let (came_raw, came_words) = split(came);
    // Without the separators of one side only, a byte stands under its like.
    let (expected_raw, came_raw) = (expected_raw.replace('.', ""), came_raw.replace('.', ""));
    let (Some(wanted), Some(cells)) = (cells(&expected_raw), cells(&came_raw)) else {
        return Comparison {
            expected: expected.to_owned(),
            came: came.to_owned(),
            marks: None,
        };
    };
    let width = expected_raw.chars().count().max(came_raw.chars().count());
    let line = |raw: &str, words: &str| format!("{raw:<width$}   {words}").trim_end().to_owned();
    Comparison {
        expected: line(&expected_raw, expected_words),
        came: line(&came_raw, came_words),
        marks: marks(&wanted, &cells),
    }
}

fn split(text: &str) -> (&str, &str) {
    match text.split_once("  ") {
        Some((raw, words)) => (raw.trim_end(), words.trim_start()),
        None => (text, ""),
    }
}

/// An identifier or a byte, and the column it stands at.
struct Cell<'a> {
    column: usize,
    digits: &'a str,
}

/// The cells of a frame in can-utils notation, or of bytes in hexadecimal.
fn cells(raw: &str) -> Option<Vec<Cell<'_>>> {
    let is_digit = |character: char| character.is_ascii_hexdigit() || character == '?';
    if raw.is_empty() || !raw.is_ascii() {
        return None;
    }
    let mut cells = Vec::new();
    let mut column = 0;
    if let Some((id, _)) = raw.split_once('#') {
        if id.is_empty() || !id.chars().all(is_digit) {
            return None;
        }
        cells.push(Cell { column, digits: id });
        column = id.len() + 1;
    }
    while column < raw.len() {
        let rest = &raw[column..];
        match rest.chars().next()? {
            ' ' => column += 1,
            'R' => {
                cells.push(Cell {
                    column,
                    digits: rest,
                });
                column = raw.len();
            }
            _ => {
                let digits = rest.get(..2).filter(|pair| pair.chars().all(is_digit))?;
                cells.push(Cell { column, digits });
                column += 2;
            }
        }
    }
    (!cells.is_empty()).then_some(cells)
}

fn marks(expected: &[Cell<'_>], came: &[Cell<'_>]) -> Option<String> {
    let mut line = String::new();
    for index in 0..expected.len().max(came.len()) {
        let cell = match (expected.get(index), came.get(index)) {
            (Some(expected), Some(came)) if fits(expected.digits, came.digits) => continue,
            (_, Some(came)) => came,
            // What is missing is marked where it should have stood.
            (Some(missing), None) => missing,
            (None, None) => continue,
        };
        while line.len() < cell.column {
            line.push(' ');
        }
        line.extend(std::iter::repeat_n('^', cell.digits.len()));
    }
    (!line.is_empty()).then_some(line)
}

fn fits(expected: &str, came: &str) -> bool {
    expected.len() == came.len()
        && expected
            .chars()
            .zip(came.chars())
            .all(|(expected, came)| expected == '?' || expected.eq_ignore_ascii_case(&came))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(expected: &str, came: &str) -> Option<String> {
        let comparison = compare(expected, came);
        comparison
            .marks
            .map(|marks| format!("{}\n{marks}", comparison.came))
    }

    #[test]
    fn differing_byte_of_a_frame_is_marked() {
        assert_eq!(
            marked(
                "581#43636000.13D1????  SDO 6063h",
                "581#4363600014D1FFFF  SDO 6063h"
            )
            .unwrap(),
            "581#4363600014D1FFFF   SDO 6063h\n            ^^"
        );
    }

    #[test]
    fn differing_identifier_is_marked() {
        assert_eq!(marked("581#00", "582#00").unwrap(), "582#00\n^^^");
    }

    #[test]
    fn frame_that_fits_has_no_marks() {
        assert_eq!(marked("581#4?.??", "581#4300"), None);
    }

    #[test]
    fn bytes_too_few_and_too_many_are_marked() {
        assert_eq!(marked("20 03 02", "20 03").unwrap(), "20 03\n      ^^");
        assert_eq!(marked("20 03", "20 03 FF").unwrap(), "20 03 FF\n      ^^");
    }

    #[test]
    fn remote_frame_for_a_data_frame_is_marked() {
        assert_eq!(marked("701#05", "701#R1").unwrap(), "701#R1\n    ^^");
    }

    #[test]
    fn words_are_left_alone() {
        let comparison = compare("581#43  an answer", "nothing within 50 ms");
        assert_eq!(comparison.came, "nothing within 50 ms");
        assert_eq!(comparison.expected, "581#43  an answer");
        assert_eq!(comparison.marks, None);
        assert_eq!(marked("grün", "581#43"), None);
        assert_eq!(marked("", ""), None);
    }
}
