//! The cases, packed: gzip in base64, in elements that a browser does not run.

use std::io::{self, Read, Seek, SeekFrom, Write};

use flate2::Compression;
use flate2::write::GzEncoder;
use serde::Serialize;

use super::exchange::Detail;

/// What the list of cases shows of one.
#[derive(Debug, Serialize)]
pub(super) struct Listed {
    /// The part of its id after the suite's.
    pub(super) name: String,
    pub(super) title: String,
    /// By its place in [`fieldproof_record::Verdict::ALL`].
    pub(super) verdict: usize,
    pub(super) duration_us: u64,
    pub(super) reason: String,
}

/// A case that is over.
#[derive(Debug)]
pub(super) struct Finished {
    pub(super) listed: Listed,
    pub(super) detail: Detail,
}

/// So much is unpacked at once when a case is looked at.
const PIECE_BYTES: usize = 400_000;

type Gzip = GzEncoder<Vec<u8>>;

fn gzip() -> Gzip {
    GzEncoder::new(Vec::new(), Compression::new(6))
}

/// The cases of all lanes.
pub(super) struct Packed<S> {
    spool: S,
    index: Gzip,
    /// The index has a group already, and this group a case.
    has: (bool, bool),
    lanes: Vec<String>,
    /// The lane and the suite of the group that is open.
    group: Option<(usize, String)>,
    cases: u64,
    /// The exchanges of the piece that is open, each followed by a comma.
    piece: Vec<u8>,
    /// The first case of each piece.
    firsts: Vec<u64>,
}

impl<S: Read + Write + Seek> Packed<S> {
    pub(super) fn new(spool: S) -> Packed<S> {
        Packed {
            spool,
            index: gzip(),
            has: (false, false),
            lanes: Vec::new(),
            group: None,
            cases: 0,
            piece: Vec::new(),
            firsts: vec![0],
        }
    }

    /// How many there are: the number of the next.
    pub(super) fn cases(&self) -> u64 {
        self.cases
    }

    pub(super) fn begin_lane(&mut self, device: &str) {
        self.lanes.push(device.to_owned());
    }

    pub(super) fn begin_suite(&mut self, suite: &str, title: &str) {
        self.end_group();
        let lane = self.lanes.len().saturating_sub(1);
        let head = serde_json::json!([lane, suite, title]).to_string();
        let before = if self.has.0 { "," } else { "[" };
        // Writing to memory cannot fail.
        let _ = write!(self.index, "{before}[{},[", &head[1..head.len() - 1]);
        self.has = (true, false);
        self.group = Some((lane, suite.to_owned()));
    }

    fn end_group(&mut self) {
        if self.group.take().is_some() {
            let _ = self.index.write_all(b"]]");
        }
    }

    pub(super) fn case(&mut self, case: &Finished) -> io::Result<()> {
        if self.group.is_none() {
            self.begin_suite("", "");
        }
        let it = &case.listed;
        if std::mem::replace(&mut self.has.1, true) {
            let _ = self.index.write_all(b",");
        }
        let row = (&it.name, &it.title, it.verdict, it.duration_us, &it.reason);
        let _ = serde_json::to_writer(&mut self.index, &row);
        serde_json::to_writer(&mut self.piece, &case.detail)?;
        self.piece.push(b',');
        self.cases += 1;
        if self.piece.len() >= PIECE_BYTES {
            self.end_piece()?;
        }
        Ok(())
    }

    fn end_piece(&mut self) -> io::Result<()> {
        let mut piece = gzip();
        piece.write_all(b"[")?;
        piece.write_all(&self.piece)?;
        piece.write_all(b"null]")?;
        self.piece.clear();
        let number = self.firsts.len() - 1;
        element(
            &mut self.spool,
            &format!("piece-{number}"),
            &piece.finish()?,
        )?;
        self.firsts.push(self.cases);
        Ok(())
    }

    /// Writes everything as elements.
    pub(super) fn finish(mut self, out: &mut impl Write) -> io::Result<()> {
        self.end_group();
        self.end_piece()?;
        if !self.has.0 {
            self.index.write_all(b"[")?;
        }
        self.index.write_all(b"]")?;
        element(out, "index", &self.index.finish()?)?;
        let about = serde_json::json!({"lanes": self.lanes, "firsts": self.firsts});
        let about = about.to_string().replace('<', "\\u003c");
        writeln!(
            out,
            "<script type=\"application/json\" id=\"about\">{about}</script>"
        )?;
        self.spool.flush()?;
        self.spool.seek(SeekFrom::Start(0))?;
        io::copy(&mut self.spool, out)?;
        Ok(())
    }
}

/// An element with `bytes` in base64.
fn element(out: &mut impl Write, id: &str, bytes: &[u8]) -> io::Result<()> {
    write!(out, "<script type=\"text/plain\" id=\"{id}\">")?;
    out.write_all(base64(bytes).as_bytes())?;
    out.write_all(b"</script>\n")
}

/// RFC 4648, with padding.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |index: usize| u32::from(three.get(index).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for digit in 0..4 {
            let value = (bits >> (18 - 6 * digit)) & 0x3F;
            text.push(match digit <= three.len() {
                true => char::from(DIGITS[value as usize]),
                false => '=',
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
