//! What is said of a motion that is followed: rows as objects, and what there is to know of contact modes at the end.

use recon::observer::contacts::stream::StreamModes;
use recon_io::{MotionState, StreamRow, brief, probabilities};
use serde_json::{Value, json};

/// A row for a program, with the modes of so many palms.
pub(super) fn object(row: &StreamRow, palms: usize) -> Value {
    let motion = |of: fn(MotionState) -> Value| row.motion.map(of);
    let [cm, v, w, turn] = row.deviations;
    let mut object = json!({
        "t_s": row.t,
        "stage": row.stage,
        "relied_on": row.relied_on,
        // No numbers before there is a motion: null.
        "p_WCm_m": motion(|m| json!(m.p_WCm.to_array())),
        "R_WO_wxyz": motion(|m| json!([m.R_WO.w, m.R_WO.x, m.R_WO.y, m.R_WO.z])),
        "v_WCm_m_per_s": motion(|m| json!(m.v_WCm.to_array())),
        "w_WO_rad_per_s": motion(|m| json!(m.w_WO.to_array())),
        "std_position_m": cm,
        "std_velocity_m_per_s": v,
        "std_angular_velocity_rad_per_s": w,
        "std_orientation_rad": turn,
        "misfit": row.misfit,
        "mass_kg": row.mass.map(|m| m[0]),
        "std_mass_kg": row.mass.map(|m| m[1]),
    });
    if palms > 0 {
        object["modes"] = json!(row.modes.as_ref().map(|modes| {
            let one = |palm: usize| {
                let [slide, stick] = probabilities(&modes.odds[palm]);
                let mode = modes.decided[palm].number();
                json!({ "palm": palm + 1, "mode": mode, "p_slide": slide, "p_stick": stick, "doubt": row.doubt(palm) })
            };
            (0..palms).map(one).collect::<Vec<Value>>()
        }));
    }
    object
}

/// Frictions that were learned, and what is doubted.
#[derive(Default)]
pub(super) struct Told {
    /// For a person.
    pub(super) text: String,
    pub(super) frictions: Vec<Value>,
    pub(super) doubts: Vec<String>,
}

/// Of so many palms after the last sample.
pub(super) fn told(modes: &StreamModes, palms: usize) -> Told {
    let mut told = Told::default();
    for (palm, (friction, doubt)) in modes.frictions.iter().zip(&modes.doubts).take(palms).enumerate() {
        if let Some(of) = friction {
            told.text += &format!(
                "\nfriction of palm {}: {} +- {}",
                palm + 1,
                brief(of.coefficient),
                brief(of.deviation)
            );
            told.frictions
                .push(json!({ "palm": palm + 1, "coefficient": of.coefficient, "std": of.deviation }));
        }
        told.doubts.extend(doubt.map(|doubt| doubt.to_string()));
    }
    if !told.doubts.is_empty() {
        let all = told.doubts.join("; ");
        told.text +=
            &format!("\ncontact modes can be sure and wrong, for their readings are not as stated: {all}");
    }
    told
}
