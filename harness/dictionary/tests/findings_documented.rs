//! Every code has its section in docs/eds-findings.md, and every section its code.

use std::collections::BTreeSet;

use fieldproof_dictionary::eds::RULES;

const DOCUMENT: &str = include_str!("../../../docs/eds-findings.md");

#[test]
fn every_code_is_documented_once() {
    let documented: Vec<&str> = DOCUMENT
        .lines()
        .filter_map(|line| line.strip_prefix("### "))
        .collect();
    let titles: Vec<String> = RULES
        .iter()
        .map(|rule| format!("{} {}", rule.code, rule.title))
        .collect();
    assert_eq!(documented, titles);
    let codes: BTreeSet<&str> = RULES.iter().map(|rule| rule.code).collect();
    assert_eq!(codes.len(), RULES.len());
}

#[test]
fn severity_is_documented() {
    for rule in RULES {
        let (_, section) = DOCUMENT.split_once(&format!("### {} ", rule.code)).unwrap();
        let text = section.lines().nth(1).unwrap();
        let word = format!("{:?}.", rule.severity);
        assert!(
            text.starts_with(&word),
            "{}: `{text}` does not start with `{word}`",
            rule.code
        );
    }
}
