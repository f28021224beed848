//! The SHA-256 of every report, so that a later change shows: `sha256sum --check SHA256SUMS`.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;

use sha2::{Digest, Sha256};

use super::{keep, temporary};
use crate::complaint::Complaint;

/// The name of the manifest.
pub(super) const NAME: &str = "SHA256SUMS";

/// Writes the manifest of `files`, which are named from `folder`.
pub(super) fn write(folder: &Path, files: &[String]) -> Result<(), Complaint> {
    let write = || -> io::Result<()> {
        let mut out = io::BufWriter::new(temporary(folder)?);
        for name in files {
            let sum = of_file(&folder.join(name))?;
            writeln!(out, "{sum}  {name}")?;
        }
        keep(out, &folder.join(NAME))
    };
    write().map_err(|error| Complaint::unwritable(folder.join(NAME).display(), &error))
}

fn of_file(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let mut hash = Sha256::new();
    let mut piece = vec![0; 1 << 16];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(hexadecimal(&hash.finalize())),
            read => hash.update(&piece[..read]),
        }
    }
}

/// The SHA-256 of `bytes`.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

fn hexadecimal(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sum_is_that_of_the_standard() {
        assert_eq!(
            sha256(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}
