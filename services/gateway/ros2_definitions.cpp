#include "services/gateway/ros2_definitions.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace slammot::gateway {
namespace {

struct Definition {
  std::string_view type;
  std::string_view fields;
  std::vector<std::string_view> parts;
};

const std::vector<Definition>& definitions() {
  static const std::vector<Definition> all = {
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n", {}},
      {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n", {}},
      {"std_msgs/Header",
       "builtin_interfaces/Time stamp\nstring frame_id\n",
       {"builtin_interfaces/Time"}},
      {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n", {}},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n", {}},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n", {}},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n", {}},
      {"geometry_msgs/Pose",
       "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n",
       {"geometry_msgs/Point", "geometry_msgs/Quaternion"}},
      {"geometry_msgs/PoseStamped",
       "std_msgs/Header header\ngeometry_msgs/Pose pose\n",
       {"std_msgs/Header", "geometry_msgs/Pose"}},
      {"geometry_msgs/PoseWithCovariance",
       "geometry_msgs/Pose pose\nfloat64[36] covariance\n",
       {"geometry_msgs/Pose"}},
      {"geometry_msgs/Twist",
       "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n",
       {"geometry_msgs/Vector3"}},
      {"geometry_msgs/TwistWithCovariance",
       "geometry_msgs/Twist twist\nfloat64[36] covariance\n",
       {"geometry_msgs/Twist"}},
      {"geometry_msgs/Transform",
       "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
       {"geometry_msgs/Vector3", "geometry_msgs/Quaternion"}},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
       {"std_msgs/Header", "geometry_msgs/Transform"}},
      {"tf2_msgs/TFMessage",
       "geometry_msgs/TransformStamped[] transforms\n",
       {"geometry_msgs/TransformStamped"}},
      {"sensor_msgs/LaserScan",
       "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
       "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
       "float32[] ranges\nfloat32[] intensities\n",
       {"std_msgs/Header"}},
      {"sensor_msgs/PointField",
       "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\n"
       "uint8 UINT32=6\nuint8 FLOAT32=7\nuint8 FLOAT64=8\n"
       "string name\nuint32 offset\nuint8 datatype\nuint32 count\n",
       {}},
      {"sensor_msgs/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
       "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
       {"std_msgs/Header", "sensor_msgs/PointField"}},
      {"sensor_msgs/NavSatStatus",
       "int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\n"
       "uint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\n"
       "uint16 SERVICE_GALILEO=8\nint8 status\nuint16 service\n",
       {}},
      {"sensor_msgs/NavSatFix",
       "uint8 COVARIANCE_TYPE_UNKNOWN=0\nuint8 COVARIANCE_TYPE_APPROXIMATED=1\n"
       "uint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\nuint8 COVARIANCE_TYPE_KNOWN=3\n"
       "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n"
       "float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n"
       "uint8 position_covariance_type\n",
       {"std_msgs/Header", "sensor_msgs/NavSatStatus"}},
      {"sensor_msgs/CompressedImage",
       "std_msgs/Header header\nstring format\nuint8[] data\n",
       {"std_msgs/Header"}},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n",
       {"std_msgs/Header", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/TwistWithCovariance"}},
      {"nav_msgs/Path",
       "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
       {"std_msgs/Header", "geometry_msgs/PoseStamped"}},
      {"nav_msgs/MapMetaData",
       "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
       "geometry_msgs/Pose origin\n",
       {"builtin_interfaces/Time", "geometry_msgs/Pose"}},
      {"nav_msgs/OccupancyGrid",
       "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n",
       {"std_msgs/Header", "nav_msgs/MapMetaData"}},
      {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n", {}},
      {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n", {}},
      {"visualization_msgs/Marker",
       "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
       "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
       "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
       "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
       "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
       "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
       "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
       "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
       "sensor_msgs/CompressedImage texture\n"
       "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\n"
       "visualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n",
       {"std_msgs/Header", "geometry_msgs/Pose", "geometry_msgs/Vector3", "std_msgs/ColorRGBA",
        "builtin_interfaces/Duration", "geometry_msgs/Point", "sensor_msgs/CompressedImage",
        "visualization_msgs/UVCoordinate", "visualization_msgs/MeshFile"}},
      {"visualization_msgs/MarkerArray",
       "visualization_msgs/Marker[] markers\n",
       {"visualization_msgs/Marker"}},
  };
  return all;
}

const Definition& definition_of(std::string_view type) {
  const auto found = std::ranges::find(definitions(), type, &Definition::type);
  assert(found != definitions().end());
  return *found;
}

/// All that the type is made of, each once, the nearer ones first.
void add_parts(const Definition& whole, std::vector<const Definition*>& parts) {
  for (const std::string_view type : whole.parts) {
    const Definition& part = definition_of(type);
    if (std::ranges::find(parts, &part) == parts.end()) parts.push_back(&part);
  }
}

}  // namespace

std::string ros2_definition(std::string_view type) {
  std::string name(type);
  if (const std::size_t at = name.find("/msg/"); at != std::string::npos) name.erase(at, 4);
  const Definition& whole = definition_of(name);
  std::vector<const Definition*> parts;
  add_parts(whole, parts);
  for (std::size_t i = 0; i < parts.size(); ++i) add_parts(*parts[i], parts);
  std::string text(whole.fields);
  for (const Definition* part : parts) {
    text.append(80, '=');
    text += "\nMSG: ";
    text += part->type;
    text += '\n';
    text += part->fields;
  }
  return text;
}

}  // namespace slammot::gateway
