//! Definitions of messages in the language of ROS 2 (`ros2msg`), as far as it takes to see whether fields are those that are read.

use super::message::MessageKind;
use std::collections::HashMap;

/// Definitions that refer to each other deeper than this are no messages.
const DEEPEST: usize = 16;
/// More fields than these has no message that is read.
const MOST_FIELDS: usize = 200;

/// The fields of a message one after the other, without their names, lists in brackets; none where a definition that it
/// refers to is missing.
pub(super) fn fields(name: &str, definition: &str) -> Option<String> {
    let package = name.split('/').next()?;
    let (mut parts, mut current) = (HashMap::new(), (package.to_owned(), String::new()));
    let root = current.0.clone();
    for line in definition.lines() {
        if let Some(next) = line.trim().strip_prefix("MSG: ") {
            let (name, text) =
                std::mem::replace(&mut current, (next.trim().replace("/msg/", "/"), String::new()));
            parts.insert(name, text);
        } else if !line.starts_with("====") {
            current.1.push_str(line);
            current.1.push('\n');
        }
    }
    parts.insert(current.0, current.1);
    let mut found = Fields { parts: &parts, visited: 0, found: Vec::new() };
    found.of_message(&root, package, 0)?;
    Some(found.found.join(" "))
}

/// The fields so far.
struct Fields<'a> {
    parts: &'a HashMap<String, String>,
    /// How many were looked at: messages without fields are looked at too, and may be many.
    visited: usize,
    found: Vec<String>,
}

impl Fields<'_> {
    fn of_message(&mut self, name: &str, package: &str, depth: usize) -> Option<()> {
        let text = self.parts.get(name).filter(|_| depth < DEEPEST)?;
        for line in text.lines() {
            let line = line.split('#').next().unwrap_or_default();
            let mut words = line.split_whitespace();
            let (Some(kind), rest) = (words.next(), words.next().unwrap_or_default()) else { continue };
            // Constants are no fields.
            if rest.contains('=') || words.next().is_some_and(|word| word.starts_with('=')) {
                continue;
            }
            let (element, list) = match kind.split_once('[') {
                Some((element, size)) => (element, Some(size.trim_end_matches(']'))),
                None => (kind, None),
            };
            let repeat = list.and_then(|size| size.parse::<usize>().ok());
            let open = list.is_some() && repeat.is_none();
            self.found.extend(open.then(|| "[".to_owned()));
            for _ in 0..repeat.unwrap_or(1) {
                self.of_field(element, package, depth)?;
            }
            self.found.extend(open.then(|| "]".to_owned()));
        }
        Some(())
    }

    fn of_field(&mut self, element: &str, package: &str, depth: usize) -> Option<()> {
        self.visited += 1;
        if self.visited > MOST_FIELDS {
            return None;
        }
        let plain = element.split("<=").next().unwrap_or(element);
        match plain {
            // One byte each.
            "bool" | "byte" | "char" | "uint8" => self.found.push("uint8".to_owned()),
            "int8" | "int16" | "uint16" | "int32" | "uint32" | "int64" | "uint64" | "float32" | "float64"
            | "string" | "wstring" => self.found.push(plain.to_owned()),
            _ => {
                let full = match plain {
                    "Header" => "std_msgs/Header".to_owned(),
                    _ if plain.contains('/') => plain.replace("/msg/", "/"),
                    _ => format!("{package}/{plain}"),
                };
                self.of_message(&full, full.split('/').next()?, depth + 1)?;
            }
        }
        Some(())
    }
}

/// The fields of a kind as they are read.
pub(super) fn expected(kind: MessageKind) -> String {
    let header = "int32 uint32 string";
    let numbers = |count: usize| vec!["float64"; count].join(" ");
    match kind {
        MessageKind::Wrench => format!("{header} {}", numbers(6)),
        MessageKind::Point => format!("{header} {}", numbers(3)),
        MessageKind::Pose => format!("{header} {}", numbers(7)),
        MessageKind::Transforms => format!("[ {header} string {} ]", numbers(7)),
        MessageKind::Joints => format!("{header} [ string ] [ float64 ] [ float64 ] [ float64 ]"),
        MessageKind::Image => format!("{header} uint32 uint32 string uint8 uint32 [ uint8 ]"),
        MessageKind::Tactile => format!("{header} [ string [ float32 ] ]"),
        MessageKind::Contact => format!("{header} uint8 {}", numbers(6)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TIME: &str = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

    #[test]
    fn fields_of_nested_definitions_come_in_their_order() {
        let text = format!(
            "# A comment\nuint8 ON=1\nstring<=5 NAME = \"x\"\nstd_msgs/Header header # here\nPart[] parts\nfloat64[2] pair 0\nbool on true\n\
             ====\nMSG: own/Part\nbyte[<=3] bytes\n====\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n====\n{TIME}"
        );
        let found = fields("own/msg/Whole", &text).unwrap();
        assert_eq!(found, "int32 uint32 string [ [ uint8 ] ] float64 float64 uint8");
        assert_eq!(fields("own/msg/Whole", "Part part\n"), None, "Part is not there");
        assert_eq!(fields("own/msg/Whole", "own/Whole again\n===\nMSG: own/Whole\nown/Whole again\n"), None);
    }

    /// Our own message is what it is read as.
    #[test]
    fn the_contact_message_is_what_is_read() {
        let vector = "float64 x\nfloat64 y\nfloat64 z\n";
        let text = format!(
            "{}====\nMSG: geometry_msgs/Point\n{vector}====\nMSG: geometry_msgs/Vector3\n{vector}====\nMSG: std_msgs/Header\n\
             builtin_interfaces/Time stamp\nstring frame_id\n====\n{TIME}",
            include_str!("../../ros/recon_msgs/msg/Contact.msg")
        );
        assert_eq!(fields("recon_msgs/msg/Contact", &text), Some(expected(MessageKind::Contact)));
    }

    proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "[a-c/\\[\\]<=#0-9 \\n]{0,200}|\\PC{0,100}") {
            let _ = fields("a/b", &text);
        }

    }

    /// Nor sizes that would take all memory, or for ever.
    #[test]
    fn no_size_is_too_much() {
        assert!(fields("a/B", "float64[200] x\n").is_some());
        for text in [
            "float64[201] x\n",
            "float64[18446744073709551615] x\n",
            "C[18446744073709551615] x\n===\nMSG: a/C\n",
        ] {
            assert_eq!(fields("a/B", text), None);
        }
        let chain = |k: u32| format!("C{}[99] x\n===\nMSG: a/C{}\n", k + 1, k + 1);
        assert_eq!(fields("a/B", &(0..12).map(chain).collect::<String>()), None);
    }
}
