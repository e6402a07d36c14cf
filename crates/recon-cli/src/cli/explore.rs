//! Arguments of `explore` and `next`.

use super::{confidence, finite, not_negative, positive};
use crate::error::CliError;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// What decides where to touch.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum PlannerAs {
    /// Of the touches that pay nearly as much as the best that which pays most for its way: start here
    PathAware,
    /// The touch that is expected to shrink the volume (area) between the bounds most
    Volume,
    /// The touch where the bounds are furthest apart
    Hausdorff,
    /// Where a Gaussian process is least sure: to compare with
    Gaussian,
    /// A fixed sequence, spread evenly: to compare with
    Sweep,
    /// Any direction: to compare with
    Random,
    /// Of palms that turn: the most per second, two motions ahead: start there
    PerSecond,
    /// Of palms that turn: the most per radian, two motions ahead
    PerRadian,
}

impl PlannerAs {
    /// As it is written.
    pub(crate) fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// It plans nothing for `what`.
    pub(crate) fn not_for(self, what: &'static str, instead: &'static str) -> CliError {
        CliError::Planner { name: self.name(), what, instead }
    }
}

/// What is to be known, and how it is touched: of `explore` and `next`.
#[derive(Args, Debug)]
pub(crate) struct GoalArgs {
    /// What decides where to touch [default: path-aware; of palms that turn per-second]
    #[arg(long, value_enum)]
    pub(crate) planner: Option<PlannerAs>,
    /// Seed of what is drawn: the start's orientation, random touches, noise [default: 1]
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Touches at most; the confidence is shared among so many [default: 60 in the plane, 200 in space]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) budget: Option<u32>,
    /// Standard deviation per axis of the contact points, m [default: exact contacts]
    #[arg(long, value_name = "M", value_parser = not_negative)]
    pub(crate) contact_noise: Option<f64>,
    /// Standard deviation of the normals about each tangent axis, rad
    #[arg(long, value_name = "RAD", requires = "contact_noise", value_parser = not_negative)]
    pub(crate) normal_noise: Option<f64>,
    /// Confidence under noise, for all touches that may be made together [default: 0.95]
    #[arg(long, value_parser = confidence)]
    pub(crate) confidence: Option<f64>,
}

#[derive(Args, Debug)]
#[command(group = clap::ArgGroup::new("felt").args(["contour", "relief"]))]
#[command(after_long_help = "\
The object is that of the scene's [simulation], in space or in the plane. A planner that sees contacts alone says where it is
touched; the lower bound is the hull of the contacts, the upper one the intersection of their half-spaces, and the gap what is
between them over the upper one. Goals: gap=0.1, hausdorff=0.01 (largest distance of the bounds, m), width=0.001@1,0,0 (width
along a direction, to within so many m).

With --contact-noise and --normal-noise touches are noisy, and the bounds hold at the confidence for all touches of the budget
together, however they are chosen and whenever the looking ends. A goal below what the noise leaves is refused.

With --rolling the palms of the scene are not looked at: two lines about a common hinge turn between 0.1 and 2.2 rad from their
sides, slowly and without friction, and the object lies where its centre of mass is lowest; contacts are exact, in its own frame. With
--contact-noise and --force-noise the object moves by the equations of motion, sensors are noisy, and its motion is estimated from all that
was sensed after each motion of the palms: nothing else is known of it, and bounds hold at the confidence for all these looks together.

In space --rolling squeezes the object between two parallel palms with friction, of which the upper one moves: it rolls without slip, and is felt at both. Palms
stop where the force leans by nine tenths of what friction holds. Contacts are exact, in the object's own frame; or, with --contact-noise and --palm-noise, palms
sense with noise, and where the object is is estimated from that. Pads are taken to keep it from spinning about their normal, but for --spin-noise.

With --contour a round finger keeps in touch with the outline of the scene (`[outline]`, through points or with waves, or the object of a scene of the
plane), once round. Where it does not get in it jumps, and that is told: between the two contacts nothing was felt. The hull of the outline is bounded, with
--contact-noise and --normal-noise at the confidence, whatever the finger does not get into. It writes contour.csv, jumps.csv and the bounds.

With --relief a round finger comes down on the body of the scene (`[surface]`, a ball with waves) on a lattice of lines from 16 directions, more densely where the
normal turns. Where it does not get in it jumps, and what no direction sees ends in a rim: both are told. The body's volume is bounded from above and its hull from
both sides, whatever it is. It writes relief.csv, misses.csv, jumps.csv and the bounds.

The output folder appears as a whole or not at all: contacts.csv, the bounds, summary.json (goal, proof, each touch and why), and
report.html. `recon next` goes on from there.

Examples:
  recon explore scene.toml --until gap=0.1
  recon explore scene.toml --until gap=0.2 --contact-noise 1e-3 --normal-noise 2e-3 -o out
  recon explore scene.toml --until hausdorff=0.05 --planner hausdorff -o out
  recon explore plane.toml --rolling --until gap=0.1 -o out
  recon explore plane.toml --rolling --until gap=0.1 --contact-noise 5e-5 --force-noise 2e-3 -o out
  recon explore scene.toml --rolling --friction 0.9 --until gap=0.3 -o out
  recon explore scene.toml --rolling --until gap=0.3 --contact-noise 1e-3 --palm-noise 1e-4 -o out
  recon explore outline.toml --contour --finger 0.01 -o out
  recon explore body.toml --relief --finger 0.01 -o out
  recon explore scene.toml --until width=0.001@0,0,1 --json | jq .proof")]
pub(crate) struct ExploreArgs {
    /// Scene file (TOML)
    pub(crate) scene: PathBuf,
    /// What is to be proven: gap=SHARE, hausdorff=M or width=M@X,Y,Z
    #[arg(long, value_name = "GOAL", value_parser = until, required_unless_present_any = ["contour", "relief"])]
    pub(crate) until: Option<Until>,
    #[command(flatten)]
    pub(crate) goal: GoalArgs,
    /// Follow an outline once round with a round finger; it need not be convex
    #[arg(long, conflicts_with_all = ["until", "planner", "rays", "rolling"])]
    pub(crate) contour: bool,
    /// Come down on a body in space with a round finger; it need not be convex
    #[arg(long, conflicts_with_all = ["until", "planner", "rays", "rolling", "contour"])]
    pub(crate) relief: bool,
    /// With --contour or --relief: radius of the finger, m [default: finger.radius of the scene]
    #[arg(long, value_name = "M", requires = "felt", value_parser = positive)]
    pub(crate) finger: Option<f64>,
    /// With --contour: motion of the finger's centre from touch to touch at most, m [default: a fiftieth of the size, less for small fingers]; with --relief
    /// what lines are apart [default: 0.06 of the size, less for small fingers]
    #[arg(long, value_name = "M", requires = "felt", value_parser = positive)]
    pub(crate) step: Option<f64>,
    /// Touch along rays rather than with a plane (line)
    #[arg(long)]
    pub(crate) rays: bool,
    /// Move palms with the object between them, which rolls and is felt where it touches them: in the plane two that turn, in space the upper one of two
    /// parallel ones
    #[arg(long, conflicts_with = "rays")]
    pub(crate) rolling: bool,
    /// With --rolling: roughly the object's mean width, m; palms are four times as long, pads in space three times as wide [default: that of the scene's
    /// object]
    #[arg(long, value_name = "M", requires = "rolling", value_parser = positive)]
    pub(crate) width: Option<f64>,
    /// With --rolling and --contact-noise: standard deviation of each axis of the forces, N; the object's motion is then estimated from
    /// contacts and forces, and nothing of it is taken as known
    #[arg(long, value_name = "N", requires_all = ["rolling", "contact_noise"], conflicts_with = "normal_noise", value_parser = positive)]
    pub(crate) force_noise: Option<f64>,
    /// With --rolling in space and --contact-noise: standard deviation of the place of the upper palm per axis, m; where the object is is then
    /// estimated from contacts and palm, and nothing of it is taken as known
    #[arg(long, value_name = "M", requires_all = ["rolling", "contact_noise"], conflicts_with_all = ["normal_noise", "force_noise"], value_parser = not_negative)]
    pub(crate) palm_noise: Option<f64>,
    /// With --palm-noise: standard deviation of the turn about the line through both contacts that the pads let happen while the object rolls by 1 rad, rad; it
    /// grows as the root of the turn [default: 0]
    #[arg(long, value_name = "RAD", requires = "palm_noise", value_parser = not_negative)]
    pub(crate) spin_noise: Option<f64>,
    /// With --rolling: coefficient of friction of both palms [default: in space 1; in the plane 0; with --force-noise the estimate is told
    /// that it is 0, and nothing of another one]
    #[arg(long, value_name = "MU", requires = "rolling", value_parser = not_negative)]
    pub(crate) friction: Option<f64>,
    /// Folder to write; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long, requires = "output")]
    pub(crate) force: bool,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Reads contacts.csv (x, y, z and nx, ny, nz; in the plane x, y and nx, ny) from a folder of `recon explore`, or a file of contacts,
to which contacts may have been added since, and prints JSON: whether the goal is proven, and else the direction along which to
touch, a ray for a finger that moves on one, what the touch is expected to gain, and how many touches are expected in all. Goal and
settings are those of the folder's summary.json unless they are given.

From a folder of `recon explore --rolling` it reads state.json as well (where palms and object are, which whoever has turned them writes anew)
and prints the next motion of the palms: the absolute angles that they are turned to, one pair after another, and what that is expected to bring; in
space the heading of the upper palm and by how much that is to turn the object.

Examples:
  recon next out
  recon next contacts.csv --until gap=0.1 | jq .action.along")]
pub(crate) struct NextArgs {
    /// Folder of `recon explore`, or contacts (CSV)
    pub(crate) input: PathBuf,
    /// What is to be proven: gap=SHARE, hausdorff=M or width=M@X,Y,Z [default: that of the folder]
    #[arg(long, value_name = "GOAL", value_parser = until)]
    pub(crate) until: Option<Until>,
    #[command(flatten)]
    pub(crate) goal: GoalArgs,
}

/// A goal as it is written on the command line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Until {
    /// `gap=SHARE`
    Gap(f64),
    /// `hausdorff=M`
    Hausdorff(f64),
    /// `width=M@X,Y,Z`
    Width(f64, Vec<f64>),
}

impl Until {
    /// Whether both are of one quantity, however much of it is asked for.
    pub(crate) fn is_of(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Gap(_), Self::Gap(_)) | (Self::Hausdorff(_), Self::Hausdorff(_)) => true,
            (Self::Width(_, along), Self::Width(_, other)) => along == other,
            _ => false,
        }
    }
}

/// Reads a goal.
pub(crate) fn until(text: &str) -> Result<Until, String> {
    let wrong = || format!("`{text}` is no goal; write gap=0.1, hausdorff=0.01 or width=0.001@1,0,0");
    let (kind, value) = text.split_once('=').ok_or_else(wrong)?;
    match kind {
        "gap" => Ok(Until::Gap(finite(value)?)),
        "hausdorff" => Ok(Until::Hausdorff(finite(value)?)),
        "width" => {
            let (within, along) = value.split_once('@').ok_or_else(wrong)?;
            let along = along.split(',').map(|c| finite(c.trim())).collect::<Result<Vec<_>, _>>()?;
            if matches!(along.len(), 2 | 3) { Ok(Until::Width(finite(within)?, along)) } else { Err(wrong()) }
        }
        _ => Err(wrong()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_read_and_what_is_none_is_named() {
        assert_eq!(until("gap=0.1"), Ok(Until::Gap(0.1)));
        assert_eq!(until("hausdorff=1e-3"), Ok(Until::Hausdorff(1e-3)));
        assert_eq!(until("width=0.5@0, 0,1"), Ok(Until::Width(0.5, vec![0.0, 0.0, 1.0])));
        let of = |a: &str, b: &str| until(a).unwrap().is_of(&until(b).unwrap());
        assert!(of("gap=0.1", "gap=0.2") && of("width=1@0,1", "width=2@0,1"));
        assert!(!of("gap=0.1", "hausdorff=0.1") && !of("width=1@0,1", "width=1@1,0"));
        for wrong in
            ["", "gap", "gap=", "gap=nan", "gap=inf", "width=1", "width=1@1", "width=1@1,2,3,4", "size=1"]
        {
            assert!(until(wrong).is_err(), "{wrong}");
        }
    }
}
