//! Stimuli as words: for the command of a bench, and for a served device.

use fieldproof_link::Stimulus;

/// `power on`, `process-value 6063:00 -12013`, `condition local-control on`, `setting node 5`.
pub(crate) fn words(stimulus: &Stimulus) -> Vec<String> {
    let on_or_off = |on: bool| if on { "on" } else { "off" }.to_owned();
    let (kind, name, value) = match stimulus {
        Stimulus::Power { on } => return vec!["power".to_owned(), on_or_off(*on)],
        Stimulus::ProcessValue { name, value } => ("process-value", name, value.to_string()),
        Stimulus::Condition { name, active } => ("condition", name, on_or_off(*active)),
        Stimulus::Setting { name, value } => ("setting", name, value.to_string()),
    };
    vec![kind.to_owned(), name.clone(), value]
}

/// The stimulus that these words say.
pub(crate) fn parse(words: &[&str]) -> Option<Stimulus> {
    let on = |word: &str| match word {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    };
    Some(match words {
        ["power", word] => Stimulus::Power { on: on(word)? },
        ["process-value", name, value] => Stimulus::ProcessValue {
            name: (*name).to_owned(),
            value: value.parse().ok()?,
        },
        ["condition", name, word] => Stimulus::Condition {
            name: (*name).to_owned(),
            active: on(word)?,
        },
        ["setting", name, value] => Stimulus::Setting {
            name: (*name).to_owned(),
            value: value.parse().ok()?,
        },
        _ => return None,
    })
}

/// What an operator is asked to do.
pub(crate) fn request(stimulus: &Stimulus) -> String {
    match stimulus {
        Stimulus::Power { on: true } => "switch the power on".to_owned(),
        Stimulus::Power { on: false } => "switch the power off".to_owned(),
        Stimulus::ProcessValue { name, value } => {
            format!("bring the process value {name} to {value}")
        }
        Stimulus::Condition { name, active: true } => {
            format!("bring the condition {name} about")
        }
        Stimulus::Condition {
            name,
            active: false,
        } => format!("end the condition {name}"),
        Stimulus::Setting { name, value } => format!("set {name} to {value}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_stimulus_is_read_as_it_is_written() {
        let name = "local-control".to_owned();
        let value = -12_013;
        let stimuli = [
            Stimulus::Power { on: true },
            Stimulus::Power { on: false },
            Stimulus::ProcessValue {
                name: name.clone(),
                value,
            },
            Stimulus::Condition {
                name: name.clone(),
                active: true,
            },
            Stimulus::Setting { name, value },
        ];
        for stimulus in stimuli {
            let words = words(&stimulus);
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            assert_eq!(parse(&words), Some(stimulus), "{words:?}");
        }
        for wrong in [
            &["power"][..],
            &["power", "up"],
            &["setting", "node", "x"],
            &[],
        ] {
            assert_eq!(parse(wrong), None, "{wrong:?}");
        }
    }
}
