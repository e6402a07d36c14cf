//! The tables of `recon pushes`. Their columns are told by `recon formats`.

use super::Told;
use crate::pipeline::Extra;
use recon::object_dynamics::pushing::PushMode;
use std::fmt::Write as _;

/// All tables, of all logs.
pub(super) fn files(told: &[Told]) -> Vec<Extra> {
    let table = |name: &str, head: &str, rows: fn(&Told, &mut String)| {
        let mut text = format!("{head}\n");
        told.iter().for_each(|told| rows(told, &mut text));
        (name.to_owned(), text.into_bytes())
    };
    vec![
        table("outline.csv", "log,x,y,nx,ny,std,to_touch", outline),
        table("corners.csv", "log,corner,x,y,std_x,std_y,cov_xy,touch_before,touch_after", corners),
        table("touches.csv", "log,push,end,x,y,gap", touches),
        table("modes.csv", "log,push,t,x,y,ratio,slip,stick,left,right,mode,px,py,theta", modes),
    ]
}

fn outline(told: &Told, text: &mut String) {
    for p in &told.estimate.outline.points {
        let values = [p.point.x, p.point.y, p.normal.x, p.normal.y, p.deviation, p.to_touch];
        row(text, &told.number.to_string(), &values);
    }
}

fn corners(told: &Told, text: &mut String) {
    for (k, c) in told.estimate.outline.corners.iter().enumerate() {
        let [xx, yy, xy] = [(0, 0), (1, 1), (0, 1)].map(|at| c.covariance[at]);
        let values = [c.point.x, c.point.y, xx.sqrt(), yy.sqrt(), xy, c.to_touch[0], c.to_touch[1]];
        row(text, &format!("{},{}", told.number, k + 1), &values);
    }
}

fn touches(told: &Told, text: &mut String) {
    for push in &told.estimate.pushes {
        for (end, (at, gap)) in push.ends.iter().zip(push.gaps).enumerate() {
            row(text, &format!("{},{},{end}", told.number, push.number), &[at.x, at.y, gap]);
        }
    }
}

fn modes(told: &Told, text: &mut String) {
    for push in &told.estimate.pushes {
        for i in &push.instants {
            let mode = match i.mode() {
                PushMode::Rest => 0,
                PushMode::Left => 1,
                PushMode::Stick => 2,
                PushMode::Right => 3,
            };
            let odds = [i.ratio, i.slip, i.stick, i.left, i.right, f64::from(mode)];
            let pose = [i.pose.p_WO.x, i.pose.p_WO.y, i.pose.theta];
            let values: Vec<f64> = [i.t, i.point.x, i.point.y].into_iter().chain(odds).chain(pose).collect();
            row(text, &format!("{},{}", told.number, push.number), &values);
        }
    }
}

/// Numbers of a micrometre's tenth and finer, without the noise of digits behind them.
fn row(text: &mut String, start: &str, values: &[f64]) {
    text.push_str(start);
    for value in values {
        let _ = write!(text, ",{}", recon_io::brief_to(8, *value));
    }
    text.push('\n');
}
