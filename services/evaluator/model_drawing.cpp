#include "services/evaluator/model_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace slammot::evaluator {
namespace {

using Eigen::Vector3d;

constexpr double kTurn_rad = std::numbers::pi / 7.0;       // of the view, about the vertical
constexpr double kElevation_rad = std::numbers::pi / 4.0;  // of the viewer above the horizon
constexpr double kMargin = 12.0;                           // [pixels]
constexpr double kFaceOpacity = 0.9;

/// Right [m], up [m] in the picture, and away from the viewer [m].
Vector3d in_view(const Vector3d& point_m) {
  const Vector3d turned = Eigen::AngleAxisd(kTurn_rad, Vector3d::UnitZ()) * point_m;
  const double sine = std::sin(kElevation_rad);
  const double cosine = std::cos(kElevation_rad);
  return {turned.x(), turned.y() * sine + turned.z() * cosine,
          turned.y() * cosine - turned.z() * sine};
}

Vector3d position_of(const files::PlyVertex& vertex) {
  const auto& [x, y, z] = vertex.position_m;
  return {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
}

/// Brighter where the surface faces the light.
files::Rgb shaded(const files::Rgb& colour, const Vector3d& along) {
  const Vector3d light(std::cos(1.1), std::sin(1.1), 0.0);
  const double length_m = std::max(1e-6, along.head<2>().norm());
  const double facing = std::abs(along.x() * light.y() - along.y() * light.x()) / length_m;
  files::Rgb result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = static_cast<std::uint8_t>(std::lround(colour[i] * (0.45 + 0.55 * facing)));
  return result;
}

struct Face {
  double away_m = 0.0;
  std::array<Vector3d, 4> corners;
  files::Rgb colour = {};
};

/// The farthest first.
std::vector<Face> faces_of(const files::PlyModel& model) {
  std::vector<Face> faces;
  for (const auto& quad : model.quads) {
    Face face;
    std::array<double, 3> colour{};
    for (std::size_t i = 0; i < 4; ++i) {
      face.corners[i] = in_view(position_of(model.vertices[quad[i]]));
      face.away_m += 0.25 * face.corners[i].z();
      for (std::size_t c = 0; c < 3; ++c) colour[c] += 0.25 * model.vertices[quad[i]].colour[c];
    }
    for (std::size_t c = 0; c < 3; ++c) face.colour[c] = static_cast<std::uint8_t>(colour[c]);
    face.colour = shaded(
        face.colour, position_of(model.vertices[quad[1]]) - position_of(model.vertices[quad[0]]));
    faces.push_back(face);
  }
  std::ranges::sort(faces, std::greater{}, &Face::away_m);
  return faces;
}

}  // namespace

Drawing draw_model(const files::PlyModel& model, const metrics::Trajectory& way,
                   const PageTheme& theme, double most_pixels) {
  const std::vector<Face> faces = faces_of(model);
  std::vector<Vector3d> driven;
  for (const metrics::StampedPose& pose : way)
    driven.push_back(in_view({pose.pose.x_m, pose.pose.y_m, 0.0}));
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  const auto include = [&](const Vector3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  };
  std::ranges::for_each(driven, include);
  for (const Face& face : faces) std::ranges::for_each(face.corners, include);
  const Vector3d size_m = driven.empty() && faces.empty() ? Vector3d::Ones() : Vector3d(high - low);
  const double pixels_per_m =
      (most_pixels - 2.0 * kMargin) / std::max({1.0, size_m.x(), size_m.y()});
  const auto place = [&](const Vector3d& point) {
    return PlotPoint{kMargin + pixels_per_m * (point.x() - low.x()),
                     kMargin + pixels_per_m * (high.y() - point.y())};
  };
  Drawing drawing{std::ceil(pixels_per_m * size_m.x() + 2.0 * kMargin),
                  std::ceil(pixels_per_m * size_m.y() + 2.0 * kMargin),
                  theme.at("back"),
                  {}};
  LineMark line{{}, {theme.at("way"), 0.9}, 2.0};
  for (const Vector3d& point : driven) {
    const PlotPoint at = place(point);
    if (line.points.empty() ||
        std::hypot(at.x - line.points.back().x, at.y - line.points.back().y) >= 1.0)
      line.points.push_back(at);
  }
  drawing.marks.emplace_back(std::move(line));
  for (const Face& face : faces) {
    AreaMark area{{}, {face.colour, kFaceOpacity}};
    for (const Vector3d& corner : face.corners) area.points.push_back(place(corner));
    drawing.marks.emplace_back(std::move(area));
  }
  return drawing;
}

}  // namespace slammot::evaluator
