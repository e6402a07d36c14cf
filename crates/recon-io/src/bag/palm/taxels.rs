use super::reader::{LEAST_SHARE, PalmReader};
use super::{Steady, Touches};
use crate::bag::error::BagErrorKind as Kind;
use crate::bag::mapping::{TaxelTopic, TaxelValue};
use crate::bag::message::{MessageKind, Reading};
use crate::bag::topic::Message;
use glam::DVec3;
use recon::contact_kinematics::TaxelArray;

impl PalmReader<'_> {
    /// Contacts and normal forces from taxels.
    pub(super) fn taxels(&self, taxels: &TaxelTopic) -> Result<(Touches, Steady), Kind> {
        let kinds = [MessageKind::Image, MessageKind::Tactile];
        let (topic, all) = self.source.messages(&taxels.topic, &self.key("taxels.topic"), &kinds)?;
        // A tactile state has one header for many arrays: the name of the array is a frame there.
        let named = taxels.frame.as_ref().or(match topic.kind {
            Ok(MessageKind::Tactile) => taxels.sensor.as_ref(),
            _ => None,
        });
        let into = self.inside(topic, named, "taxels.frame")?;
        let [pitch_x, pitch_y] = taxels.pitch.each();
        let area = if taxels.value == TaxelValue::Pressure { pitch_x * pitch_y } else { 1.0 };
        let mut felt = Vec::with_capacity(all.len());
        for (t, message) in all {
            let (rows, columns, values) = self.values(taxels, t, message)?;
            let array = TaxelArray { rows, columns, pitch_x, pitch_y };
            let pressed = array.pressed(values, taxels.floor);
            felt.push((t, pressed.map(|pressed| (taxels.factor * area * pressed.sum, pressed.centre))));
        }
        let largest = felt.iter().filter_map(|(_, felt)| *felt).map(|(force, _)| force).fold(0.0, f64::max);
        let least = self.palm.least_force.unwrap_or(LEAST_SHARE * largest);
        let (mut readings, mut times, mut forces) = (Vec::new(), Vec::new(), Vec::new());
        for (t, felt) in felt {
            let felt = felt.filter(|(force, _)| *force > least);
            readings.push((t, felt.and_then(|(_, centre)| into.point(t, centre))));
            times.push(t);
            forces.push(DVec3::X * felt.map_or(0.0, |(force, _)| force));
        }
        Ok((Touches::new(&taxels.topic, readings), self.track(&taxels.topic, times, forces)?))
    }

    /// Rows, columns and values of the palm's array in a message.
    fn values<'m>(
        &self,
        taxels: &TaxelTopic,
        t: f64,
        message: &'m Message,
    ) -> Result<(usize, usize, &'m [f64]), Kind> {
        let wrong = |found: String, expected: String, key: &str| Kind::Array {
            topic: taxels.topic.clone(),
            t,
            found,
            expected,
            key: self.key(key),
        };
        let (rows, columns, values) = match &message.reading {
            Reading::Taxels { rows, columns, values } => (*rows, *columns, values),
            Reading::Arrays(all) => {
                let sensor = taxels.sensor.as_deref().unwrap_or_default();
                let names = || all.iter().map(|(name, _)| &**name).collect::<Vec<_>>().join(", ");
                let found = all.iter().find(|(name, _)| **name == *sensor);
                let (_, values) = found.ok_or_else(|| {
                    wrong(format!("it has the arrays {}", names()), format!("`{sensor}`"), "taxels.sensor")
                })?;
                let (Some(rows), Some(columns)) = (taxels.rows, taxels.columns) else {
                    let found = format!("its array has {} values in no order that it says", values.len());
                    return Err(wrong(found, "nothing of rows and columns".to_owned(), "taxels"));
                };
                (rows, columns, values)
            }
            Reading::Picture { encoding, rows, columns } => {
                let found = format!("a picture of {columns} x {rows} with the encoding {encoding}");
                return Err(wrong(
                    found,
                    "that it is an array of taxels (32FC1, 16UC1, ...)".to_owned(),
                    "taxels.topic",
                ));
            }
            _ => (0, 0, const { &Vec::new() }),
        };
        let expected = (taxels.rows.unwrap_or(rows), taxels.columns.unwrap_or(columns));
        if expected != (rows, columns) || rows.checked_mul(columns) != Some(values.len()) {
            let found = format!("{} values in {rows} rows of {columns}", values.len());
            return Err(wrong(found, format!("{} rows of {}", expected.0, expected.1), "taxels"));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite())
            && !self.source.mapping.leave_out_not_finite
        {
            let (topic, stamp) = (taxels.topic.clone(), message.stamp);
            return Err(Kind::NotFinite { topic, t, stamp, what: "a taxel", value: *value, count: 1 });
        }
        Ok((rows, columns, values))
    }
}
