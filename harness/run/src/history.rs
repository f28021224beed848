//! What a case has done to the device, in words: the first line of a failure says after what it came.

/// How many of the last deeds a failure names.
const NAMED: usize = 3;

/// What a case has last done to the device, the last deed last. The same deed done several times in a row is one.
#[derive(Debug, Default)]
pub(crate) struct History(Vec<String>);

impl History {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn add(&mut self, deed: String) {
        if self.0.last() != Some(&deed) {
            self.0.push(deed);
            let too_many = self.0.len().saturating_sub(NAMED);
            self.0.drain(..too_many);
        }
    }

    /// `what; after NMT reset node 10`
    pub(crate) fn tell(&self, what: &str) -> String {
        match self.0.as_slice() {
            [] => what.to_owned(),
            last => format!("{what}; after {}", last.join(", then ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_names_the_last_deeds() {
        let mut history = History::default();
        assert_eq!(history.tell("no SYNC came"), "no SYNC came");
        for deed in ["NMT stop node 10", "RPDO1", "SYNC", "SYNC", "TIME"] {
            history.add(deed.into());
        }
        assert_eq!(
            history.tell("no SYNC came"),
            "no SYNC came; after RPDO1, then SYNC, then TIME"
        );
    }
}
