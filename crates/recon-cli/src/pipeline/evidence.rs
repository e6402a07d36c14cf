//! Rows of evidence that several results share.

use glam::DMat3;
use recon::observer::rigid::{PoseAxes, PoseErrors};
use recon_io::{Evidence, EvidenceValue, Level};

/// One that speaks neither for the result nor against it.
pub(crate) fn row(key: &str, name: &str, value: EvidenceValue, unit: &str, meaning: &str) -> Evidence {
    let [key, name, unit, meaning] = [key, name, unit, meaning].map(str::to_owned);
    Evidence { key, name, value, unit, meaning, level: Level::Neutral }
}

/// Of a log that was thinned by means.
pub(super) fn samples_together(together: usize) -> Evidence {
    row(
        "samples_together",
        "Rows in a sample",
        EvidenceValue::Count(together as u64),
        "",
        "The log is denser than its motion needs: the means of so many rows are taken as one sample.",
    )
}

/// What bounds hold for, at which odds and in which axes.
pub(super) fn of_bounds(errors: &PoseErrors, confidence: f64) -> [Evidence; 4] {
    let shared = errors.shared();
    let deviation = |m: DMat3| (m.x_axis.x + m.y_axis.y + m.z_axis.z).max(0.0).sqrt();
    let axes = match errors.axes() {
        PoseAxes::Principal => "principal",
        PoseAxes::MeanPose => "mean pose",
    };
    let number = EvidenceValue::Number;
    [
        row(
            "bounds_confidence",
            "Confidence of the bounds",
            number(confidence),
            "",
            "Both bounds hold with at least this probability for the noise of contacts and forces and for the error of the motion.",
        ),
        row(
            "bounds_frame",
            "Axes of the bounds",
            EvidenceValue::Text(axes.to_owned()),
            "",
            "Principal: the bounds hold in the body's own axes. Mean pose: in body axes in which the estimated poses are right on the \
             average over the samples, that is the body's own displaced by the mean error of the poses.",
        ),
        row(
            "std_bounds_turn",
            "Turn of these axes",
            number(deviation(shared.rotation)),
            "rad",
            "Standard deviation of how far they are turned against the body's own, all axes together.",
        ),
        row(
            "std_bounds_shift",
            "Shift of these axes",
            number(deviation(shared.translation)),
            "m",
            "Standard deviation of how far their origin is from the centre of mass.",
        ),
    ]
}
