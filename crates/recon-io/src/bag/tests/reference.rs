use super::{bag, expected};
use crate::bag::{BagTransform, Message, Reading};
use serde_json::{Value, json};

const WHOLE: [&str; 4] = ["fig5.mcap", "s4_fingertips.mcap", "taxels.mcap", "whole_short.mcap"];

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap_or(f64::NAN)).collect()
}

fn check_data(message: &Message, data: &Value) {
    let of = |key: &str| numbers(&data[key]);
    match &message.reading {
        Reading::Wrench(wrench) => assert_eq!(wrench.to_vec(), [of("force"), of("torque")].concat()),
        Reading::Point(point) => assert_eq!(point.to_vec(), of("point")),
        Reading::Pose(pose) => assert_eq!(pose.to_vec(), [of("position"), of("orientation_xyzw")].concat()),
        Reading::Transforms(all) => {
            assert_eq!(all.len(), data.as_array().unwrap().len());
            for (BagTransform { parent, child, pose, .. }, data) in all.iter().zip(data.as_array().unwrap()) {
                assert_eq!(
                    (json!(**parent), json!(**child)),
                    (data["parent"].clone(), data["child"].clone())
                );
                let pose_of = [numbers(&data["translation"]), numbers(&data["rotation_xyzw"])].concat();
                assert_eq!(pose.to_vec(), pose_of);
            }
        }
        Reading::Taxels { rows, columns, values } => {
            assert_eq!((json!(rows), json!(columns)), (data["height"].clone(), data["width"].clone()));
            assert_eq!(values[..4], of("first4")[..]);
            assert_eq!(json!(values[8 * 16 + 8]), data["row8_col8"]);
            let sum: f64 = values.iter().sum();
            let expected = data["sum_float64"].as_f64().unwrap();
            // The reference adds exactly; 256 additions here round.
            assert!((sum - expected).abs() <= 256.0 * f64::EPSILON * expected.abs(), "{sum} {expected}");
        }
        Reading::Arrays(all) => {
            for ((name, values), data) in all.iter().zip(data.as_array().unwrap()) {
                assert_eq!(
                    (json!(**name), json!(values.len())),
                    (data["name"].clone(), data["count"].clone())
                );
                assert_eq!(values[..4], numbers(&data["first4"])[..]);
            }
        }
        other => panic!("{other:?}"),
    }
}

/// Topics, counts, stamps, log times and the first messages, to the last digit.
#[test]
fn bags_of_another_implementation_are_read_to_the_last_digit() {
    for file in WHOLE {
        let (bag, expected) = (bag(file), expected(file));
        let topics = expected["topics"].as_object().unwrap();
        assert_eq!(bag.topics.keys().collect::<Vec<_>>(), topics.keys().collect::<Vec<_>>(), "{file}");
        let count: usize = bag.topics.values().map(|topic| topic.count).sum();
        assert_eq!((json!(count), bag.cut), (expected["messages"].clone(), None));
        for (name, expected) in topics {
            let topic = &bag.topics[name];
            assert_eq!(topic.schema, expected["schema"].as_str().unwrap());
            assert_eq!(json!(topic.messages.len()), expected["count"], "{file} {name}");
            let stamps = || topic.messages.iter().map(|message| message.stamp);
            let found = json!([stamps().min(), stamps().max()]);
            assert_eq!(found, json!([expected["first_stamp_ns"], expected["last_stamp_ns"]]));
            let logged =
                json!([topic.messages.first().map(|m| m.logged), topic.messages.last().map(|m| m.logged)]);
            assert_eq!(logged, json!([expected["first_log_ns"], expected["last_log_ns"]]));
            assert_eq!(json!(topic.frames()), expected["frame_ids"]);
            for (message, expected) in topic.messages.iter().zip(expected["first3"].as_array().unwrap()) {
                let times = json!([message.stamp, message.logged, message.published, message.sequence]);
                let keys = ["stamp_ns", "log_ns", "publish_ns", "sequence"];
                assert_eq!(times, json!(keys.map(|key| expected[key].clone())), "{file} {name}");
                check_data(message, &expected["data"]);
            }
        }
    }
}

#[test]
fn metadata_of_a_bag_is_kept() {
    let bag = bag("taxels.mcap");
    assert_eq!(bag.metadata["taxel_layout"]["pitch_m"], "0.005");
    assert!(bag.library.starts_with("mcap-python"), "{}", bag.library);
}
