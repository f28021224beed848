//! `fieldproof new-device`

mod infer;
mod text;

use std::fs;
use std::path::{Path, PathBuf};

use fieldproof_dictionary::eds;
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::SourceFile;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::options::NewDeviceOptions;
use crate::problems;
use crate::screen::Screen;

/// A file that is copied beside the description.
struct Given {
    name: String,
    from: PathBuf,
    bytes: Vec<u8>,
}

impl Given {
    fn read(path: &Path) -> Result<Given, Complaint> {
        let fail = |message: String| {
            let problem = Problem::new(Severity::Error, message);
            Complaint::input(problem.in_file(path.display().to_string()))
        };
        let bytes = fs::read(path).map_err(|error| fail(format!("cannot be read: {error}")))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        Ok(Given {
            name: name.into_owned(),
            from: path.to_owned(),
            bytes,
        })
    }
}

/// Writes a description to start from into a folder. Nothing is written if a file is in the way.
pub(crate) fn new_device(
    options: &NewDeviceOptions,
    screen: &mut Screen,
) -> Result<Exit, Complaint> {
    let folder = &options.directory;
    let eds = options.eds.as_deref().map(Given::read).transpose()?;
    let registers = options.registers.as_deref().map(Given::read).transpose()?;
    if let Some(given) = &registers {
        check_registers(given)?;
    }
    let claims = eds.as_ref().map(claims).transpose()?;
    let name = name_of(folder);
    let device = text::Device {
        name: &name,
        eds: eds.as_ref().map(|given| given.name.as_str()),
        claims: claims.as_ref(),
        registers: registers.as_ref().map(|given| given.name.as_str()),
    };
    let mut files = vec![
        (
            "device.yaml".to_owned(),
            text::description(&device).into_bytes(),
        ),
        ("bench.yaml".to_owned(), text::bench(&device).into_bytes()),
    ];
    for given in [eds, registers].into_iter().flatten() {
        let there = folder.join(&given.name).canonicalize().ok();
        // It lies where it belongs already.
        if there.is_none() || there != given.from.canonicalize().ok() {
            files.push((given.name, given.bytes));
        }
    }
    nothing_in_the_way(folder, &files)?;
    fs::create_dir_all(folder).map_err(|error| Complaint::unwritable(folder.display(), &error))?;
    for (name, bytes) in &files {
        let path = folder.join(name);
        fs::write(&path, bytes).map_err(|error| Complaint::unwritable(path.display(), &error))?;
    }
    screen.print(&format!(
        "{} files written to {folder}\n\
         what no file can tell is marked NOT KNOWN in {folder}/device.yaml\n\
         next: fieldproof check {folder}\n      fieldproof run --device {folder} --dry-run\n\
         then: name its link in {folder}/bench.yaml\n      fieldproof run --bench {folder}/bench.yaml\n",
        files.len(),
        folder = folder.display(),
    ));
    Ok(Exit::Passed)
}

fn claims(given: &Given) -> Result<infer::Claims, Complaint> {
    let eds = eds::read(&eds::decode(&given.bytes));
    if eds.dictionary.objects().next().is_some() {
        return Ok(infer::Claims::of(&eds));
    }
    let problem = Problem::new(Severity::Error, "no object is described in this file")
        .in_file(given.from.display().to_string())
        .help("is it an EDS? That is a text with sections such as [DeviceInfo] and [1000]; `fieldproof eds check` says more");
    Err(Complaint::input(problem))
}

fn check_registers(given: &Given) -> Result<(), Complaint> {
    let file = SourceFile {
        path: given.from.display().to_string(),
        text: String::from_utf8_lossy(&given.bytes).into_owned(),
    };
    fieldproof_suite::load_registers(&file)
        .map(drop)
        .map_err(|diagnostics| {
            let text = file.text.as_str().into();
            let problems = diagnostics.iter();
            Complaint::inputs(
                problems
                    .map(|diagnostic| problems::of_diagnostic(diagnostic, &text))
                    .collect(),
            )
        })
}

fn nothing_in_the_way(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<(), Complaint> {
    let in_the_way = files.iter().map(|(name, _)| folder.join(name));
    match in_the_way.into_iter().find(|path| path.exists()) {
        None => Ok(()),
        Some(path) => Err(Complaint::input(
            Problem::new(Severity::Error, "the file is there already")
                .in_file(path.display().to_string())
                .help("give another folder, or remove the file"),
        )),
    }
}

/// The name of the folder, in lower-case words.
fn name_of(folder: &Path) -> String {
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let last = whole.file_name().unwrap_or_default().to_string_lossy();
    let words: Vec<String> = last
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_ascii_lowercase)
        .collect();
    match words.is_empty() {
        true => "device".to_owned(),
        false => words.join("-"),
    }
}
