//! Runs the program in a folder of its own.

#![allow(dead_code, reason = "each test uses some of it")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fieldproof_record::{Entry, RunStarted, read_journal};
use tempfile::TempDir;

/// A folder that is gone afterwards.
pub(crate) struct Folder {
    folder: TempDir,
}

impl Folder {
    pub(crate) fn new() -> Folder {
        Folder {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn write(&self, path: &str, text: impl AsRef<[u8]>) {
        let path = self.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    pub(crate) fn read(&self, path: &str) -> String {
        fs::read_to_string(self.path().join(path)).unwrap()
    }

    /// The journal of the run whose reports are in `reports`.
    pub(crate) fn journal(&self) -> (RunStarted, Vec<Entry>) {
        read_journal(self.read("reports/run.jsonl").as_bytes()).unwrap()
    }

    /// The program, about to be run here. Nothing from outside decides on colours.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fieldproof"));
        command.args(arguments).current_dir(self.path());
        for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE", "COLUMNS"] {
            command.env_remove(name);
        }
        command
    }

    /// Another program, about to be run here.
    pub(crate) fn command_of(&self, program: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(self.path());
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Ran {
        Ran(self.command(arguments).output().unwrap())
    }

    /// Every file here, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut files = Vec::new();
        collect(self.path(), &mut files);
        let mut files: Vec<String> = files
            .iter()
            .map(|file| {
                file.strip_prefix(self.path())
                    .unwrap()
                    .display()
                    .to_string()
            })
            .collect();
        files.sort();
        files
    }
}

/// What the program came to.
pub(crate) struct Ran(pub(crate) Output);

impl Ran {
    pub(crate) fn exit(&self) -> Option<i32> {
        self.0.status.code()
    }

    pub(crate) fn out(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).unwrap()
    }

    pub(crate) fn error(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).unwrap()
    }
}

pub(crate) fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for entry in entries {
        match entry.is_dir() {
            true => collect(&entry, files),
            false => files.push(entry),
        }
    }
}

/// A suite for any CANopen device whose case reads 1000h and says what must come.
pub(crate) fn suite(id: &str, step: &str) -> String {
    format!(
        "language: 1
suite: {id}
title: A suite
protocol: canopen
sources:
  cia301: {{document: CiA 301 4.2.0}}
cases:
  - case: read
    title: Something is read
    cite: [cia301]
    steps:
      - {step}
"
    )
}
