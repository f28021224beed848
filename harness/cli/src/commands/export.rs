//! `fieldproof export`

use std::fs;
use std::path::Path;

use fieldproof_report::{Problem, Severity};

use crate::complaint::Complaint;
use crate::embedded;
use crate::exit::Exit;
use crate::screen::Screen;

/// Writes everything that the program carries below `folder`. If a file is there already, nothing is written, unless
/// `force`.
pub(crate) fn export(folder: &Path, force: bool, screen: &mut Screen) -> Result<Exit, Complaint> {
    let in_the_way: Vec<String> = embedded::files()
        .map(|(path, _)| folder.join(path))
        .filter(|path| path.exists())
        .map(|path| path.display().to_string())
        .collect();
    if let (Some(first), false) = (in_the_way.first(), force) {
        let problem = Problem::new(Severity::Error, "the file is there already")
            .in_file(first.clone())
            .note(format!("{} files are in the way", in_the_way.len()))
            .help("give another folder, or --force to overwrite");
        return Err(Complaint::input(problem));
    }
    let mut count = 0;
    for (path, text) in embedded::files() {
        let path = folder.join(path);
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent)
            .and_then(|()| fs::write(&path, text))
            .map_err(|error| Complaint::unwritable(path.display(), &error))?;
        count += 1;
    }
    screen.print(&format!("{count} files written to {}\n", folder.display()));
    Ok(Exit::Passed)
}
