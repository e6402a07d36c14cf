//! Checks a summary against the JSON schema in `docs/schema`, by the keywords that it uses; another keyword is an error.

use serde_json::{Map, Value};

/// What is wrong with a summary, and where.
pub(crate) fn complaints(summary: &Value) -> Vec<String> {
    let schema: Value =
        serde_json::from_str(include_str!("../../../../../docs/schema/summary.schema.json")).unwrap();
    Checker { root: &schema }.check(&schema, summary, "")
}

struct Checker<'a> {
    root: &'a Value,
}

impl Checker<'_> {
    fn check(&self, schema: &Value, value: &Value, place: &str) -> Vec<String> {
        let mut wrong = Vec::new();
        for (keyword, says) in schema.as_object().expect("a schema is an object") {
            wrong.extend(self.keyword(keyword, says, schema, value, place));
        }
        wrong
    }

    fn keyword(&self, keyword: &str, says: &Value, of: &Value, value: &Value, place: &str) -> Vec<String> {
        let no = |wrong: bool, why: &str| {
            if wrong { vec![format!("`{place}` is {value}: {why} {says}")] } else { Vec::new() }
        };
        let items = value.as_array();
        let count = items.map_or(0, Vec::len) as u64;
        match keyword {
            "$schema" | "$defs" | "title" | "description" => Vec::new(),
            "$ref" => {
                let at =
                    says.as_str().and_then(|name| name.strip_prefix('#')).expect("a reference in the file");
                self.check(self.root.pointer(at).unwrap_or_else(|| panic!("{at} is not there")), value, place)
            }
            "type" => no(!is_of_type(says, value), "not of type"),
            "const" => no(says != value, "not"),
            "enum" => no(!says.as_array().unwrap().contains(value), "none of"),
            "minimum" => no(value.as_f64().is_some_and(|value| value < says.as_f64().unwrap()), "below"),
            "minItems" => no(items.is_some() && count < says.as_u64().unwrap(), "fewer than"),
            "maxItems" => no(items.is_some() && count > says.as_u64().unwrap(), "more than"),
            "items" => {
                let one = |(k, item)| self.check(says, item, &format!("{place}[{k}]"));
                items.into_iter().flatten().enumerate().flat_map(one).collect()
            }
            "required" => {
                let lacks = |key: &&Value| value.is_object() && value.get(key.as_str().unwrap()).is_none();
                says.as_array()
                    .unwrap()
                    .iter()
                    .filter(lacks)
                    .map(|key| format!("`{place}` lacks {key}"))
                    .collect()
            }
            "properties" => self.properties(says.as_object().unwrap(), value, place),
            "additionalProperties" => self.others(says, of, value, place),
            "anyOf" | "oneOf" => self.branches(says.as_array().unwrap(), keyword == "oneOf", value, place),
            _ => panic!("the check knows no `{keyword}`"),
        }
    }

    fn properties(&self, named: &Map<String, Value>, value: &Value, place: &str) -> Vec<String> {
        let there = named.iter().filter_map(|(key, schema)| Some((key, schema, value.get(key)?)));
        there.flat_map(|(key, schema, found)| self.check(schema, found, &format!("{place}/{key}"))).collect()
    }

    /// Keys that `properties` does not name.
    fn others(&self, says: &Value, of: &Value, value: &Value, place: &str) -> Vec<String> {
        let named = |key: &str| of["properties"].get(key).is_some();
        let others = value.as_object().into_iter().flatten().filter(|(key, _)| !named(key));
        let one = |(key, found): (&String, &Value)| match says {
            Value::Bool(false) => vec![format!("`{place}/{key}` is no key of the schema")],
            schema => self.check(schema, found, &format!("{place}/{key}")),
        };
        others.flat_map(one).collect()
    }

    /// Of branches that all fail the one that failed last tells most: it is the one whose `schema` is right.
    fn branches(&self, branches: &[Value], one: bool, value: &Value, place: &str) -> Vec<String> {
        let told: Vec<_> = branches.iter().map(|branch| self.check(branch, value, place)).collect();
        match told.iter().filter(|wrong| wrong.is_empty()).count() {
            0 => told.into_iter().min_by_key(Vec::len).unwrap_or_default(),
            1 => Vec::new(),
            _ if one => vec![format!("`{place}` is of more than one kind")],
            _ => Vec::new(),
        }
    }
}

fn is_of_type(says: &Value, value: &Value) -> bool {
    let is = |name: &Value| match name.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("the check knows no type `{other}`"),
    };
    match says {
        Value::Array(names) => names.iter().any(is),
        name => is(name),
    }
}
