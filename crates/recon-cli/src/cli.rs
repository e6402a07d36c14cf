//! What can be asked for on the command line.

mod explore;

pub(crate) use explore::{ExploreArgs, GoalArgs, NextArgs, PlannerAs, Until, until};

use clap::{Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use recon::least_model::Accuracy;
use std::ffi::OsString;
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    a fault of recon itself, as where results fail the check at their end; nothing is written then
  2    the command line is not understood
  3    an input (log, scene, contacts) cannot be used, or a folder of results does not hold (`recon check`)
  4    done, but the result is not to be relied on, or ends before it was asked to; it is written, and says why
  5    a result cannot be written; what stood there before stands there still
  130  interrupted; nothing is left half-written";

const SHORT: &str = "`recon demo` shows what it does; `recon init` gives files to begin from; `--help` has examples and exit codes.";

const EXAMPLES: &str = "\
Examples:
  recon demo                                        the paper's Fig. 5, from nothing to a report
  recon init start                                  a commented scene, a log and contacts to begin from
  recon check-input log.csv --scene scene.toml      what is understood of a log: units, rates, gaps, noise, touches
  recon formats                                     columns, frames and units of all files
  recon simulate scene.toml -o log.csv              a sensor log of a known object
  recon reconstruct log.csv --scene scene.toml -o out   shape, motion and bounds from a log
  recon batch logs --scene scene.toml -o results    all logs of a folder, on all cores, and a table of what came out
  recon inspect bag.mcap -o map.toml                what a robot's log (ROS 2, MCAP) holds, and a mapping of its topics
  recon follow - --scene scene.toml                 the motion as it becomes known, from a running log
  recon bounds out/contact_curves.csv -o bounds     bounds from contact points and normals alone
  recon explore scene.toml --until gap=0.1 -o out   touches an object until its shape is proven
  recon next out                                    where to touch next, from the contacts so far
  recon check out                                   whether results hold, by their files alone";

/// Shape, motion and bounds of an unknown smooth convex object, from touch alone.
#[derive(Debug, Parser)]
#[command(name = "recon", version, after_help = SHORT, after_long_help = format!("{EXAMPLES}\n\n{EXIT_CODES}"), propagate_version = true)]
pub(crate) struct Cli {
    /// Print results as JSON on standard output, and errors as JSON on standard error
    #[arg(long, global = true)]
    pub(crate) json: bool,
    /// Say nothing but errors: no progress, no notes, and of results in files no word. What stands on standard output alone is printed
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
    /// What to do
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Simulate an object on palms of any shape and write its sensor log
    Simulate(SimulateArgs),
    /// Reconstruct motion, contact curves and bounds from a sensor log
    Reconstruct(ReconstructArgs),
    /// Reconstruct all logs of a folder, on all cores
    Batch(BatchArgs),
    /// Look over a bag of ROS 2 (MCAP): topics, rates, gaps, clocks; and draft the mapping of its topics
    Inspect(InspectArgs),
    /// Follow the motion sample by sample, as a log is written or at the pace of reading it
    Follow(FollowArgs),
    /// Bound a convex object from contact points with outward normals, or from its poses above a plane
    Bounds(BoundsArgs),
    /// Reconstruct a planar object between two hinged palms from a planar log, or the scene of the paper's Fig. 3
    Planar(PlanarArgs),
    /// Tell the outline of an object, friction and contact modes from pushes by a round finger on a table
    Pushes(PushesArgs),
    /// Simulate and reconstruct the scene of the paper's Fig. 5, or show another scene, with no input at all
    Demo(DemoArgs),
    /// Write a scene of palms of any shape for MuJoCo
    Export(ExportArgs),
    /// Check a folder of results again, by its files alone
    Check(CheckArgs),
    /// Touch a scene's object where it pays most, until its shape is proven to a goal
    Explore(ExploreArgs),
    /// Say where to touch next, from the contacts known so far
    Next(NextArgs),
    /// Write files to begin from: a commented scene, a log, a list of contacts
    Init(InitArgs),
    /// Tell the columns, frames and units of files
    Formats(FormatsArgs),
    /// Tell what is understood of a log or a list of contacts, before anything is estimated
    CheckInput(CheckInputArgs),
    /// Write completions of the command line for a shell
    Completions(CompletionsArgs),
    /// Write the manual page
    Man,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
The scene is a TOML file with gravity, [object] mass and inertia, and [simulation] shape, palms, start and duration.
`recon demo` writes one (scene.toml) to begin from. The log holds the truth beside the readings; noise is put on the
readings where [sensors] gives its standard deviations. Palms of any number, shape and motion, with friction, stand in
[[palm]] tables; their log is of version 2, and the changes of contact modes are told. With `plane = true` the scene is one of
the vertical plane, and its log a planar one of version 2.

Examples:
  recon simulate scene.toml -o log.csv
  recon simulate scene.toml -o log.csv --report page.html
  recon simulate scene.toml -o log.csv --accuracy 1e-6 --explain
  recon simulate scene.toml -o - | head -3")]
pub(crate) struct SimulateArgs {
    /// Scene file (TOML)
    pub(crate) scene: PathBuf,
    /// Sensor log to write (CSV); `-` for standard output, links are followed, pipes and devices written to
    #[arg(short, long)]
    pub(crate) output: PathBuf,
    /// Page to write as well (HTML), of scenes with [[palm]] tables: pictures, contact modes, forces, slip
    #[arg(long)]
    pub(crate) report: Option<PathBuf>,
    /// Tolerance of the integration, relative and absolute
    #[arg(long, default_value = "1e-12", value_parser = tolerance, conflicts_with = "accuracy")]
    pub(crate) tolerance: f64,
    /// Accuracy that is wanted, at any sample: of the centre of mass in sizes of the object and of its orientation in rad. The loosest tolerance
    /// that reaches it is chosen, by an error estimate
    #[arg(long, value_name = "SHARE", value_parser = accuracy)]
    pub(crate) accuracy: Option<Accuracy>,
    /// Say what was modelled, what was left out, and what that costs
    #[arg(long, requires = "accuracy")]
    pub(crate) explain: bool,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
The log is CSV (sensor log, version 1): t, and for each palm i the contact s1_i, s2_i, the normal nx_i, ny_i, nz_i and
the force f_i or torque tau_i. The scene gives gravity, mass and inertia; with --identify mass and inertia are estimated
along, and those of the scene are not looked at. No initial guess is needed.

A log may be a bag of ROS 2 (MCAP) too: --mapping says which of its topics are which readings of which palm, and `recon inspect` drafts it.

A log of contacts (version 2) need not be of three flat palms without friction: of any one to five palms with forces or impulses in three axes,
motion, mass and inertia are estimated together, with their deviations and with the contact modes, and the body is taken as
unknown. The scene states the noise ([sensors]: contact_std, force_std or force_share, impulse_std or impulse_share), and where all contacts are on one
palm the size (object.size). motion.csv says at each sample whether it is relied on.

The output folder appears as a whole or not at all: motion.csv, contact_curves.csv, radius_functions.csv, summary.json,
lower_bound.ply, upper_bound.ply, report.html, which opens in any browser, and manifest.json, which lists them. With --export it holds the object for
simulators too: object.xml (MJCF), object.urdf, and the meshes that these refer to. With --mcap it holds result.mcap, a bag that Foxglove
shows: motion with covariance, contacts, forces and bounds, at the stamps of the bag that was read. With --covariance it holds
covariance.csv: of motion.csv the covariances of position and turn, where that has their deviations.

The bounds hold at 95 % confidence for the noise of the sensors and the error of the motion, in the axes that bounds_frame in
summary.json names. A motion that is not to be relied on gives none.

With --without-forces the contacts and palm poses alone are fitted with the motion of an ellipsoid, its centre anywhere; mass
and inertia of the scene are not looked at, and only inertia over mass is found. Then the folder holds motion.csv,
summary.json, report.html and, where contacts are exact, the bounds.

Examples:
  recon reconstruct log.csv --scene scene.toml -o out
  recon reconstruct log.csv --scene scene.toml -o out --identify --export mjcf,urdf
  recon reconstruct log.csv --scene scene.toml -o out --mesh stl,glb
  recon reconstruct log.csv --scene scene.toml -o out --accuracy 1e-2 --explain
  recon reconstruct log.csv --scene scene.toml -o out --without-forces
  recon reconstruct bag.mcap --mapping map.toml --scene scene.toml -o out --mcap
  recon reconstruct log.csv --scene scene.toml -o out --json | jq .bounds")]
pub(crate) struct ReconstructArgs {
    /// Sensor log (CSV, or a bag of ROS 2 in MCAP)
    pub(crate) log: PathBuf,
    /// Scene file (TOML)
    #[arg(short, long)]
    pub(crate) scene: Option<PathBuf>,
    /// Mapping of a bag's topics (TOML)
    #[arg(short, long)]
    pub(crate) mapping: Option<PathBuf>,
    /// Folder to write; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long, default_value = "recon-out")]
    pub(crate) output: PathBuf,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long)]
    pub(crate) force: bool,
    /// Estimate mass and inertia too, with their deviations
    #[arg(long)]
    pub(crate) identify: bool,
    /// Accuracy that is wanted, with 95 %, root mean square over the log: of the centre of mass in sizes of the object and of its turn in rad. The
    /// cheapest model that reaches it is chosen: in the plane, without friction, of an unknown body, by fewer samples
    #[arg(long, value_name = "SHARE", value_parser = accuracy, conflicts_with = "without_forces")]
    pub(crate) accuracy: Option<Accuracy>,
    /// Say what was modelled, what was left out, and what that costs
    #[arg(long, requires = "accuracy")]
    pub(crate) explain: bool,
    /// Use no forces, though the log may have them: for an ellipsoid, on palms without force sensors
    #[arg(long, conflicts_with_all = ["identify", "export"])]
    pub(crate) without_forces: bool,
    /// Write the object for simulators too, in these formats
    #[arg(long, value_delimiter = ',', value_name = "FORMATS")]
    pub(crate) export: Vec<ExportAs>,
    /// Write the meshes of the bounds in these formats too, beside PLY
    #[arg(long, value_delimiter = ',', value_name = "FORMATS", conflicts_with = "without_forces")]
    pub(crate) mesh: Vec<MeshAs>,
    /// Write motion, contacts, forces and bounds as a bag too (result.mcap), for Foxglove and Rerun
    #[arg(long, conflicts_with = "without_forces")]
    pub(crate) mcap: bool,
    /// Write the covariance of the pose at all samples too (covariance.csv)
    #[arg(long, conflicts_with = "without_forces")]
    pub(crate) covariance: bool,
    /// Shape of the exported object
    #[arg(long, default_value = "auto", requires = "export")]
    pub(crate) export_shape: ShapeAs,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Each CSV or MCAP file of the folder is a log. Its scene is the TOML file of the same name beside it, or else that of --scene. Results of `a.csv`
are in the folder `a` of the output, as `recon reconstruct` writes them, and results.csv there has a row for each log: whether it is relied on, mass and
inertia with deviations, bounds, and why not. index.html shows all of them small.

What is done is not done again: results that hold, of the same log, scene and options by length and CRC-32, are kept, so that a run that was
interrupted goes on where it ended. A log that cannot be used is named and skipped; then the exit code is 4, as where a
result is not to be relied on.

Examples:
  recon batch logs --scene scene.toml -o results
  recon batch logs --scene scene.toml -o results --identify --jobs 4")]
pub(crate) struct BatchArgs {
    /// Folder of logs
    pub(crate) folder: PathBuf,
    /// Scene file (TOML) of the logs that have none of their own
    #[arg(short, long)]
    pub(crate) scene: Option<PathBuf>,
    /// Mapping of the topics of bags (TOML)
    #[arg(short, long)]
    pub(crate) mapping: Option<PathBuf>,
    /// Folder to write
    #[arg(short, long, default_value = "recon-batch")]
    pub(crate) output: PathBuf,
    /// Estimate mass and inertia too, with their deviations
    #[arg(long)]
    pub(crate) identify: bool,
    /// Write the objects for simulators too, in these formats
    #[arg(long, value_delimiter = ',', value_name = "FORMATS")]
    pub(crate) export: Vec<ExportAs>,
    /// Logs at a time [default: as many as there are cores]
    #[arg(short, long, value_parser = at_least_one)]
    pub(crate) jobs: Option<usize>,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Read are WrenchStamped, PointStamped, PoseStamped, TFMessage, JointState, Image of one number a pixel, TactileState, and
recon_msgs/Contact (its definition comes with recon-io, in ros/recon_msgs). Topics come with their rates, gaps (by stamps and by the recorder's numbers),
latencies and frames. Where a palm has contacts and a wrench, their clocks are compared: the contacts that the wrench gives go
the same way, earlier or later.

The mapping that is drafted names a frame, topics and, where contacts tell it, the shape of each palm, and clocks that are
ahead. Look it over: nothing in a bag says on which body a force acts. With --mapping that mapping is used, and its log is told.

Exit code 4 says that the bag was cut off, or that a topic of a kind that is read cannot be: an unknown encoding, no message, no frame, NaN.

Examples:
  recon inspect bag.mcap
  recon inspect bag.mcap -o map.toml
  recon inspect bag.mcap --mapping map.toml --scene scene.toml --csv log.csv
  recon inspect bag.mcap --json | jq .clocks")]
pub(crate) struct InspectArgs {
    /// Bag (MCAP)
    pub(crate) bag: PathBuf,
    /// File to write the drafted mapping to (TOML) [default: standard output]
    #[arg(short, long, conflicts_with = "mapping")]
    pub(crate) output: Option<PathBuf>,
    /// Mapping to use in place of the drafted one (TOML)
    #[arg(short, long)]
    pub(crate) mapping: Option<PathBuf>,
    /// Scene file (TOML), for the palms' shapes
    #[arg(short, long)]
    pub(crate) scene: Option<PathBuf>,
    /// Sensor log to write (CSV, version 2)
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
The log is CSV as for `recon reconstruct`, of three planes or of any palms with forces, a file or standard input (`-`), taken line
by line: a robot may be writing it. The scene gives gravity, mass and inertia (with --identify these are estimated along), and the noise of the sensors where no
option does.

The result is a table (CSV): t, position, orientation, velocity and angular velocity as in motion.csv; std_cm (m), std_v (m/s),
std_w (rad/s) and std_turn (rad), standard deviations of all axes together; stage (gathering, searching, tracking,
contradicted); relied_on; misfit, about 1 where all is as stated; mass (kg) and std_mass. Without a motion they are nan. At the end
it says when the motion was known and when not.
With --json it is one object a line.

Examples:
  recon follow log.csv --scene scene.toml -o motion.csv --report page.html
  robot | recon follow - --scene scene.toml --identify --every 0.02")]
pub(crate) struct FollowArgs {
    /// Sensor log (CSV); `-` for standard input
    pub(crate) log: PathBuf,
    /// Scene file (TOML)
    #[arg(short, long)]
    pub(crate) scene: Option<PathBuf>,
    /// Estimate mass and inertia too
    #[arg(long)]
    pub(crate) identify: bool,
    /// Standard deviation of s1 and s2, m [default: the scene's sensors.contact_std]
    #[arg(long, value_name = "M", value_parser = positive)]
    pub(crate) contact_noise: Option<f64>,
    /// Standard deviation of f, N [default: the scene's sensors.force_std]
    #[arg(long, value_name = "N", value_parser = positive)]
    pub(crate) force_noise: Option<f64>,
    /// Samples a second [default: those of the log's first samples]
    #[arg(long, value_name = "HZ", value_parser = positive)]
    pub(crate) rate: Option<f64>,
    /// Time between rows of the table, s
    #[arg(long, value_name = "S", default_value_t = 0.1, value_parser = not_negative)]
    pub(crate) every: f64,
    /// File to write [default: standard output]; links are followed, pipes and devices written to
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Page to write as well (HTML) at the end: what was known when, curves with their deviations, contact modes
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
}

/// A format of an exported object.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum ExportAs {
    /// MuJoCo (object.xml)
    Mjcf,
    /// ROS and others (object.urdf)
    Urdf,
}

/// A format of meshes beside PLY. Coordinates have seven digits in both.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum MeshAs {
    /// Binary STL, in metres: for printers and CAD
    Stl,
    /// Binary glTF 2.0, in metres: for viewers and browsers
    Glb,
}

impl MeshAs {
    /// What its files end in.
    pub(crate) fn ending(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::Glb => "glb",
        }
    }
}

/// What an exported object collides with.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum ShapeAs {
    /// The ellipsoid through the contacts where they are those of one, else the inner bound
    Auto,
    /// The ellipsoid that fits the contacts best, whether they are those of one or not
    Ellipsoid,
    /// The inner bound: the hull of all contacts
    Inner,
    /// The outer bound: what all contacts leave of space
    Outer,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Contacts are CSV with the columns x, y, z (m) and nx, ny, nz (outward unit normal), in any one frame of the object; a
column `palm` or `curve` numbers the curves along which they were traced. They are taken as exact unless their noise is
stated or estimated: then the bounds hold at the stated confidence, and contacts that cannot be right are left out and
listed. Limits on the radii of curvature tighten the bounds; their meshes are then within a thousandth of the size.

With --fit a shape of few parameters is fitted too, and told with its covariance: a family, or auto for the one of the
smallest information criterion. A shape that the contacts refute (p-value below 1e-4 of the chi-squared test where noise is
stated, of the likeness of neighbours' residuals where it is not) is refused with exit code 4; bounds are written all the
same. With --concave the object need not be convex: the bounds are those of its hull, and an alpha shape and a smooth
surface are written too, which are approximations. --surface writes a smooth surface of any contacts: hermite and spline go
through exact ones, principal through the midst of noisy ones, smoothed by what the contacts or the stated noise ask for. A
spline errs least where its object is seen from some place inside as a whole; one that is not takes hermite.

Contacts in the plane have the columns x, y and nx, ny alone. Areas stand for volumes, and a picture (bounds.svg) and
corners (lower_bound.csv, upper_bound.csv) for meshes.

Poses above a plane are CSV with the columns qw, qx, qy, qz (body to world) and px, py, pz (m, z upwards), sampled evenly; a
column `toss` or `run` numbers the runs. Their noise is judged from their own consistency, by a rule that holds on
simulated tosses with room to spare; --tight takes the narrowest margins that hold there, which cut the one real body that
was tried. Runs that contradict the others are left out and named. What the plane's height may be off is stated by
--height-deviation where one error is common to all runs, and by --run-height-deviation where each run has its own; the
bounds are the wider for it.

The output folder appears as a whole or not at all: lower_bound.ply, upper_bound.ply (m; in the plane
.csv and bounds.svg), summary.json and the page report.html, with --fit fitted_shape.ply, with --concave
alpha_shape.ply, with that or --surface smooth_surface.ply.

Examples:
  recon bounds contacts.csv
  recon bounds contacts.csv --fit auto
  recon bounds contacts.csv --estimate-noise --fit harmonics:4 -o bounds
  recon bounds contacts.csv --concave -o bounds
  recon bounds contacts.csv --surface spline -o bounds
  recon bounds contacts.csv --estimate-noise --surface principal -o bounds
  recon bounds contacts.csv --contact-noise 1e-4 --normal-noise 2e-3 --confidence 0.99 -o bounds
  recon bounds contacts.csv --estimate-noise -o bounds
  recon bounds contacts.csv --rho-min 0.02 --rho-max 0.2 -o bounds
  recon bounds tosses.csv --plane-height 0.002 -o bounds
  recon bounds tosses.csv --plane-height 0 --height-deviation 0.001 -o bounds")]
pub(crate) struct BoundsArgs {
    /// Contact points with outward normals, or poses above a plane (CSV)
    pub(crate) input: PathBuf,
    /// Standard deviation per axis of the contact points, m
    #[arg(long, value_name = "M", requires = "normal_noise", value_parser = not_negative)]
    pub(crate) contact_noise: Option<f64>,
    /// Standard deviation of the normals about each tangent axis, rad
    #[arg(long, value_name = "RAD", requires = "contact_noise", value_parser = not_negative)]
    pub(crate) normal_noise: Option<f64>,
    /// Judge the noise of contacts by the roughness of their curves
    #[arg(long, conflicts_with_all = ["contact_noise", "normal_noise"])]
    pub(crate) estimate_noise: bool,
    /// Confidence of bounds under noise, between 0.5 and 1 [default: 0.95]
    #[arg(long, value_parser = confidence)]
    pub(crate) confidence: Option<f64>,
    /// Smallest radius of curvature that the object has anywhere, m [default: 0 where the largest is given]
    #[arg(long, value_name = "M", requires = "rho_max", value_parser = not_negative)]
    pub(crate) rho_min: Option<f64>,
    /// Largest radius of curvature that the object has anywhere, m
    #[arg(long, value_name = "M", value_parser = positive)]
    pub(crate) rho_max: Option<f64>,
    /// Fit a shape: auto, ball, ellipsoid, superquadric or harmonics:N (degree); in the plane auto, circle, ellipse or
    /// waves:N (order)
    #[arg(long, value_name = "FAMILY", value_parser = fit)]
    pub(crate) fit: Option<FitAs>,
    /// The object need not be convex: bound its hull, and approximate the object itself
    #[arg(long, conflicts_with_all = ["contact_noise", "normal_noise", "estimate_noise", "rho_min", "rho_max", "fit"])]
    pub(crate) concave: bool,
    /// Radius of the balls that hollow the alpha shape out, m [default: the smallest that leaves it in one piece]
    #[arg(long, value_name = "M", requires = "concave", value_parser = positive)]
    pub(crate) alpha: Option<f64>,
    /// Approximate the object by a smooth surface, which is no bound [default with --concave: hermite]
    #[arg(long, value_name = "KIND")]
    pub(crate) surface: Option<SurfaceAs>,
    /// Narrower margins for poses, right for trackers like the simulated ones alone
    #[arg(long)]
    pub(crate) tight: bool,
    /// Height of the plane below the poses, m [default: 0]
    #[arg(long, value_name = "M", value_parser = finite)]
    pub(crate) plane_height: Option<f64>,
    /// Standard deviation of that height, m: an error common to all runs
    #[arg(long, value_name = "M", value_parser = not_negative)]
    pub(crate) height_deviation: Option<f64>,
    /// Standard deviation of the plane's height from run to run, m
    #[arg(long, value_name = "M", value_parser = not_negative)]
    pub(crate) run_height_deviation: Option<f64>,
    /// Write the meshes in these formats too, beside PLY
    #[arg(long, value_delimiter = ',', value_name = "FORMATS", requires = "output")]
    pub(crate) mesh: Vec<MeshAs>,
    /// Folder to write the meshes and summary.json to; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long)]
    pub(crate) output: Option<PathBuf>,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long, requires = "output")]
    pub(crate) force: bool,
}

impl PlanarArgs {
    /// kg m^2.
    pub(crate) fn palm_inertias(&self) -> [f64; 2] {
        [0, 1].map(|i| self.palm_inertias.get(i).copied().unwrap_or_default())
    }
}

/// A smooth surface that approximates the object.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum SurfaceAs {
    /// Through contacts and normals, of any shape
    Hermite,
    /// Through contacts and normals, of an object that is seen from inside as a whole
    Spline,
    /// Through the midst of noisy contacts, their normals left out
    Principal,
}

/// A family of shapes to fit.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum FitAs {
    /// That of the smallest information criterion.
    Auto,
    Ball,
    Ellipsoid,
    Superquadric,
    /// Spherical harmonics up to a degree.
    Harmonics(usize),
    Circle,
    Ellipse,
    /// Waves of the radius function up to an order.
    Waves(usize),
}

impl FitAs {
    /// Whether it is one for contacts in space, and one for contacts in the plane.
    pub(crate) fn is_for(self) -> (bool, bool) {
        match self {
            Self::Auto => (true, true),
            Self::Ball | Self::Ellipsoid | Self::Superquadric | Self::Harmonics(_) => (true, false),
            Self::Circle | Self::Ellipse | Self::Waves(_) => (false, true),
        }
    }
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
The log is CSV (planar log, version 1): t, phi1, phi2, s1, s2 and f1, f2 or tau1, tau2. With forces the motion is estimated
from no guess, and mass and inertia with it where they are not stated; without forces the shape is fitted to contacts and palm
angles alone. Without a log the scene of the paper's Fig. 3 is simulated first. Logs of any palms in the plane, with friction,
go through `recon reconstruct --scene` with a scene that says `plane = true`.

The output folder appears as a whole or not at all: motion.csv, contact_points.csv, summary.json, the page report.html and
figures.svg (shape, orientation, centre of mass, radius functions and, where the log has the truth, errors: the paper's Figs. 2b,
2c, 3a, 3b); with forces, where the motion is relied on and closes the outline, lower_bound.csv and
upper_bound.csv, which hold at 95 %.

Examples:
  recon planar
  recon planar log.csv --mass 0.2 --inertia 1.458e-4 --contact-noise 1e-4 -o out
  recon planar log.csv --contact-noise 1e-4 --order 5 -o out")]
pub(crate) struct PlanarArgs {
    /// Planar log (CSV)
    pub(crate) log: Option<PathBuf>,
    /// Mass in kg, where it is known
    #[arg(long, requires = "inertia", value_parser = positive)]
    pub(crate) mass: Option<f64>,
    /// Moment of inertia about the centre of mass in kg m^2, where it is known
    #[arg(long, requires = "mass", value_parser = positive)]
    pub(crate) inertia: Option<f64>,
    /// Gravity in m/s^2
    #[arg(long, default_value_t = 9.81, value_parser = positive)]
    pub(crate) gravity: f64,
    /// Standard deviation of the contact readings in m [default: by the roughness of the readings]
    #[arg(long, value_parser = not_negative)]
    pub(crate) contact_noise: Option<f64>,
    /// Standard deviation of the forces in N [default: by the roughness of the readings]
    #[arg(long, value_parser = not_negative)]
    pub(crate) force_noise: Option<f64>,
    /// Moments of inertia of both palms about the hinge in kg m^2, for logs with torques in place of forces [default: 0 0]
    #[arg(long, num_args = 2, value_names = ["I1", "I2"], value_parser = not_negative)]
    pub(crate) palm_inertias: Vec<f64>,
    /// Highest harmonic of the shape, where it is fitted without forces
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u8).range(1..=20))]
    pub(crate) order: u8,
    /// Folder to write; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long, default_value = "recon-planar")]
    pub(crate) output: PathBuf,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Both files are CSV (push-samples, push-poses in `recon formats`): force on the object and centre of the finger in the world
throughout each push; poses of the object only before and after it. A push begins off the object and is slow enough that
friction with the table alone resists. Files with a column `log` hold several logs, each of one object, finger and table.

The output folder appears as a whole or not at all: the page report.html, outline.csv, corners.csv, touches.csv, modes.csv
(sticking or sliding at each instant, with probabilities) and summary.json. The outline is in the frame of the poses.

Examples:
  recon pushes pushes.csv --poses poses.csv --radius 0.001 -o out
  recon pushes pushes.csv --poses poses.csv --radius 0.001 --log 2 -o out")]
pub(crate) struct PushesArgs {
    /// Samples of force and finger (CSV)
    pub(crate) pushes: PathBuf,
    /// Poses before and after each push (CSV)
    #[arg(long)]
    pub(crate) poses: PathBuf,
    /// Radius of the finger in m
    #[arg(long, value_parser = positive)]
    pub(crate) radius: f64,
    /// Number of the one log that is looked at [default: all]
    #[arg(long)]
    pub(crate) log: Option<u32>,
    /// Folder to write; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long, default_value = "recon-pushes")]
    pub(crate) output: PathBuf,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Scenes of palms that move, with friction, are simulated through the changes of contact modes: the folder then holds the
scene, its log (version 2), the scene for MuJoCo (scene.xml), summary.json and a report with pictures, bands of modes, forces,
slip and energy.

Examples:
  recon demo
  recon demo -o somewhere
  recon demo --scene three-tilting-palms -o turned")]
pub(crate) struct DemoArgs {
    /// What is shown
    #[arg(long, default_value = "fig5")]
    pub(crate) scene: DemoScene,
    /// Folder to write; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long, default_value = "recon-demo")]
    pub(crate) output: PathBuf,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
The scene is one that `recon simulate` takes, with [[palm]] tables. The folder appears as a whole or not at all: scene.xml (MJCF)
with the object in its first state (keyframe `start`), palms, friction, springs and motors, the meshes of shapes that MuJoCo
does not know, summary.json and manifest.json. Joints `palm_i_j` follow the parts of a palm's motion: whoever steps the model sets them by the laws in its
custom fields.

Examples:
  recon export scene.toml -o model
  recon export scene.toml -o model --json | jq .files")]
pub(crate) struct ExportArgs {
    /// Scene file (TOML)
    pub(crate) scene: PathBuf,
    /// Folder to write; what an earlier run wrote there and nobody changed is replaced
    #[arg(short, long)]
    pub(crate) output: PathBuf,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long)]
    pub(crate) force: bool,
}

/// A scene to begin from.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum DemoScene {
    /// The paper's Fig. 5, simulated and reconstructed
    Fig5,
    /// Three palms that tilt in turn and turn an ellipsoid over, simulated
    ThreeTiltingPalms,
    /// Three fingertips that take an ellipsoid from a table, simulated
    PickUp,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
What every command checks before it writes a folder, done again by code that had no part in making the results: the files
are those that recon wrote (sizes and CRC-32 in manifest.json), all numbers are finite, meshes are closed and turned one
way, bounds are convex, as large as stated, and the lower one lies inside the upper one (by exact signs; what rounding or
stated tolerances allow is told), and every fit says how it ended.

Examples:
  recon check recon-out
  recon check bounds --json")]
pub(crate) struct CheckArgs {
    /// Folder that recon wrote
    pub(crate) folder: PathBuf,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
The folder holds scene.toml (what is known of a scene, each key explained), log.csv (what palms felt in it), contacts.csv (points with
normals), and summary.json with the commands to go on with. Put your own numbers in their places.

Examples:
  recon init
  recon init start && recon reconstruct start/log.csv --scene start/scene.toml -o out")]
pub(crate) struct InitArgs {
    /// Folder to write
    #[arg(default_value = "recon-init")]
    pub(crate) folder: PathBuf,
    /// Write beside files in the folder that recon did not write; these are never replaced or removed
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  recon formats
  recon formats log-2
  recon formats --json | jq '.[].name'")]
pub(crate) struct FormatsArgs {
    /// Name of one format [default: all of them]
    pub(crate) name: Option<String>,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Nothing is estimated. Told are the kind of file, units and frames, palms with shapes, rate and gaps, which palm touches when, what is measured and how
noisy it is (as stated, or by the roughness of the readings), whether units go together, and which estimator takes the log.
Exit code 4 says that something does not go together.

Examples:
  recon check-input log.csv --scene scene.toml
  recon check-input contacts.csv
  recon check-input log.csv --scene scene.toml --report page.html
  recon check-input log.csv --scene scene.toml --json | jq .gaps")]
pub(crate) struct CheckInputArgs {
    /// Sensor log (CSV, or a bag of ROS 2 in MCAP), contacts or poses (CSV)
    pub(crate) input: PathBuf,
    /// Scene file (TOML); logs need one
    #[arg(short, long)]
    pub(crate) scene: Option<PathBuf>,
    /// Mapping of a bag's topics (TOML)
    #[arg(short, long)]
    pub(crate) mapping: Option<PathBuf>,
    /// Write what is told, with pictures of the readings, as a page too (HTML)
    #[arg(long, value_name = "PAGE")]
    pub(crate) report: Option<PathBuf>,
}

#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  recon completions bash > ~/.local/share/bash-completion/completions/recon
  recon completions zsh > ~/.zfunc/_recon")]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: clap_complete::Shell,
}

fn fit(text: &str) -> Result<FitAs, String> {
    let (name, order) = text.split_once(':').map_or((text, None), |(name, order)| (name, Some(order)));
    let order = |least: usize, most: usize| {
        let given = order.and_then(|order| order.parse().ok()).filter(|n| (least..=most).contains(n));
        given.ok_or_else(|| format!("`{name}` needs a number from {least} to {most}, as {name}:4"))
    };
    match name {
        "harmonics" => order(1, 32).map(FitAs::Harmonics),
        "waves" => order(1, 32).map(FitAs::Waves),
        _ if text.contains(':') => Err(format!("`{name}` takes no number")),
        "auto" => Ok(FitAs::Auto),
        "ball" => Ok(FitAs::Ball),
        "ellipsoid" => Ok(FitAs::Ellipsoid),
        "superquadric" => Ok(FitAs::Superquadric),
        "circle" => Ok(FitAs::Circle),
        "ellipse" => Ok(FitAs::Ellipse),
        _ => {
            Err("give auto, ball, ellipsoid, superquadric, harmonics:N, circle, ellipse or waves:N"
                .to_owned())
        }
    }
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|count| *count > 0).ok_or_else(|| "give a whole number from 1 on".to_owned())
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    if (1e-15..=1e-2).contains(&value) {
        Ok(value)
    } else {
        Err("it must lie between 1e-15 and 1e-2".to_owned())
    }
}

fn accuracy(text: &str) -> Result<Accuracy, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    Accuracy::new(value).map_err(|error| error.to_string())
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("it must be positive and finite".to_owned())
    }
}

fn not_negative(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    if value >= 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err("it must be finite and at least 0".to_owned())
    }
}

fn confidence(text: &str) -> Result<f64, String> {
    let value = finite(text)?;
    if value > 0.5 && value < 1.0 {
        Ok(value)
    } else {
        Err("it must lie between 0.5 and 1, as 0.95".to_owned())
    }
}

fn finite(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    if value.is_finite() { Ok(value) } else { Err("it must be finite".to_owned()) }
}

impl Cli {
    /// The command that these words make, the first of which is its name. A number below zero is a value that may be refused, and no option.
    pub(crate) fn of(
        words: impl IntoIterator<Item = impl Into<OsString> + Clone>,
    ) -> Result<Self, clap::Error> {
        let command = Self::command().mut_subcommands(|command| command.allow_negative_numbers(true));
        Self::from_arg_matches(&command.try_get_matches_from(words)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_consistent() {
        Cli::command().debug_assert();
    }
}
