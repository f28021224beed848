//! What the README shows is what one gets. `UPDATE_GOLDEN=1` puts the numbers right that have changed.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::path::PathBuf;
use std::sync::{LazyLock, Mutex};
use std::{env, fs};

use support::Folder;

static README: LazyLock<String> = LazyLock::new(|| fs::read_to_string(path()).unwrap());

/// Held while the README is put right.
static FILE: Mutex<()> = Mutex::new(());

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../README.md")
}

/// The blocks of the README in this language.
fn blocks(language: &str) -> Vec<&'static str> {
    let start = format!("```{language}\n");
    let parts = README.split(&start).skip(1);
    parts
        .map(|part| part.split("```").next().unwrap())
        .collect()
}

/// What is left of a line without its numbers.
fn shape(line: &str) -> String {
    line.chars()
        .filter(|c| !c.is_ascii_digit() && !c.is_whitespace())
        .collect()
}

/// `shown` in the README becomes `right`, if that is wanted; else the test fails.
fn put_right(shown: &str, right: Option<&str>, came: &str) {
    let wanted = env::var_os("UPDATE_GOLDEN").is_some();
    let Some(right) = right.filter(|_| wanted) else {
        panic!("no {shown:?} in\n{came}");
    };
    let _guard = FILE.lock().unwrap();
    let readme = fs::read_to_string(path()).unwrap();
    fs::write(path(), readme.replacen(shown, right, 1)).unwrap();
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
        let part = line.split("played in").next().unwrap();
        if !came.contains(part) {
            let right = came.lines().find(|came| shape(came) == shape(line));
            put_right(line, right, &came);
        }
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
fn failing_case_of_the_readme_is_what_one_sees() {
    let blocks = blocks("console");
    let shown = blocks
        .iter()
        .find(|block| block.starts_with("$ fieldproof"));
    let (call, output) = shown.unwrap().split_once('\n').unwrap();
    comes_out(call, 2, output);
}
