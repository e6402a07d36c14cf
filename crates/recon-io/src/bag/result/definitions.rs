//! Definitions of the messages that are written. Fields are those of ROS 2 (`ros2/common_interfaces` and `ros2/rcl_interfaces`, Apache-2.0;
//! `ros2/geometry2`, BSD-3-Clause), since Humble; the words are our own.

/// A message that is written, with all that its definition refers to.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Definition {
    TFMessage,
    PoseWithCovarianceStamped,
    MarkerArray,
    PointCloud2,
    Contact,
}

const HEADER: &str = "builtin_interfaces/Time stamp\nstring frame_id\n";
const TIME: &str = "int32 sec\nuint32 nanosec\n";
const VECTOR3: &str = "float64 x\nfloat64 y\nfloat64 z\n";
const QUATERNION: &str = "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n";
const POSE: &str = "Point position\nQuaternion orientation\n";
const MARKER: &str = "\
int32 ARROW=0
int32 SPHERE=2
int32 TRIANGLE_LIST=11
int32 ADD=0
int32 DELETE=2
std_msgs/Header header
string ns
int32 id
int32 type
int32 action
geometry_msgs/Pose pose
geometry_msgs/Vector3 scale
std_msgs/ColorRGBA color
builtin_interfaces/Duration lifetime
bool frame_locked
geometry_msgs/Point[] points
std_msgs/ColorRGBA[] colors
string texture_resource
sensor_msgs/CompressedImage texture
UVCoordinate[] uv_coordinates
string text
string mesh_resource
MeshFile mesh_file
bool mesh_use_embedded_materials
";

impl Definition {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::TFMessage => "tf2_msgs/msg/TFMessage",
            Self::PoseWithCovarianceStamped => "geometry_msgs/msg/PoseWithCovarianceStamped",
            Self::MarkerArray => "visualization_msgs/msg/MarkerArray",
            Self::PointCloud2 => "sensor_msgs/msg/PointCloud2",
            Self::Contact => "recon_msgs/msg/Contact",
        }
    }

    /// The definition, and after it those that it refers to, as `ros2msg` schemas have them.
    pub(super) fn text(self) -> String {
        let (own, others): (&str, &[(&str, &str)]) = match self {
            Self::TFMessage => (
                "geometry_msgs/TransformStamped[] transforms\n",
                &[
                    (
                        "geometry_msgs/TransformStamped",
                        "std_msgs/Header header\nstring child_frame_id\nTransform transform\n",
                    ),
                    ("geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"),
                    ("geometry_msgs/Vector3", VECTOR3),
                    ("geometry_msgs/Quaternion", QUATERNION),
                    ("std_msgs/Header", HEADER),
                    ("builtin_interfaces/Time", TIME),
                ],
            ),
            Self::PoseWithCovarianceStamped => (
                "std_msgs/Header header\nPoseWithCovariance pose\n",
                &[
                    ("geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"),
                    ("geometry_msgs/Pose", POSE),
                    ("geometry_msgs/Point", VECTOR3),
                    ("geometry_msgs/Quaternion", QUATERNION),
                    ("std_msgs/Header", HEADER),
                    ("builtin_interfaces/Time", TIME),
                ],
            ),
            Self::MarkerArray => (
                "Marker[] markers\n",
                &[
                    ("visualization_msgs/Marker", MARKER),
                    ("visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"),
                    ("visualization_msgs/MeshFile", "string filename\nuint8[] data\n"),
                    ("sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"),
                    ("std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"),
                    ("geometry_msgs/Pose", POSE),
                    ("geometry_msgs/Point", VECTOR3),
                    ("geometry_msgs/Vector3", VECTOR3),
                    ("geometry_msgs/Quaternion", QUATERNION),
                    ("std_msgs/Header", HEADER),
                    ("builtin_interfaces/Time", TIME),
                    ("builtin_interfaces/Duration", TIME),
                ],
            ),
            Self::PointCloud2 => (
                "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\nuint32 point_step\n\
                 uint32 row_step\nuint8[] data\nbool is_dense\n",
                &[
                    (
                        "sensor_msgs/PointField",
                        "uint8 FLOAT32=7\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n",
                    ),
                    ("std_msgs/Header", HEADER),
                    ("builtin_interfaces/Time", TIME),
                ],
            ),
            Self::Contact => (
                include_str!("../../../ros/recon_msgs/msg/Contact.msg"),
                &[
                    ("geometry_msgs/Point", VECTOR3),
                    ("geometry_msgs/Vector3", VECTOR3),
                    ("std_msgs/Header", HEADER),
                    ("builtin_interfaces/Time", TIME),
                ],
            ),
        };
        let mut text = own.to_owned();
        for (name, definition) in others {
            text.push_str(&"=".repeat(80));
            text.push_str(&format!("\nMSG: {name}\n{definition}"));
        }
        text
    }
}
