//! Reading files that a user names.

use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

use fieldproof_dictionary::eds;
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::SourceFile;

use crate::reports::manifest::sha256;

/// A larger file is not read: no suite is that large.
const LARGEST_BYTES: u64 = 16 * 1024 * 1024;
/// Folders below folders are followed so far, in case they go in a circle.
const DEEPEST: usize = 32;

/// Reads the bytes of the file at `path`.
pub(crate) fn read_bytes(path: &Path) -> Result<Vec<u8>, Box<Problem>> {
    let fail = |message: String| {
        Box::new(Problem::new(Severity::Error, message).in_file(path.display().to_string()))
    };
    let unreadable = |error: std::io::Error| fail(format!("cannot be read: {error}"));
    let too_large = || {
        fail(format!(
            "larger than {} MiB, which no suite is",
            LARGEST_BYTES / (1024 * 1024)
        ))
    };
    let meta = fs::metadata(path).map_err(unreadable)?;
    if meta.is_file() && meta.len() > LARGEST_BYTES {
        return Err(too_large());
    }
    // What is no plain file (a pipe, a device) tells no size beforehand.
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(unreadable)?;
    file.take(LARGEST_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(unreadable)?;
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err(too_large());
    }
    Ok(bytes)
}

/// Reads the text of the file at `path`.
pub(crate) fn read(path: &Path) -> Result<SourceFile, Box<Problem>> {
    let bytes = read_bytes(path)?;
    let shown = path.display().to_string();
    let fail =
        |message: String| Box::new(Problem::new(Severity::Error, message).in_file(shown.clone()));
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(fail("UTF-16 text; save it as UTF-8".to_owned()));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(SourceFile { path: shown, text }),
        Err(error) => {
            let at = error.utf8_error().valid_up_to();
            Err(fail(format!("not UTF-8 text: byte {at} is no character")))
        }
    }
}

/// Reads the EDS at `path`, which may be ISO 8859-1, as vendors have it; and the SHA-256 of its bytes.
pub(crate) fn read_eds(path: &Path) -> Result<(String, SourceFile), Box<Problem>> {
    let bytes = read_bytes(path)?;
    let text = eds::decode(&bytes);
    let path = path.display().to_string();
    Ok((sha256(&bytes), SourceFile { path, text }))
}

/// Every `*.yaml` and `*.yml` below `folder`, sorted by path. Links to folders are not followed.
pub(crate) fn yaml_below(folder: &Path) -> Result<Vec<PathBuf>, Box<Problem>> {
    let mut found = Vec::new();
    collect(folder, 0, &mut found)?;
    Ok(found)
}

fn collect(folder: &Path, depth: usize, found: &mut Vec<PathBuf>) -> Result<(), Box<Problem>> {
    let fail = |message: String| {
        Box::new(Problem::new(Severity::Error, message).in_file(folder.display().to_string()))
    };
    if depth > DEEPEST {
        return Err(fail(format!("folders are more than {DEEPEST} deep")));
    }
    let unreadable = |error: std::io::Error| fail(format!("cannot be read: {error}"));
    let mut entries = fs::read_dir(folder)
        .map_err(unreadable)?
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<PathBuf>, _>>()
        .map_err(unreadable)?;
    entries.sort();
    for entry in entries {
        let meta = fs::symlink_metadata(&entry).map_err(unreadable)?;
        if meta.is_dir() {
            collect(&entry, depth + 1, found)?;
        } else if is_yaml(&entry) {
            found.push(entry);
        }
    }
    Ok(())
}

/// Whether a file is named like a suite.
pub(crate) fn is_yaml(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension == "yaml" || extension == "yml")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_too_large_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large.yaml");
        // A hole in the file: it takes no room on the disk.
        File::create(&path)
            .unwrap()
            .set_len(LARGEST_BYTES + 1)
            .unwrap();
        let problem = read(&path).unwrap_err();
        assert_eq!(problem.message, "larger than 16 MiB, which no suite is");
        File::create(&path).unwrap().set_len(1_000).unwrap();
        assert_eq!(read(&path).unwrap().text.len(), 1_000);
    }

    #[test]
    fn bytes_that_are_no_text_are_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.yaml");
        fs::write(&path, b"suite: \xff").unwrap();
        assert_eq!(
            read(&path).unwrap_err().message,
            "not UTF-8 text: byte 7 is no character"
        );
    }

    #[test]
    fn other_encoding_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.yaml");
        for bytes in [b"\xff\xfel\0", b"\xfe\xff\0l"] {
            fs::write(&path, bytes).unwrap();
            let problem = read(&path).unwrap_err();
            assert_eq!(problem.message, "UTF-16 text; save it as UTF-8");
        }
    }

    #[test]
    fn endless_file_is_an_error() {
        let problem = read(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(problem.message, "larger than 16 MiB, which no suite is");
    }

    #[test]
    fn suites_below_a_folder_are_found_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("b");
        fs::create_dir(&below).unwrap();
        for name in ["c.yaml", "a.yml", "b/d.yaml", "b/no.txt"] {
            fs::write(folder.path().join(name), "").unwrap();
        }
        let found: Vec<_> = yaml_below(folder.path())
            .unwrap()
            .iter()
            .map(|path| {
                path.strip_prefix(folder.path())
                    .unwrap()
                    .display()
                    .to_string()
            })
            .collect();
        assert_eq!(found, ["a.yml", "b/d.yaml", "c.yaml"]);
    }
}
