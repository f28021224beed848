//! What the README shows is what one gets.

#![allow(clippy::unwrap_used)]

mod support;

use support::Folder;

const README: &str = include_str!("../../../README.md");

/// The blocks of the README in this language.
fn blocks(language: &str) -> Vec<&'static str> {
    let start = format!("```{language}\n");
    let parts = README.split(&start).skip(1);
    parts
        .map(|part| part.split("```").next().unwrap())
        .collect()
}

#[test]
fn suite_of_the_readme_is_one() {
    let folder = Folder::new();
    let [suite] = blocks("yaml")[..] else {
        unreachable!("the README shows one suite");
    };
    folder.write("my-drive.yaml", suite);
    let ran = folder.run(&["run", "my-drive.yaml"]);
    assert_eq!(ran.exit(), Some(0), "{}{}", ran.out(), ran.error());
}

/// Plays `call` and looks for every line of `shown` in what comes, but for the time it took.
fn comes_out(call: &str, skipped_words: usize, shown: &str) {
    let arguments: Vec<&str> = call
        .split_whitespace()
        .skip(skipped_words)
        .map(|word| word.trim_matches('\''))
        .collect();
    let came = Folder::new().run(&arguments).out();
    for line in shown.lines().filter(|line| *line != "[...]") {
        let line = line.split("played in").next().unwrap();
        assert!(came.contains(line), "no {line:?} in\n{came}");
    }
}

#[test]
fn run_of_the_readme_is_what_one_sees() {
    let blocks = blocks("console");
    let shown = blocks
        .iter()
        .find_map(|block| block.strip_prefix("$ cargo run --release -- run\n"));
    comes_out("run", 0, shown.unwrap());
}

#[test]
fn readme_counts_every_fault() {
    let kinds = fieldproof_devices::kinds();
    let count: usize = kinds.iter().map(|kind| kind.faults.len()).sum();
    assert!(README.contains(&format!("{count} of {count} faults are caught")));
}

#[test]
fn failing_case_of_the_readme_is_what_one_sees() {
    let blocks = blocks("console");
    let shown = blocks
        .iter()
        .find(|block| block.starts_with("$ fieldproof"));
    let (call, output) = shown.unwrap().split_once('\n').unwrap();
    comes_out(call, 2, output);
}
