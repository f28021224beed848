//! The lines of a text, found by number.

/// Where each line of a text starts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lines {
    /// In bytes; a text has less than 4 GiB.
    starts: Vec<u32>,
}

impl Lines {
    pub(crate) fn of(text: &str) -> Lines {
        let starts = text.match_indices('\n').map(|(end, _)| end as u32 + 1);
        Lines {
            starts: std::iter::once(0).chain(starts).collect(),
        }
    }

    /// The line with this number, from 1, of the same text; empty if there is none.
    pub(crate) fn line<'t>(&self, text: &'t str, number: usize) -> &'t str {
        let start = number
            .checked_sub(1)
            .and_then(|index| self.starts.get(index));
        let end = self
            .starts
            .get(number)
            .map_or(text.len(), |end| *end as usize);
        let line = start.and_then(|start| text.get(*start as usize..end));
        line.unwrap_or_default().trim_end_matches(['\r', '\n'])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_found_by_number() {
        let text = "one\r\ntwo\n\nfour";
        let lines = Lines::of(text);
        let found: Vec<&str> = (0..6).map(|number| lines.line(text, number)).collect();
        assert_eq!(found, ["", "one", "two", "", "four", ""]);
    }
}
