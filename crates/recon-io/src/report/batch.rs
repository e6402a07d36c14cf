//! The page of many logs: a small picture of each, and a link to its own page.

use super::Level;
use super::data::level;
use super::page::{Fact, Page, escape_text};
use crate::number::with_brief_numbers;
use crate::planar_figures::{FigurePanel, figures_in_page};
use std::io::{self, Write};

/// One log of many.
#[derive(Clone, Debug, PartialEq)]
pub struct LogCard {
    /// Name of the log.
    pub name: String,
    /// Where its own page is, from this one; none of a log without results.
    pub link: Option<String>,
    /// How it went.
    pub level: Level,
    /// In a word.
    pub word: &'static str,
    /// What else is to be said of it.
    pub lines: Vec<String>,
    /// Its picture.
    pub panel: Option<FigurePanel>,
}

/// What the page shows.
#[derive(Clone, Debug, PartialEq)]
pub struct BatchPage {
    /// Title.
    pub title: String,
    /// Key figures: name, value, unit.
    pub facts: Vec<Fact>,
    /// What the pictures show.
    pub caption: String,
    /// Name of the table beside the page.
    pub table: &'static str,
    /// The logs.
    pub cards: Vec<LogCard>,
}

/// Writes many logs as one HTML page, which loads nothing.
///
/// # Errors
/// Those of `to`.
pub fn write_batch_report(page: &BatchPage, to: impl Write) -> io::Result<()> {
    let cards: String = page.cards.iter().map(card).collect();
    let (caption, table) = (escape_text(&page.caption), escape_text(page.table));
    let body = format!(
        "<p class=\"caption\">{caption} All numbers are in <a href=\"{table}\">{table}</a>.</p>\n\
         <section class=\"figure cards\" aria-label=\"Logs\">\n{cards}</section>\n"
    );
    let (kicker, verdict) = ("Many logs", String::new());
    Page { kicker, title: &page.title, verdict, facts: &page.facts, body }.write(to)
}

fn card(of: &LogCard) -> String {
    let name = escape_text(&of.name);
    let name = match &of.link {
        Some(link) => format!("<a href=\"{}\">{name}</a>", encoded(link)),
        None => name,
    };
    let line = |line: &String| format!("<p>{}</p>\n", escape_text(&with_brief_numbers(line)));
    let picture = of.panel.as_ref().map_or_else(String::new, |panel| {
        format!("<div class=\"curves\">{}</div>\n", figures_in_page(std::slice::from_ref(panel)))
    });
    format!(
        "<article class=\"panel card\">\n<h2>{name}</h2>\n<p class=\"word {}\">{}</p>\n{picture}{}</article>\n",
        level(of.level),
        escape_text(of.word),
        of.lines.iter().map(line).collect::<String>()
    )
}

/// A path as an address.
fn encoded(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~/".contains(&byte);
    let one = |byte: u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    path.bytes().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_in_text_and_address() {
        let card = LogCard {
            name: "a <b>.csv".to_owned(),
            link: Some("a <b>/report.html".to_owned()),
            level: Level::Good,
            word: "relied on",
            lines: vec!["mass 1.5 & more".to_owned()],
            panel: Some(FigurePanel::default()),
        };
        let broken = LogCard { link: None, panel: None, ..card.clone() };
        let page = BatchPage {
            title: "two".to_owned(),
            facts: Vec::new(),
            caption: String::new(),
            table: "results.csv",
            cards: vec![card, broken],
        };
        let mut out = Vec::new();
        write_batch_report(&page, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(
            text.contains("<a href=\"a%20%3Cb%3E/report.html\">a &lt;b&gt;.csv</a>")
                && text.contains("1.5 &amp; more")
        );
        assert_eq!(text.matches("<svg").count(), 1);
        assert!(!text.contains("{{") && !text.contains("src="));
    }
}
