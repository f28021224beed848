//! Files into suites: every file is read and every row of every table is checked once; a case is made from its row
//! again each time it is asked for, so that a suite of many rows stays small.

mod bench;
mod case;
mod catalogue;
mod check;
mod checks;
mod device;
mod fill;
mod registers;
mod rows;
mod suite;
mod waivers;

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

pub use bench::load_bench;
pub use catalogue::{load_catalogue, unknown_entries};
pub use device::{load_device, unknown_checks};
pub use fill::Columns;
pub use registers::load_registers;
pub use waivers::load_waivers;

use crate::expand::{Environment, Notation, Scope};
use crate::lines::Lines;
use crate::model::{Case, SuiteHead};
use crate::node::Node;
use crate::{Diagnostic, Position, Severity};

/// A file, already read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SourceFile {
    /// Its path as the user named it; diagnostics carry it.
    pub path: String,
    /// What stands in it.
    pub text: String,
}

/// What came of some files.
#[derive(Debug, Clone, Default)]
pub struct Loaded {
    /// The suites without errors, in the order of their files.
    pub suites: Vec<Suite>,
    /// Everything that is wrong, file by file, from top to bottom.
    pub diagnostics: Vec<Diagnostic>,
}

/// A suite that has been checked. Its copies share its cases.
#[derive(Debug, Clone)]
pub struct Suite {
    /// Its head.
    pub head: SuiteHead,
    /// The path of its file.
    pub path: String,
    text: Arc<str>,
    lines: Arc<Lines>,
    cases: Arc<[CaseTemplate]>,
}

/// A case as written.
#[derive(Debug, Clone)]
struct CaseTemplate {
    name: String,
    at: Position,
    /// Everything but the table.
    body: Node,
    rows: Vec<Node>,
    /// The rows could not be read, so that nothing can be said of what stands for a placeholder.
    without_rows: bool,
    /// The columns that name a case.
    key: Vec<String>,
    /// What the description of a device adds to every row.
    fillings: Vec<fill::Filling>,
    /// Samples stand for that until now.
    open: bool,
    /// What the description does not have, so that there is nothing to play.
    absent: Option<String>,
}

/// One case of a suite: a row of its table, or the whole of a case without one.
#[derive(Debug, Clone, Copy)]
pub struct CaseRef<'a> {
    suite: &'a Suite,
    template: &'a CaseTemplate,
    row: Option<&'a Node>,
}

/// Reads suites. All mistakes are found at once, in all files.
pub fn load(files: &[SourceFile]) -> Loaded {
    let mut loaded = Loaded::default();
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    for file in files {
        let (suite, mut diagnostics) = suite::read(file, &mut names);
        diagnostics.sort_by_key(|diagnostic| diagnostic.at);
        let usable = diagnostics
            .iter()
            .all(|diagnostic| diagnostic.severity == Severity::Warning);
        loaded.diagnostics.append(&mut diagnostics);
        loaded.suites.extend(suite.filter(|_| usable));
    }
    loaded
}

impl Suite {
    fn new(head: SuiteHead, file: &SourceFile, cases: Vec<CaseTemplate>) -> Suite {
        Suite {
            head,
            path: file.path.clone(),
            lines: Arc::new(Lines::of(&file.text)),
            text: Arc::from(file.text.as_str()),
            cases: cases.into(),
        }
    }

    /// Its cases, tables expanded, in the order of the file.
    pub fn cases(&self) -> impl Iterator<Item = CaseRef<'_>> {
        self.cases.iter().flat_map(move |template| {
            let whole = template.rows.is_empty().then_some(None);
            let most = if template.stands_for_many() {
                1
            } else {
                usize::MAX
            };
            let rows = template.rows.iter().map(Some).take(most);
            whole.into_iter().chain(rows).map(move |row| CaseRef {
                suite: self,
                template,
                row,
            })
        })
    }

    /// The named checks of its steps: a device description may deviate from these. `{column}` in a name stands for
    /// every value of that column.
    pub fn checks(&self) -> BTreeSet<String> {
        let mut checks = BTreeSet::new();
        for template in self.cases.iter() {
            checks::names(&template.body, &template.rows, &mut checks);
        }
        checks
    }

    /// The text of its file.
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// The text of a line of its file, counted from 1; empty if there is no such line.
    pub fn line_text(&self, line: u32) -> &str {
        self.lines.line(&self.text, line as usize)
    }
}

impl<'a> CaseRef<'a> {
    /// The suite it belongs to.
    pub fn suite(&self) -> &'a Suite {
        self.suite
    }

    /// `suite/case[key=value]`; without a table `suite/case`.
    pub fn id(&self) -> String {
        let mut id = self.written_id();
        let named = !self.template.key.is_empty() && !self.template.stands_for_many();
        if let Some(row) = self.row.filter(|_| named) {
            id.push_str(&case::row_key(row, &self.template.key));
        }
        id
    }

    /// `suite/case`: the case as written, before its table.
    pub fn written_id(&self) -> String {
        format!("{}/{}", self.suite.head.suite, self.template.name)
    }

    /// What the device would have to have for this case, if it does not.
    pub fn absent(&self) -> Option<&'a str> {
        self.template.absent.as_deref()
    }

    /// Whether it stands for as many cases as the description of a device gives; [`CaseRef::lower`] gives a sample.
    pub fn is_open(&self) -> bool {
        self.template.is_open()
    }

    /// Its title with the placeholders in it.
    pub fn title_as_written(&self) -> &'a str {
        let title = self.template.body.get("title").and_then(Node::text);
        title.unwrap_or_default()
    }

    /// A line of its file for people: with what its placeholders stand for, as far as that is known beforehand.
    pub fn written_out<'t>(&self, line: &'t str, environment: &Environment) -> Cow<'t, str> {
        let scope = Scope {
            row: self.row,
            environment: *environment,
            ..Scope::default()
        };
        let notation = match line.contains('#') {
            true => Notation::Hex,
            false => Notation::Text,
        };
        let out = scope.replace(line, notation, false);
        out.unwrap_or(Cow::Borrowed(line))
    }

    /// Where it stands in its file: its row, or its name.
    pub fn at(&self) -> Position {
        self.row.map_or(self.template.at, |row| row.at)
    }

    /// The case, ready to be played on a device.
    ///
    /// # Errors
    /// What cannot be read with this environment: a frame that is none with this node-ID, a `{node}` where the device
    /// has none.
    pub fn lower(&self, environment: &Environment) -> Result<Case, Vec<Diagnostic>> {
        let reads = Cell::new(case::MOST_READS);
        case::read(*self, environment, &reads).map_err(|problems| {
            let into_diagnostic =
                |problem: crate::problem::Problem| problem.into_diagnostic(&self.suite.path);
            problems.into_iter().map(into_diagnostic).collect()
        })
    }
}
