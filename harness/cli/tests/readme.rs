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

#[test]
fn failing_case_of_the_readme_is_what_one_sees() {
    let shown: Vec<&str> = blocks("console")
        .into_iter()
        .filter(|block| block.starts_with("$ fieldproof"))
        .collect();
    assert_eq!(shown.len(), 1);
    for block in shown {
        let (call, output) = block.split_once('\n').unwrap();
        let arguments: Vec<String> = call
            .split_whitespace()
            .skip(2)
            .map(|word| word.trim_matches('\'').to_owned())
            .collect();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let folder = Folder::new();
        let came = folder.run(&arguments).out();
        for line in output.lines().filter(|line| *line != "[...]") {
            let line = line.split("played in").next().unwrap();
            assert!(came.contains(line), "no {line:?} in\n{came}");
        }
    }
}
