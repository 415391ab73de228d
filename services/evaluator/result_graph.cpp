#include "services/evaluator/result_graph.hpp"

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace slammot::evaluator {
namespace {

void take_vertex(std::istringstream& fields, ResultGraph& graph) {
  std::uint64_t id = 0;
  geometry::Pose2 pose;
  if (fields >> id >> pose.x_m >> pose.y_m >> pose.heading_rad && std::isfinite(pose.x_m) &&
      std::isfinite(pose.y_m) && std::isfinite(pose.heading_rad))
    graph.map_from_submap[id] = pose;
}

/// "# closure FROM TO STATE pose ... reason REASON"
void take_closure(std::istringstream& fields, const std::string& line, ResultGraph& graph) {
  constexpr std::string_view kReason = " reason ";
  GraphEdge edge;
  if (!(fields >> edge.from >> edge.to >> edge.state)) return;
  const std::size_t at = line.find(kReason);
  if (at != std::string::npos) edge.reason = line.substr(at + kReason.size());
  edge.is_loop = true;
  graph.edges.push_back(std::move(edge));
}

}  // namespace

ResultGraph read_graph(const std::filesystem::path& g2o) {
  ResultGraph graph;
  std::set<std::pair<std::uint64_t, std::uint64_t>> closures;
  std::ifstream file(g2o);
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string kind, word;
    fields >> kind;
    if (kind == "VERTEX_SE2") take_vertex(fields, graph);
    if (kind == "#" && fields >> word && word == "closure") {
      take_closure(fields, line, graph);
      if (!graph.edges.empty()) closures.emplace(graph.edges.back().from, graph.edges.back().to);
    }
    GraphEdge edge;
    if (kind == "EDGE_SE2" && fields >> edge.from >> edge.to &&
        !closures.contains({edge.from, edge.to}))
      graph.edges.push_back(edge);
  }
  std::erase_if(graph.edges, [&](const GraphEdge& edge) {
    return !graph.map_from_submap.contains(edge.from) || !graph.map_from_submap.contains(edge.to);
  });
  return graph;
}

}  // namespace slammot::evaluator
