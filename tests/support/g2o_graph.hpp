#pragma once

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <zlib.h>
#include <Eigen/LU>

#include "common/flow/graph_correction.hpp"

namespace slammot::testing {

struct G2oGraph {
  std::vector<flow::CorrectedSubmap> nodes;   ///< VERTEX_SE2, in the file's order.
  std::vector<flow::Constraint> constraints;  ///< EDGE_SE2, all odometric; the covariance is the
                                              ///< information inverted.
};

/// Text of a file, plain or gzip; empty when it cannot be read.
inline std::string read_text(const std::filesystem::path& path) {
  std::string text;
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) return text;
  char buffer[1 << 16];
  for (int count = gzread(file, buffer, sizeof buffer); count > 0;
       count = gzread(file, buffer, sizeof buffer)) {
    text.append(buffer, static_cast<std::size_t>(count));
  }
  gzclose(file);
  return text;
}

/// Planar part of a graph in g2o text form; lines of other kinds are passed over.
inline G2oGraph parse_g2o(const std::string& text) {
  G2oGraph graph;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string kind;
    fields >> kind;
    if (kind == "VERTEX_SE2") {
      flow::CorrectedSubmap node;
      geometry::Pose2& pose = node.map_from_submap;
      fields >> node.submap_id.value >> pose.x_m >> pose.y_m >> pose.heading_rad;
      graph.nodes.push_back(node);
    } else if (kind == "EDGE_SE2") {
      flow::Constraint constraint;
      geometry::Pose2& pose = constraint.from_to.pose;
      fields >> constraint.from.value >> constraint.to.value >> pose.x_m >> pose.y_m >>
          pose.heading_rad;
      double i11, i12, i13, i22, i23, i33;
      fields >> i11 >> i12 >> i13 >> i22 >> i23 >> i33;
      const geometry::Matrix3 information{{i11, i12, i13}, {i12, i22, i23}, {i13, i23, i33}};
      constraint.from_to.covariance = information.inverse();
      graph.constraints.push_back(constraint);
    }
  }
  return graph;
}

}  // namespace slammot::testing
