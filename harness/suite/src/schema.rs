//! The JSON Schemas that editors use. They are made from the types that files are read into, and then widened by what
//! is true of every scalar: a number may be written `64h`, and in a case a placeholder may stand anywhere.

use schemars::SchemaGenerator;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

use crate::catalogue::Catalogue;
use crate::file::{BenchFile, DeviceFile, RegistersFile, SuiteFile};
use crate::waivers::Waivers;

/// The JSON Schema (draft 2020-12) of suite files.
pub fn schema() -> Value {
    let mut schema = generator().into_root_schema_for::<SuiteFile>().to_value();
    widen_scalars(&mut schema);
    if let Some(definitions) = schema.get_mut("$defs").and_then(Value::as_object_mut) {
        if let Some(step) = definitions.get_mut("Step") {
            verbs_are_keys(step);
        }
        for (name, definition) in definitions.iter_mut() {
            if !matches!(name.as_str(), "Source" | "Protocol" | "Row") {
                allow_placeholders(definition);
            }
        }
        definitions.insert(
            "Placeholder".to_owned(),
            json!({
                "description": "A text with `{column}`, `{node}`, `{address}` or the name of a saved value in it.",
                "type": "string",
                "pattern": "\\{[^{}]+\\}"
            }),
        );
    }
    schema
}

/// The JSON Schema (draft 2020-12) of device descriptions.
pub fn device_schema() -> Value {
    let mut schema = generator().into_root_schema_for::<DeviceFile>().to_value();
    widen_scalars(&mut schema);
    schema
}

/// The JSON Schema (draft 2020-12) of register maps.
pub fn registers_schema() -> Value {
    let mut schema = generator()
        .into_root_schema_for::<RegistersFile>()
        .to_value();
    widen_scalars(&mut schema);
    schema
}

/// The JSON Schema (draft 2020-12) of benches.
pub fn bench_schema() -> Value {
    let mut schema = generator().into_root_schema_for::<BenchFile>().to_value();
    widen_scalars(&mut schema);
    schema
}

/// The JSON Schema (draft 2020-12) of catalogues.
pub fn catalogue_schema() -> Value {
    let mut schema = generator().into_root_schema_for::<Catalogue>().to_value();
    widen_scalars(&mut schema);
    schema
}

/// The JSON Schema (draft 2020-12) of files of accepted failures.
pub fn waivers_schema() -> Value {
    let mut schema = generator().into_root_schema_for::<Waivers>().to_value();
    widen_scalars(&mut schema);
    schema
}

fn generator() -> SchemaGenerator {
    SchemaSettings::draft2020_12().into_generator()
}

/// Numbers may be written as texts (`64h`), and what YAML takes for a number may be meant as a text (`section: 4.10`).
fn widen_scalars(schema: &mut Value) {
    match schema {
        Value::Array(parts) => parts.iter_mut().for_each(widen_scalars),
        Value::Object(object) => {
            object.remove("format");
            let kind = object.get("type").cloned();
            let is = |name: &str| {
                let one = kind.as_ref().and_then(Value::as_str) == Some(name);
                let many = kind.as_ref().and_then(Value::as_array);
                one || many.is_some_and(|kinds| kinds.iter().any(|kind| kind == name))
            };
            let free_text = !["pattern", "const", "enum"]
                .iter()
                .any(|key| object.contains_key(*key));
            if is("integer") && !is("string") {
                add_kind(object, "string");
                let number = "^-?(0x[0-9A-Fa-f]+|[0-9A-Fa-f]+h|[0-9]+)$";
                object.insert("pattern".to_owned(), number.into());
            } else if is("string") && free_text {
                add_kind(object, "number");
            }
            object
                .iter_mut()
                .filter(|(key, _)| key.as_str() != "type")
                .for_each(|(_, value)| widen_scalars(value));
        }
        _ => {}
    }
}

fn add_kind(object: &mut Map<String, Value>, kind: &str) {
    let mut kinds = match object.get("type") {
        Some(Value::Array(kinds)) => kinds.clone(),
        Some(one) => vec![one.clone()],
        None => Vec::new(),
    };
    if !kinds.iter().any(|known| known == kind) {
        kinds.push(kind.into());
    }
    object.insert("type".to_owned(), Value::Array(kinds));
}

/// A verb that takes nothing is a key, too.
fn verbs_are_keys(step: &mut Value) {
    let Some(verbs) = step.get_mut("oneOf").and_then(Value::as_array_mut) else {
        return;
    };
    for verb in verbs {
        let Some(name) = verb.get("const").and_then(Value::as_str) else {
            continue;
        };
        *verb = json!({
            "description": verb.get("description"),
            "type": "object",
            "properties": {name: {"type": "null"}},
            "required": [name],
            "additionalProperties": false
        });
    }
}

/// Lets a placeholder stand for any value in a map or a list.
fn allow_placeholders(schema: &mut Value) {
    match schema {
        Value::Array(parts) => parts.iter_mut().for_each(allow_placeholders),
        Value::Object(object) => {
            for key in ["anyOf", "oneOf", "allOf"] {
                if let Some(parts) = object.get_mut(key) {
                    allow_placeholders(parts);
                }
            }
            if let Some(items) = object.get_mut("items") {
                or_placeholder(items);
            }
            if let Some(properties) = object.get_mut("properties").and_then(Value::as_object_mut) {
                properties.values_mut().for_each(or_placeholder);
            }
        }
        _ => {}
    }
}

fn or_placeholder(schema: &mut Value) {
    allow_placeholders(schema);
    let mut with = Map::new();
    if let Some(object) = schema.as_object_mut() {
        for key in ["description", "default"] {
            with.extend(object.remove_entry(key));
        }
    }
    let placeholder = json!({"$ref": "#/$defs/Placeholder"});
    with.insert("anyOf".to_owned(), json!([schema.take(), placeholder]));
    *schema = Value::Object(with);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documented::documented_files;
    use crate::node::{Kind, Node};
    use crate::yaml;

    /// As an editor sees it, which types scalars by the core schema of YAML.
    fn as_json(node: &Node) -> Value {
        match &node.kind {
            Kind::Empty => Value::Null,
            Kind::Text(text) => serde_json::from_str::<serde_json::Number>(text)
                .map(Value::Number)
                .or_else(|_| text.parse::<bool>().map(Value::Bool))
                .unwrap_or_else(|_| Value::String(text.to_string())),
            Kind::List(elements) => elements.iter().map(as_json).collect(),
            Kind::Map(entries) => entries
                .iter()
                .map(|entry| (entry.key.text.to_string(), as_json(&entry.value)))
                .collect(),
        }
    }

    fn errors(schema: &Value, text: &str) -> Vec<String> {
        let validator = jsonschema::validator_for(schema).unwrap();
        let json = as_json(&yaml::read("t", text).unwrap());
        let errors = validator.iter_errors(&json);
        errors
            .map(|error| format!("{} {error}", error.instance_path()))
            .collect()
    }

    #[test]
    fn the_language_as_documented_follows_its_schema() {
        for file in documented_files() {
            let schema = match file {
                _ if file.contains("\nsuite:") => schema(),
                _ if file.contains("\ncatalogue:") => catalogue_schema(),
                _ => device_schema(),
            };
            assert_eq!(errors(&schema, &file), Vec::<String>::new(), "{file}");
        }
    }

    /// The YAML files in `folder` and below, sorted.
    #[allow(clippy::disallowed_methods, reason = "a test of the files beside it")]
    fn yaml_files(folder: &std::path::Path) -> Vec<String> {
        let mut paths: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        paths.sort();
        let mut texts = Vec::new();
        for path in paths {
            if path.is_dir() {
                texts.extend(yaml_files(&path));
            } else if path.extension().is_some_and(|ending| ending == "yaml") {
                texts.push(std::fs::read_to_string(path).unwrap());
            }
        }
        texts
    }

    #[test]
    fn what_is_shipped_follows_its_schema() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for (folder, schema) in [("suites", schema()), ("fixtures/devices", device_schema())] {
            let texts = yaml_files(&root.join(folder));
            assert!(texts.len() > 3, "{} files in {folder}", texts.len());
            for text in texts {
                let says = |key: &str| text.lines().any(|line| line.starts_with(key));
                let schema = match (says("bench:"), says("registers:")) {
                    (true, _) => &bench_schema(),
                    (_, true) => &registers_schema(),
                    _ => &schema,
                };
                assert_eq!(errors(schema, &text), Vec::<String>::new(), "{text}");
            }
        }
    }

    #[test]
    fn every_verb_is_documented() {
        let document = documented_files().join("\n");
        let schema = schema();
        let verbs = schema["$defs"]["Step"]["oneOf"].as_array().unwrap();
        assert!(verbs.len() > 15, "{verbs:?}");
        for verb in verbs {
            let verb = verb["required"][0].as_str().unwrap();
            assert!(document.contains(&format!("- {verb}:")), "{verb}");
        }
    }

    #[test]
    fn the_schema_of_benches_refuses_what_the_reader_refuses() {
        let bench = |device: &str| {
            format!("language: 1\nbench: a\ndevices:\n  - {{name: a, device: ., {device}}}\n")
        };
        let good = bench("ports: {can: 'slcan:/dev/ttyACM0', serial: 'tcp:host:502'}, node: 7Fh");
        assert_eq!(errors(&bench_schema(), &good), Vec::<String>::new());
        for wrong in [
            "ports: {can: can0}",
            "ports: {can: 'sim:1'}",
            "ports: {can: 'socketcan:'}",
            "ports: {can: 'sim:'}, node: 0",
            "ports: {can: 'sim:'}, permits: [write]",
            "ports: {}",
        ] {
            assert_ne!(
                errors(&bench_schema(), &bench(wrong)),
                Vec::<String>::new(),
                "{wrong}"
            );
        }
    }

    #[test]
    fn the_schema_refuses_what_the_reader_refuses() {
        let suite = |step: &str| {
            format!(
                "language: 1\nsuite: a\ntitle: A\nprotocol: canopen\ncases:\n  - case: one\n    title: One\n    cite: [manual]\n    steps:\n      - {step}\n"
            )
        };
        for good in [
            "sync:",
            "stop-sync:",
            "nmt: start",
            "nmt: '{command}'",
            "sdo-read: {object: '1000:00', as: u32, expect: 192h}",
            "expect-boot-up:",
        ] {
            assert_eq!(
                errors(&schema(), &suite(good)),
                Vec::<String>::new(),
                "{good}"
            );
        }
        for wrong in [
            "sdo-raed: {object: '1000:00', as: u32}",
            "stop-sync",
            "sdo-read: {object: '1000:00', as: u32, wihtin: 5 ms}",
            "sdo-read: {object: '1000', as: u32}",
            "sdo-read: {object: '1000:00'}",
            "nmt: strat",
            "expect-silence: 500",
        ] {
            assert_ne!(
                errors(&schema(), &suite(wrong)),
                Vec::<String>::new(),
                "{wrong}"
            );
        }
    }
}
