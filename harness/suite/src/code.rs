//! The codes of the diagnostics. Each has a section in docs/diagnostics.md and a file in fixtures/suites-invalid.

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $name:ident = $code:literal;)+) => {
        $($(#[doc = $doc])+ pub(crate) const $name: &str = $code;)+

        /// All codes, in order.
        pub const ALL: &[&str] = &[$($code),+];
    };
}

codes! {
    /// Not YAML.
    NOT_YAML = "S001";
    /// A tab where the line is indented.
    TAB = "S002";
    /// The same key twice in one map.
    DUPLICATE_KEY = "S003";
    /// An anchor, an alias, a merge key or a tag.
    REFERENCE = "S004";
    /// Nested too deep.
    TOO_DEEP = "S005";
    /// Too long a text, or too many nodes.
    TOO_LARGE = "S006";
    /// No document, or more than one.
    ONE_DOCUMENT = "S007";
    /// A key that is not a word.
    KEY_NOT_A_WORD = "S008";

    /// A key that does not belong here.
    UNKNOWN_KEY = "S010";
    /// A key that must be here.
    MISSING_KEY = "S011";
    /// A list, a map or a text where something else belongs.
    WRONG_SHAPE = "S012";
    /// A verb that does not exist.
    UNKNOWN_VERB = "S013";
    /// A step that is not a map with one key.
    NOT_A_STEP = "S014";
    /// A word that is not one of those that may stand here.
    UNKNOWN_WORD = "S015";
    /// Another version of the language.
    LANGUAGE = "S016";
    /// Keys of one map that do not go together.
    KEYS_TOGETHER = "S017";

    /// Not a duration.
    DURATION = "S020";
    /// Not a bit rate.
    RATE = "S021";
    /// Not a whole number, or out of range.
    NUMBER = "S022";
    /// Not an object.
    OBJECT = "S023";
    /// Not a frame, or not an identifier.
    FRAME = "S024";
    /// Not bytes.
    BYTES = "S025";
    /// A value that its type cannot hold.
    DOES_NOT_FIT = "S026";
    /// Not a decimal number or a scale.
    DECIMAL = "S027";
    /// Not a limit with a tolerance.
    TOLERANCE = "S028";

    /// A name that is not lower-case words.
    NAME = "S030";
    /// Two cases with one id.
    DUPLICATE_CASE = "S031";
    /// Two suites with one name.
    DUPLICATE_SUITE = "S032";
    /// A source that the file does not define.
    UNKNOWN_SOURCE = "S033";
    /// A placeholder that stands for nothing.
    UNKNOWN_PLACEHOLDER = "S034";
    /// A key column that the table does not have.
    KEY_COLUMN = "S035";
    /// Two rows with the same key.
    ROWS_NOT_UNIQUE = "S036";
    /// A column that nothing uses.
    UNUSED_COLUMN = "S037";
    /// Rows with different columns, or no rows.
    TABLE = "S038";
    /// A saved name that is used before it is saved.
    NOT_YET_SAVED = "S039";

    /// No steps, or no cases.
    EMPTY = "S040";
    /// A case that can never fail.
    NEVER_FAILS = "S041";
    /// An expectation that can never be met.
    NEVER_MET = "S042";
    /// An effect or a stimulus that is not declared.
    UNDECLARED = "S043";
    /// A verb that the suite's protocol does not have.
    WRONG_PROTOCOL = "S044";

    /// A port that a side of the device needs.
    NO_PORT = "S050";
    /// A deviation from a check that no suite has.
    UNKNOWN_CHECK = "S051";

    /// Not a link.
    LINK = "S060";
    /// Two devices of a bench with one name.
    DUPLICATE_DEVICE = "S061";
    /// A line or adapter that two ports of a bench are connected to.
    LINK_IN_USE = "S062";

    /// Two entries of a catalogue with one number.
    DUPLICATE_ENTRY = "S070";
    /// An entry or a catalogue that there is not.
    UNKNOWN_ENTRY = "S071";
}
