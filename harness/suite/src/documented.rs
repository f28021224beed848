//! The examples in docs/suite-language.md, which must be what the language is.

use crate::{SourceFile, load, load_catalogue, load_device};

/// Every block of YAML in the document, made into a whole file: steps into a case, cases into a suite.
pub(crate) fn documented_files() -> Vec<String> {
    let document = include_str!("../../../docs/suite-language.md");
    let blocks = document.split("```yaml\n").skip(1);
    let blocks = blocks.filter_map(|block| block.split("```").next());
    let files: Vec<String> = blocks.map(whole_file).collect();
    assert!(files.len() > 8, "{} blocks", files.len());
    files
}

fn whole_file(block: &str) -> String {
    let indented = |spaces: &str| -> String {
        block
            .lines()
            .map(|line| format!("{spaces}{line}\n"))
            .collect()
    };
    let head = "language: 1\nsuite: example\ntitle: An example\nprotocol: gateway\nsources:\n  cia301: {document: CiA 301}\n  manual: {document: A manual}\ncases:\n";
    if block.starts_with("- case:") {
        return format!("{head}{}", indented("  "));
    }
    if block.starts_with("- ") {
        return format!(
            "{head}  - case: steps\n    title: Some steps\n    cite: manual\n    effects: [writes, resets, disturbs-bus, moves]\n    needs: [stimulus: power, stimulus: process-value, stimulus: condition, stimulus: setting]\n    steps:\n      - nmt: start\n      - expect-silence: 1 ms\n{}",
            indented("      ")
        );
    }
    block.to_owned()
}

#[test]
fn the_documented_examples_load() {
    for text in documented_files() {
        let file = SourceFile {
            path: "docs/suite-language.md".to_owned(),
            text,
        };
        let of_kind = |key: &str| file.text.contains(key);
        let diagnostics = if of_kind("\nsuite:") {
            load(std::slice::from_ref(&file)).diagnostics
        } else if of_kind("\ncatalogue:") {
            load_catalogue(&file).err().unwrap_or_default()
        } else {
            load_device(&file).err().unwrap_or_default()
        };
        assert!(diagnostics.is_empty(), "{}\n{diagnostics:#?}", file.text);
    }
}
