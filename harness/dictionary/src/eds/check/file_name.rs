//! The name of the file itself, which only who opened it knows.

use super::super::{Eds, Finding, rules};

/// What is wrong if the file is called `name`, without its folder. Capital and small letters are one, as some file
/// systems have it.
pub fn check_file_name(eds: &Eds, name: &str) -> Option<Finding> {
    let section = eds.section("FileInfo")?;
    let key = section.key("FileName")?;
    let said = key.value.trim();
    if said.is_empty() || said.eq_ignore_ascii_case(name) {
        return None;
    }
    Some(Finding::new(
        &rules::FILE_NAME,
        key.line,
        format!("FileName is {said}, but the file is called {name}"),
        "write the name that the file has where it is handed out",
    ))
}
