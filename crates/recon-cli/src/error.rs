use recon::object_dynamics::planar as object_planar;
use recon::object_dynamics::{
    ContactLogError, ContactSimulationError, LogError, MassError, NotThreePlanes,
    SceneError as DynamicsError, SimulationError,
};
use recon::observer::contacts::ContactEstimateError;
use recon::observer::pushes::PushesError;
use recon::shape_bounds::approximation::ApproximationError;
use recon::shape_bounds::concave::{AlphaError, SurfaceError};
use recon::shape_bounds::curvature::CurvatureError;
use recon::shape_bounds::exact_hull::IntersectionError;
use recon::shape_bounds::fit::FitError;
use recon::shape_bounds::noise::NoiseError;
use recon::shape_bounds::poses::PoseError;
use recon::shape_bounds::{BoundsError, FacetError, planar};
use recon_io::{
    BagError, CheckError, ExportError, LogFileError, MappingError, MeshError, OutputError, SceneError,
    TouchesError,
};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// How a command ended that did not fail.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Outcome {
    /// All is as asked.
    Done,
    /// There is a result, and it says why it must not be relied on, or why it is less than was asked for.
    WithReservations,
}

impl Outcome {
    pub(crate) fn code(self) -> u8 {
        match self {
            Self::Done => 0,
            Self::WithReservations => 4,
        }
    }
}

/// Why a command failed.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    #[error("the sensor log cannot be used")]
    Log(#[from] LogFileError),
    #[error("the bag cannot be used")]
    Bag(#[from] BagError),
    #[error("the results make no bag")]
    ResultBag(#[source] std::io::Error),
    #[error("the folder {} cannot be read", path.display())]
    Folder { path: PathBuf, source: std::io::Error },
    #[error("{} holds no logs: CSV files, or bags of ROS 2 (MCAP)", path.display())]
    NoLogs { path: PathBuf },
    #[error("{} has the name of another log but for its ending, and both would be written into one folder: rename one", path.display())]
    SameName { path: PathBuf },
    #[error("{} cannot have a folder of results: without its ending its name is that of another file there, or of no folder of its own; rename it", path.display())]
    LogName { path: PathBuf },
    #[error("`{name}` is no format; these are: {names}")]
    NoFormat { name: String, names: String },
    #[error(
        "a sensor log is read with its scene (--scene): gravity, of palms that are not three planes through the origin what they are, and \
         unless they are to be estimated (--identify) mass and inertia of the object; `recon init` writes one to start from"
    )]
    LogNeedsScene,
    #[error(
        "it is no contacts or poses, and a sensor log is read with its scene (--scene; `recon init` writes one to start from)"
    )]
    NeitherTouches {
        #[source]
        contacts: TouchesError,
    },
    #[error("{} holds no contacts.csv, which `recon explore` writes; name the file of contacts itself{}", folder.display(), curves.as_ref().map_or_else(String::new, |path| format!(", as {}", path.display())))]
    NoContactsToGoOn {
        folder: PathBuf,
        /// A file there that has contacts.
        curves: Option<PathBuf>,
    },
    #[error("the mapping of topics cannot be used")]
    Mapping(#[from] MappingError),
    #[error("{} is an MCAP bag: give the mapping of its topics by --mapping; `recon inspect {} -o map.toml` drafts one", path.display(), path.display())]
    NoMapping { path: PathBuf },
    #[error("--mapping is for MCAP bags, and {} is none", path.display())]
    MappingOfNoBag { path: PathBuf },
    #[error("{} is an MCAP bag, and only CSV is followed; `recon inspect {} --csv log.csv` makes one of it", path.display(), path.display())]
    BagFollowed { path: PathBuf },
    #[error("the scene cannot be used")]
    Scene(#[from] SceneError),
    #[error("the contacts or poses cannot be used")]
    Touches(#[from] TouchesError),
    #[error("--{option} is for {meant}, but {} holds {found}", path.display())]
    Option { option: &'static str, meant: &'static str, found: &'static str, path: PathBuf },
    #[error("the contacts give no bounds under noise")]
    NoisyBounds(#[from] NoiseError),
    #[error(
        "the noise of the contacts cannot be read off them: it is alike from one to the next ({ratio:.1} times as large over every \
         second contact as over every one, z-test, p = {p_value:.0e}), or the body has edges; state it with --contact-noise and --normal-noise"
    )]
    CorrelatedNoise { ratio: f64, p_value: f64 },
    #[error("the contacts and the limits on the curvature give no bounds")]
    Curvature(#[from] CurvatureError),
    #[error("the bounds have no meshes")]
    Facets(#[from] FacetError),
    #[error("the sensor log is not one of contacts")]
    ContactLog(#[from] ContactLogError),
    #[error("the inertia that was found is that of no body")]
    Inertia(#[from] MassError),
    #[error("the contacts in the plane give no bounds")]
    PlanarBounds(#[from] planar::BoundsError),
    #[error("the contacts in the plane give no bounds under noise")]
    PlanarNoisyBounds(#[from] planar::noise::NoiseError),
    #[error("the contacts in the plane and the limits on the curvature give no bounds")]
    PlanarCurvature(#[from] planar::curvature::CurvatureError),
    #[error("{} has no log {number}; it has {there}", path.display())]
    NoPushLog { path: PathBuf, number: u32, there: String },
    #[error("the pushes of log {log} tell no outline")]
    Pushes { log: u32, source: PushesError },
    #[error("no outline can be fitted to the contacts")]
    PlanarFit(#[from] planar::fit::FitError),
    #[error("the contacts have no alpha shape")]
    Alpha(#[from] AlphaError),
    #[error("no smooth surface goes through the contacts")]
    Surface(#[from] SurfaceError),
    #[error("no smooth surface approximates the contacts")]
    Approximation(#[from] ApproximationError),
    #[error("the poses give no bounds")]
    PoseBounds(#[from] PoseError),
    #[error(
        "mass and inertia of the object are not known; give them in a scene file (--scene) as object.mass and \
         object.principal_moments, object.inertia or object.radii_of_gyration, or have them estimated (--identify)"
    )]
    UnknownBody,
    #[error("{} has no [simulation]: give shape, palms and duration there, as in the scene that `recon demo` writes", path.display())]
    NothingToSimulate { path: PathBuf },
    #[error(
        "without forces, motion is estimated on three flat palms through one point that rests, without friction, and {} is no log \
         of those",
        path.display()
    )]
    NotThreePlanes { path: PathBuf, source: NotThreePlanes },
    #[error(
        "{} is no log of three flat palms without friction, and the estimate from contacts of any palms needs each palm's force or \
         impulse in three axes, of which palm {palm} measures neither: give the columns fx_{palm}, fy_{palm} and fz_{palm} (N), or \
         Jx_{palm}, Jy_{palm} and Jz_{palm} (N s)",
        path.display()
    )]
    NotThreeAxes { path: PathBuf, palm: usize, source: NotThreePlanes },
    #[error(
        "contacts on one palm at a time tell no size of the object: give its mean radius in m, about, in the scene as object.size"
    )]
    SizeNotStated,
    #[error(
        "the normals of the palms lead away from the object: by them the forces on it lead down, {downwards:.3} N on average, and nothing \
         would hold it; normals (nx, ny, nz, or z of a palm's pose) lead from a palm towards the object: turn them round"
    )]
    NormalsTurned { downwards: f64 },
    #[error("the log gives no motion")]
    ContactEstimate(#[from] ContactEstimateError),
    #[error("the object's shape cannot be used")]
    Shape(#[from] recon::contact_kinematics::ShapeError),
    #[error("the scene cannot be simulated")]
    Dynamics(#[from] DynamicsError),
    #[error("the simulation failed")]
    Simulation(#[from] SimulationError),
    #[error("the scene has no motion")]
    Contacts(#[from] ContactSimulationError),
    #[error("the object cannot start so")]
    PlanarStart(#[from] object_planar::StartError),
    #[error("the scene in the plane has no motion")]
    PlanarContacts(#[from] object_planar::ContactSimulationError),
    #[error("the simulated motion makes no log")]
    PlanarContactLog(#[from] object_planar::ContactLogError),
    #[error(
        "--report needs a scene with [[palm]] tables; `recon reconstruct` makes a page of the log of this one"
    )]
    NoPage,
    #[error("the motion makes no page")]
    Page(#[source] std::io::Error),
    #[error("the sensor noise of the scene makes the log unusable")]
    ContactNoise(#[source] ContactLogError),
    #[error("the sensor noise of the scene makes the log unusable")]
    Noise(#[source] LogError),
    #[error(
        "palm {palm} has no contact force: the log needs f_{palm}, or tau_{palm} with the palm's moment of inertia in the scene and contacts away from its axis (a log of contacts: fn_{palm}, or the impulse of every palm in three axes, Jx_{palm}, Jy_{palm}, Jz_{palm}); an ellipsoid is found from contacts alone (`recon reconstruct --without-forces`)"
    )]
    NoPalmForce {
        /// Number from 1.
        palm: usize,
    },
    #[error("the log gives no motion, and is unlike its scene: {odd}")]
    Hopeless { odd: String },
    #[error("the log gives no motion, and is unlike its scene: {odd}")]
    OddLog {
        /// What is odd about it.
        odd: String,
        source: ContactEstimateError,
    },
    #[error("the log cannot be followed")]
    Stream(#[from] recon::observer::contacts::stream::StreamError),
    #[error(
        "following a motion needs the noise of the sensors: give --contact-noise (m) and --force-noise (N), or \
         sensors.contact_std and sensors.force_std in the scene"
    )]
    StreamNoise,
    #[error("the log has {found} sample(s); following a motion needs {needed}")]
    TooFewSamples { found: usize, needed: usize },
    #[error("contacts alone give no motion")]
    WithoutForces(#[from] recon::observer::three_palms::no_force::NoForceError),
    #[error("--without-forces needs a scene file (--scene), for gravity")]
    NoGravity,
    #[error("the planar log gives no motion")]
    PlanarEstimate(#[from] recon::observer::planar::PlaneEstimateError),
    #[error("the planar log gives no shape")]
    PlanarShape(#[from] recon::observer::planar::PlanarEstimateError),
    #[error(
        "{path}: has neither forces nor torques of both palms at every sample, or a contact at the hinge, where a torque has no lever: \
         `recon planar` fits a shape to contacts alone"
    )]
    PlanarForces { path: PathBuf },
    #[error("without forces the shape is fitted to noisy contacts: give --contact-noise in m")]
    PlanarNoise,
    #[error("the planar demo cannot be simulated: {0}")]
    PlanarDemo(String),
    #[error(
        "normals are rounded: their lengths are off 1 by up to {off:.1e}, too much for contacts that are taken as exact; state the \
         noise (--normal-noise {off:.0e} or more, --contact-noise), or let it be estimated (--estimate-noise)"
    )]
    RoundedNormals { off: f64 },
    #[error("the contacts give no bounds")]
    Bounds(#[from] BoundsError),
    #[error("the upper bound cannot be cut to a picture")]
    Picture(#[from] IntersectionError),
    #[error("a bound is not a mesh")]
    Mesh(#[from] MeshError),
    #[error("the object cannot be exported")]
    Export(#[from] ExportError),
    #[error(
        "no shape can be fitted to the contacts (for an export, --export-shape inner takes the bound instead)"
    )]
    Fit(#[from] FitError),
    #[error("a mesh cannot be written in this format")]
    MeshFormat(#[source] std::io::Error),
    #[error("the result cannot be written")]
    Output(#[from] OutputError),
    #[error("the results do not hold")]
    Check(#[from] CheckError),
    #[error("the object cannot be explored")]
    Explore(#[from] recon::exploration::ExploreError),
    #[error("the object cannot be rolled")]
    Roll(#[from] recon::exploration::rolling::RollError),
    #[error("the object cannot be rolled")]
    Sensed(#[from] recon::exploration::rolling::SensedError),
    #[error("the finger cannot follow the outline")]
    Finger(#[source] recon::exploration::contour::StuckFinger),
    #[error("the outline cannot be followed")]
    Traced(#[from] recon::exploration::contour::TraceError<recon::exploration::contour::StuckFinger>),
    #[error("the finger cannot come down on the surface")]
    DescendingFinger(#[source] recon::exploration::relief::StuckFinger),
    #[error("the surface cannot be felt")]
    Probed(#[from] recon::exploration::relief::ProbingError<recon::exploration::relief::StuckFinger>),
    #[error("the surface cannot be bounded")]
    ReliefBounds(#[source] recon::exploration::relief::ReliefBoundsError),
    #[error(
        "no finger: give its radius in m by --finger, or as `finger.radius` in {}", path.display()
    )]
    NoFinger { path: PathBuf },
    #[error("the scene has no gravity, and palms do not hold an object without")]
    RolledWithoutGravity,
    #[error(
        "half of the noise is stated: touches take --contact-noise and --normal-noise, palms that turn --contact-noise and --force-noise, parallel ones --contact-noise and --palm-noise"
    )]
    HalfNoise,
    #[error("the object does not lie between the palms")]
    Palms(#[from] recon::exploration::rolling::PalmsError),
    #[error("`{name}` plans nothing for {what}; use {instead}")]
    Planner { name: String, what: &'static str, instead: &'static str },
    #[error("the object cannot be rolled")]
    Parallel(#[from] recon::exploration::parallel::ParallelError),
    #[error("the object does not stay between the palms: give it more --friction")]
    ParallelPalms(#[source] recon::exploration::parallel::ParallelPalmsError),
    #[error(
        "{option} is not of parallel palms: these are flat, so that normals are theirs, and where the object is follows from contacts and palm; use --contact-noise and --palm-noise"
    )]
    NotBetween { option: &'static str },
    #[error(
        "--palm-noise is of parallel palms in space: palms that turn take --contact-noise and --force-noise"
    )]
    NotHinged,
    #[error(
        "--friction is of palms that do not wait: in the plane it takes --contact-noise and --force-noise as well"
    )]
    FrictionAtRest,
    #[error("the confidence cannot be stated")]
    Confidence(#[from] recon::exploration::ConfidenceError),
    #[error("the goal cannot be had: {0}")]
    Goal(String),
    #[error(
        "{} says no goal: give one by --until, as gap=0.1, or a folder of `recon explore`", path.display()
    )]
    NoGoal { path: PathBuf },
    #[error("{} is of a contour or a relief, which is felt in one go: there is no next touch", path.display())]
    Followed { path: PathBuf },
    #[error("{} cannot be read as the summary of an exploration: {what}", path.display())]
    NotExplored { path: PathBuf, what: String },
    #[error("{} holds poses; where to touch next is asked of contacts", path.display())]
    PosesExplored { path: PathBuf },
    #[error("standard output cannot be written")]
    StandardOutput(#[source] std::io::Error),
    #[error("interrupted; nothing is left half-written")]
    Interrupted,
    #[error("interruptions cannot be caught")]
    Signals(#[source] ctrlc::Error),
}

impl CliError {
    /// An option that has no meaning for a scene in the plane.
    pub(crate) fn in_space_alone(option: &'static str, scene: &Path) -> Self {
        let (meant, found) = ("scenes in space", "one in the plane (`plane = true`): leave it out");
        Self::Option { option, meant, found, path: scene.to_owned() }
    }

    /// The code of each kind is told in `recon --help`.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Output(OutputError::Certificate { .. })
            | Self::Picture(_)
            | Self::Facets(_)
            | Self::ResultBag(_)
            | Self::Mesh(_)
            | Self::MeshFormat(_)
            | Self::Signals(_)
            | Self::PlanarDemo(_) => 1,
            Self::Log(_)
            | Self::Bag(_)
            | Self::Mapping(_)
            | Self::NoMapping { .. }
            | Self::Folder { .. }
            | Self::NoLogs { .. }
            | Self::LogNeedsScene
            | Self::NeitherTouches { .. }
            | Self::NoContactsToGoOn { .. }
            | Self::SameName { .. }
            | Self::LogName { .. }
            | Self::BagFollowed { .. }
            | Self::Scene(_)
            | Self::Touches(_)
            | Self::NoisyBounds(_)
            | Self::ContactLog(_)
            | Self::Inertia(_)
            | Self::CorrelatedNoise { .. }
            | Self::RoundedNormals { .. }
            | Self::PoseBounds(_)
            | Self::Curvature(_)
            | Self::PlanarBounds(_)
            | Self::PlanarNoisyBounds(_)
            | Self::PlanarCurvature(_)
            | Self::PlanarFit(_)
            | Self::NoPushLog { .. }
            | Self::Pushes { .. }
            | Self::Alpha(_)
            | Self::Surface(_)
            | Self::Approximation(_)
            | Self::UnknownBody
            | Self::NothingToSimulate { .. }
            | Self::NotThreePlanes { .. }
            | Self::NotThreeAxes { .. }
            | Self::SizeNotStated
            | Self::NormalsTurned { .. }
            | Self::ContactEstimate(_)
            | Self::Shape(_)
            | Self::Dynamics(_)
            | Self::Simulation(_)
            | Self::Contacts(_)
            | Self::PlanarStart(_)
            | Self::PlanarContacts(_)
            | Self::PlanarContactLog(_)
            | Self::ContactNoise(_)
            | Self::Noise(_)
            | Self::NoPalmForce { .. }
            | Self::OddLog { .. }
            | Self::Hopeless { .. }
            | Self::Stream(_)
            | Self::NoPage
            | Self::Page(_)
            | Self::StreamNoise
            | Self::TooFewSamples { .. }
            | Self::WithoutForces(_)
            | Self::NoGravity
            | Self::PlanarEstimate(_)
            | Self::PlanarShape(_)
            | Self::PlanarForces { .. }
            | Self::PlanarNoise
            | Self::Export(_)
            | Self::Explore(_)
            | Self::Roll(_)
            | Self::Sensed(_)
            | Self::Finger(_)
            | Self::Traced(_)
            | Self::DescendingFinger(_)
            | Self::Probed(_)
            | Self::ReliefBounds(_)
            | Self::NoFinger { .. }
            | Self::RolledWithoutGravity
            | Self::HalfNoise
            | Self::Palms(_)
            | Self::Planner { .. }
            | Self::Parallel(_)
            | Self::ParallelPalms(_)
            | Self::NotBetween { .. }
            | Self::NotHinged
            | Self::FrictionAtRest
            | Self::Confidence(_)
            | Self::Goal(_)
            | Self::NoGoal { .. }
            | Self::Followed { .. }
            | Self::NotExplored { .. }
            | Self::PosesExplored { .. }
            | Self::Check(_)
            | Self::Fit(_)
            | Self::Bounds(_) => 3,
            Self::Option { .. } | Self::NoFormat { .. } | Self::MappingOfNoBag { .. } => 2,
            Self::Output(_) | Self::StandardOutput(_) => 5,
            Self::Interrupted => 130,
        }
    }
}
