//! Puts the suites and the device descriptions into the program, so that it works from any folder.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The folder in the project, what it is called in the program, and the files that are taken.
const FOLDERS: [(&str, &str, &[&str]); 3] = [
    ("suites", "suites", &["yaml"]),
    ("catalogues", "catalogues", &["yaml"]),
    (
        "fixtures/devices",
        "devices",
        &["yaml", "eds", "objects", "registers"],
    ),
];

fn main() -> io::Result<()> {
    let here = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let root = here.join("../..").canonicalize()?;
    let mut table =
        "/// Path in the program and text, sorted by path.\nconst FILES: &[(&str, &str)] = &[\n"
            .to_owned();
    for (folder, name, extensions) in FOLDERS {
        let folder = root.join(folder);
        for file in files_below(&folder)? {
            let extension = file.extension().and_then(|extension| extension.to_str());
            if !extension.is_some_and(|extension| extensions.contains(&extension)) {
                continue;
            }
            let parts: Vec<_> = file
                .strip_prefix(&folder)
                .unwrap_or(&file)
                .iter()
                .map(|part| part.to_string_lossy())
                .collect();
            let relative = format!("{name}/{}", parts.join("/"));
            // Writing to a string cannot fail.
            let _ = writeln!(table, "    ({relative:?}, include_str!({file:?})),");
        }
    }
    table.push_str("];\n");
    let out = PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default());
    fs::write(out.join("embedded.rs"), table)
}

/// Every file below `folder`, sorted; none if there is no such folder.
fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let mut found = Vec::new();
    let mut entries: Vec<PathBuf> = match fs::read_dir(folder) {
        Ok(entries) => entries
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<Result<_, _>>()?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(found),
        Err(error) => return Err(error),
    };
    entries.sort();
    for entry in entries {
        match entry.is_dir() {
            true => found.extend(files_below(&entry)?),
            false => found.push(entry),
        }
    }
    Ok(found)
}
