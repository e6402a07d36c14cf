//! The page of a motion that was followed.

use super::{Followed, deviations};
use crate::pipeline::evidence_row as row;
use recon::observer::contacts::stream::StreamStage;
use recon_io::{Evidence, EvidenceValue, FollowedMotion, FollowedPage, Level, Verdict, brief_to};

/// Of what was followed until now; `text` is how it went in words, `doubts` what contradicts the readings that contact modes rest on.
pub(super) fn page(
    followed: &Followed,
    motion: FollowedMotion,
    title: String,
    (text, doubts): (String, &[String]),
) -> FollowedPage {
    let stage = followed.last.map_or(StreamStage::Gathering, |last| last.stage);
    let level = match stage {
        StreamStage::Tracking if followed.left_out == 0 && doubts.is_empty() => Level::Good,
        StreamStage::Tracking => Level::Caution,
        _ => Level::Bad,
    };
    let next = match (stage, followed.spans.is_empty()) {
        (StreamStage::Tracking, _) => "",
        (StreamStage::Contradicted, _) => {
            "run `recon reconstruct` on the log: of a whole log it says which assumption the data speak against"
        }
        (_, true) => {
            "let the object move more, or longer; `recon check-input` says what is understood of the log"
        }
        (_, false) => {
            "let the object move on: what is known of it wears off where it lies still or touches too little"
        }
    };
    let left_out = (followed.left_out > 0).then(|| {
        let why = followed.why.as_ref().map(|why| format!("; the first: {why}")).unwrap_or_default();
        format!("{} samples could not be used{why}.", followed.left_out)
    });
    let doubted = (!doubts.is_empty()).then(|| {
        let all = doubts.join("; ");
        format!("Contact modes can be sure and wrong, for their readings are not as stated: {all}.")
    });
    FollowedPage {
        title,
        verdict: Verdict { level, text },
        warnings: left_out.into_iter().chain(doubted).collect(),
        next: next.to_owned(),
        motion,
        palms: followed.palms,
        evidence: evidence(followed),
    }
}

/// What is known at the end, and how well.
fn evidence(followed: &Followed) -> Vec<Evidence> {
    let Some(last) = &followed.last else { return Vec::new() };
    let mut rows = Vec::new();
    if let Some(motion) = &last.motion {
        let number = EvidenceValue::Number;
        if motion.body.mass_deviation > 0.0 {
            rows.push(row("mass", "Mass", number(motion.body.mass), "kg", "As it is known at the end."));
            let what = "Standard deviation of the mass.";
            rows.push(row(
                "std_mass",
                "Deviation of the mass",
                number(motion.body.mass_deviation),
                "kg",
                what,
            ));
        }
        let [cm, v, w, turn] = deviations(last);
        let all = [
            ("std_cm", "Deviation of the centre of mass", cm, "m"),
            ("std_v", "Deviation of the velocity", v, "m/s"),
            ("std_w", "Deviation of the angular velocity", w, "rad/s"),
            ("std_turn", "Deviation of the orientation", turn, "rad"),
        ];
        let what = "At the last sample, all axes together.";
        rows.extend(all.map(|(key, name, value, unit)| row(key, name, number(value), unit, what)));
        let what = "What the latest readings leave in their deviations: about 1 where all is as stated.";
        rows.push(row("misfit", "Misfit of the latest window", number(motion.misfit), "", what));
    }
    let frictions = last.modes.iter().flat_map(|modes| modes.frictions.iter().enumerate());
    rows.extend(frictions.take(followed.palms).filter_map(|(palm, friction)| {
        let of = friction.as_ref()?;
        let meaning = format!("Learned where it slid, to {}.", brief_to(2, of.deviation));
        let name = format!("Friction of palm {}", palm + 1);
        Some(row(
            &format!("friction_{}", palm + 1),
            &name,
            EvidenceValue::Number(of.coefficient),
            "",
            &meaning,
        ))
    }));
    let known = EvidenceValue::Text(followed.spans.to_string());
    if !followed.spans.is_empty() {
        rows.push(row(
            "known",
            "The motion is known",
            known,
            "",
            "Before and between nobody can rely on it.",
        ));
    }
    rows
}
