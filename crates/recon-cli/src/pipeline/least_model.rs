//! What was modelled and what was left out, as the reader sees it.

use recon::least_model::{Alternative, Choice, Decision};
use recon_io::{Evidence, EvidenceValue, Level};
use serde_json::Value;

/// For a program.
pub(crate) fn choice_figures(choice: &Choice) -> Value {
    // Numbers and words alone: what is not finite becomes null.
    serde_json::to_value(choice).unwrap_or_default()
}

/// For the console: whether the accuracy is reached, and where asked for each question with its alternatives.
pub(crate) fn explained(choice: &Choice, in_full: bool) -> String {
    let mut text = choice.verdict();
    if !in_full {
        return text;
    }
    for Decision { question, alternatives } in &choice.decisions {
        text += &format!("\n  {question}:");
        for of in alternatives {
            let mark = if of.chosen { '*' } else { ' ' };
            text += &format!("\n    {mark} {}: {}", of.model, of.told());
        }
    }
    text + &format!("\n  * is what was chosen; all trials took {:.1e} s", choice.seconds)
}

/// For the page: a row a question, with what was chosen and what that rests on.
pub(super) fn choice_rows(choice: &Choice) -> Vec<Evidence> {
    let level = if choice.is_reached { Level::Good } else { Level::Caution };
    let mut rows = vec![Evidence {
        key: "accuracy".to_owned(),
        name: "Accuracy".to_owned(),
        value: EvidenceValue::Number(choice.reached),
        unit: "sizes, rad".to_owned(),
        meaning: choice.verdict(),
        level,
    }];
    rows.extend(choice.decisions.iter().map(row));
    rows
}

fn row(of: &Decision) -> Evidence {
    let one = |of: &Alternative| format!("{} ({})", of.model, of.told());
    let [chosen, others] = [true, false]
        .map(|is| of.alternatives.iter().filter(|of| of.chosen == is).map(one).collect::<Vec<_>>());
    let model = of.alternatives.iter().find(|of| of.chosen).map(|of| of.model.to_string());
    let others = if others.is_empty() { String::new() } else { format!(" Left out: {}.", others.join("; ")) };
    Evidence {
        key: format!("{:?}", of.question).to_lowercase(),
        name: of.question.to_string(),
        value: EvidenceValue::Text(model.unwrap_or_default()),
        unit: String::new(),
        meaning: format!("Modelled: {}.{others}", chosen.join("; ")),
        level: Level::Neutral,
    }
}
