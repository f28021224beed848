//! The door of a served device: what a bench does to it beside the bus comes in here.

use std::fs;
use std::io::{self, BufRead, BufReader, ErrorKind, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::time::Duration;

use fieldproof_link::real::serve::Control;
use fieldproof_link::{NotOffered, Stimulus};

use crate::stimulus_words::parse;

/// How long a client may take over its line.
const LINE_TIMEOUT: Duration = Duration::from_millis(500);

/// A socket that takes one stimulus a connection, as a line of words, and answers `done` or what is wrong with it.
pub(crate) struct ControlSocket {
    listener: UnixListener,
    path: PathBuf,
    client: Option<UnixStream>,
}

impl ControlSocket {
    /// A socket at `path`, which is removed at the end.
    pub(crate) fn listen(path: &Path) -> io::Result<ControlSocket> {
        // Left by a device that was killed: nobody listens there any more.
        if path.exists() && UnixStream::connect(path).is_err() {
            fs::remove_file(path)?;
        }
        let listener = UnixListener::bind(path)?;
        listener.set_nonblocking(true)?;
        Ok(ControlSocket {
            listener,
            path: path.to_owned(),
            client: None,
        })
    }
}

impl Drop for ControlSocket {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.path);
    }
}

impl Control for ControlSocket {
    fn next(&mut self) -> Option<Stimulus> {
        let mut client = match self.listener.accept() {
            Ok((client, _)) => client,
            Err(_) => return None,
        };
        let line = read_line(&client).ok()?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some(stimulus) = parse(&words) else {
            let _ = writeln!(client, "not understood: {}", line.trim());
            return None;
        };
        self.client = Some(client);
        Some(stimulus)
    }

    fn done(&mut self, outcome: Result<(), NotOffered>) {
        if let Some(mut client) = self.client.take() {
            let _ = match outcome {
                Ok(()) => writeln!(client, "{DONE}"),
                Err(error) => writeln!(client, "{error}"),
            };
        }
    }
}

/// What a stimulus that was given is answered with.
const DONE: &str = "done";

fn read_line(client: &UnixStream) -> io::Result<String> {
    client.set_nonblocking(false)?;
    client.set_read_timeout(Some(LINE_TIMEOUT))?;
    let mut line = String::new();
    BufReader::new(client).read_line(&mut line)?;
    Ok(line)
}

/// Has `stimulus`, as words, given to the device that listens at `path`.
///
/// # Errors
/// Nobody listens there, or the answer is not that it is done.
pub(crate) fn give(path: &Path, words: &[String]) -> io::Result<()> {
    let mut stream = UnixStream::connect(path)?;
    writeln!(stream, "{}", words.join(" "))?;
    let mut answer = String::new();
    BufReader::new(&stream).read_line(&mut answer)?;
    match answer.trim() {
        DONE => Ok(()),
        "" => Err(io::Error::new(
            ErrorKind::UnexpectedEof,
            "the device did not answer",
        )),
        other => Err(io::Error::other(other.to_owned())),
    }
}
