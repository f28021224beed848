//! Patterns for the ids of cases.

/// Whether `text` is like `pattern`, in which `*` stands for any characters, also none, and `?` for one. Brackets
/// stand for themselves, for ids have them.
pub(crate) fn matches(pattern: &str, text: &str) -> bool {
    let (pattern, text): (Vec<char>, Vec<char>) =
        (pattern.chars().collect(), text.chars().collect());
    let (mut at, mut in_text) = (0, 0);
    // Where the last `*` was, and up to where it reached.
    let mut star: Option<(usize, usize)> = None;
    while in_text < text.len() {
        match pattern.get(at) {
            Some('*') => {
                star = Some((at, in_text));
                at += 1;
            }
            Some(character) if *character == '?' || *character == text[in_text] => {
                at += 1;
                in_text += 1;
            }
            _ => match star {
                Some((place, reached)) => {
                    star = Some((place, reached + 1));
                    at = place + 1;
                    in_text = reached + 1;
                }
                None => return false,
            },
        }
    }
    pattern[at..].iter().all(|character| *character == '*')
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn star_stands_for_anything() {
        for (pattern, text, expected) in [
            (
                "canopen.nmt/*",
                "canopen.nmt/transition[from=stopped]",
                true,
            ),
            ("*transition*", "canopen.nmt/transition[from=stopped]", true),
            (
                "*[from=stopped]",
                "canopen.nmt/transition[from=stopped]",
                true,
            ),
            (
                "*[from=s?opped]",
                "canopen.nmt/transition[from=stopped]",
                true,
            ),
            ("canopen.nmt", "canopen.nmt/transition", false),
            ("*x*", "canopen.nmt/transition", false),
            ("", "", true),
            ("*", "", true),
            ("?", "", false),
            ("*ab*ab", "abxabab", true),
        ] {
            assert_eq!(matches(pattern, text), expected, "{pattern} {text}");
        }
    }

    /// The definition, which takes exponential time.
    fn slowly(pattern: &[char], text: &[char]) -> bool {
        match (pattern, text) {
            ([], []) => true,
            (['*', rest @ ..], _) => {
                slowly(rest, text) || (!text.is_empty() && slowly(pattern, &text[1..]))
            }
            (['?', rest @ ..], [_, text @ ..]) => slowly(rest, text),
            ([one, rest @ ..], [other, text @ ..]) => one == other && slowly(rest, text),
            _ => false,
        }
    }

    proptest! {
        #[test]
        fn same_as_the_definition(pattern in "[ab*?]{0,8}", text in "[ab]{0,10}") {
            let (p, t): (Vec<char>, Vec<char>) = (pattern.chars().collect(), text.chars().collect());
            prop_assert_eq!(matches(&pattern, &text), slowly(&p, &t));
        }
    }
}
