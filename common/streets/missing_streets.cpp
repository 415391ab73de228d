#include "common/streets/missing_streets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

// Negative logarithms of probabilities.
constexpr double kMissing = 2.3;        // a street is missing: one in ten
constexpr double kMissingPer_m = 0.01;  // beyond a block's length,
constexpr double kBlock_m = 100.0;
constexpr double kFifthArm = 2.5;       // it ends where four streets meet,
constexpr double kMidBlock = 1.5;       // or between two junctions,
constexpr double kOtherNode = 1.1;      // and leads to this node, not to another
constexpr std::size_t kGap = 4;         // points beside streets that need no missing street
constexpr double kNodeWithin_m = 30.0;  // of the last point on streets or the first beside them
constexpr double kNodeAcross_m = 8.0;   // of the missing street's line
constexpr std::size_t kDirectionPoints = 6;

/// One sigma of what is known of a missing street before it is driven.
struct LinePrior {
  double place_m = 40.0;  // across
  double turn_rad = 0.3;  // from a right angle, or what else streets make with each other
  double bend_per_m = 0.001;
};
constexpr double kStraightOn_rad = 0.1;
constexpr double kStraightOn_m = 3.0;

/// Pieces beside all streets, one after the other.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
  bool has_before = false;
  bool has_after = false;
};

class Explainer {
 public:
  Explainer(const StreetNetwork& network, const DrivenWay& way, const std::vector<Piece>& pieces,
            const Pose2& streets_from_map)
      : network_(network), way_(way), pieces_(pieces), pose_(streets_from_map) {}

  MissingStreets explained() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].link) {
        if (i > 0 && pieces_[i - 1].link && !are_joined(i - 1, i)) add_street(2.0 * kMidBlock);
        continue;
      }
      Run run{i, i, i > 0, false};
      while (run.last + 1 < pieces_.size() && !pieces_[run.last + 1].link) ++run.last;
      run.has_after = run.last + 1 < pieces_.size();
      if (!is_gap(run)) explain(run);
      i = run.last;
    }
    return result_;
  }

 private:
  void add(double cost) {
    for (double& sum : result_.costs) sum += cost;
  }
  void add_street(double cost_of_its_line) {
    add(kMissing + cost_of_its_line);
    ++result_.count;
  }
  bool are_joined(std::size_t a, std::size_t b) const {
    return network_.are_joined(*pieces_[a].link, *pieces_[b].link);
  }
  bool is_gap(const Run& run) const {
    std::size_t points = 0;
    for (std::size_t i = run.first; i <= run.last; ++i) points += pieces_[i].size();
    return points <= kGap &&
           (!run.has_before || !run.has_after || are_joined(run.first - 1, run.last + 1));
  }

  void explain(const Run& run) {
    const double length_m = DrivenWay::kSpacing_m *
                            static_cast<double>(pieces_[run.last].last - pieces_[run.first].first);
    add_street(kMissingPer_m * std::max(0.0, length_m - kBlock_m));
    std::optional<StreetEnd> begin;
    std::optional<StreetEnd> end;
    if (run.has_before) begin = end_at(pieces_[run.first], true, pieces_[run.first - 1]);
    if (run.has_after) end = end_at(pieces_[run.last], false, pieces_[run.last + 1]);
    for (const auto& one : {begin, end}) {
      if (!one) continue;
      add(cost_of_end(*one));
      if (one->node) result_.ends.push_back(*one);
    }
    for (std::size_t i = run.first; i <= run.last; ++i) {
      const int nodes = (i == run.first && begin && begin->node ? 1 : 0) +
                        (i == run.last && end && end->node ? 1 : 0);
      const bool goes_straight_on =
          (i == run.first && run.has_before && pieces_[i - 1].stretch == pieces_[i].stretch) ||
          (i == run.last && run.has_after && pieces_[i + 1].stretch == pieces_[i].stretch);
      add_line(pieces_[i], prior_of(pieces_[i], nodes, goes_straight_on));
      if (nodes == 2) add(kOtherNode);
    }
  }

  static LinePrior prior_of(const Piece& piece, int nodes, bool goes_straight_on) {
    LinePrior prior;
    if (goes_straight_on) prior.turn_rad = kStraightOn_rad;
    if (goes_straight_on) prior.place_m = kStraightOn_m;
    if (nodes > 0) prior.place_m = kEndSigma_m;
    if (nodes == 2) {
      const double length_m = DrivenWay::kSpacing_m * static_cast<double>(piece.size());
      prior.turn_rad = std::min(prior.turn_rad, 2.0 * kEndSigma_m / length_m);
    }
    return prior;
  }

  double cost_of_end(const StreetEnd& end) const {
    if (!end.node) return kMidBlock;
    return network_.nodes()[*end.node].arms < 4 ? 0.0 : kFifthArm;
  }

  /// End of the missing street of a piece, next to a piece on streets.
  StreetEnd end_at(const Piece& piece, bool is_begin, const Piece& on_streets) const {
    StreetEnd end;
    end.point = is_begin ? piece.first : piece.last;
    const std::size_t steps = std::min(kDirectionPoints, piece.size() - 1);
    const std::size_t other = is_begin ? end.point + steps : end.point - steps;
    const Vector2 at_m = way_.points[end.point].translation_m();
    Vector2 along = is_begin ? Vector2(way_.points[other].translation_m() - at_m)
                             : Vector2(at_m - way_.points[other].translation_m());
    if (steps == 0) {
      const double heading_rad = way_.points[end.point].heading_rad;
      along = {std::cos(heading_rad), std::sin(heading_rad)};
    }
    end.left_in_map = Vector2(-along.y(), along.x()).normalized();
    const Vector2 left = geometry::rotation(pose_.heading_rad) * end.left_in_map;
    const Vector2 last_on_m =
        pose_ * way_.points[is_begin ? on_streets.last : on_streets.first].translation_m();
    double nearest_m = kNodeWithin_m;
    for (const std::size_t node : network_.links()[*on_streets.link].nodes) {
      const Vector2 place_m = network_.nodes()[node].place_m;
      const double away_m = std::min((place_m - last_on_m).norm(), (place_m - pose_ * at_m).norm());
      if (away_m > nearest_m || std::abs(left.dot(place_m - pose_ * at_m)) > kNodeAcross_m)
        continue;
      nearest_m = away_m;
      end.node = node;
    }
    return end;
  }

  /// Adds the negative logarithm of the evidence of a line along the piece, beside that of a known
  /// one.
  void add_line(const Piece& piece, const LinePrior& line) {
    const Vector2 from_m = way_.points[piece.first].translation_m();
    const Vector2 along_m = way_.points[piece.last].translation_m() - from_m;
    const double heading_rad = piece.size() > 1 ? std::atan2(along_m.y(), along_m.x())
                                                : way_.points[piece.first].heading_rad;
    const Vector2 middle_m = from_m + 0.5 * along_m;
    const Pose2 line_from_map = geometry::inverse(Pose2{middle_m.x(), middle_m.y(), heading_rad});
    Eigen::Matrix3d points = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    double squares = 0.0;
    for (std::size_t i = piece.first; i <= piece.last; ++i) {
      const Vector2 at_m = line_from_map * way_.points[i].translation_m();
      const Eigen::Vector3d row{1.0, at_m.x(), 0.5 * at_m.x() * at_m.x()};
      points += row * row.transpose();
      gradient += row * at_m.y();
      squares += at_m.y() * at_m.y();
    }
    const Eigen::Vector3d prior =
        Eigen::Vector3d(line.place_m, line.turn_rad, line.bend_per_m).array().square().inverse();
    for (std::size_t k = 0; k < kAcrossSigmas_m.size(); ++k) {
      const double weight = kPointInformation / (kAcrossSigmas_m[k] * kAcrossSigmas_m[k]);
      Eigen::Matrix3d information = weight * points;
      information.diagonal() += prior;
      const Eigen::LDLT<Eigen::Matrix3d> solved(information);
      const double explained = weight * weight * gradient.dot(solved.solve(gradient));
      result_.costs[k] += 0.5 * (std::max(0.0, weight * squares - explained) +
                                 solved.vectorD().array().log().sum() - prior.array().log().sum());
    }
  }

  const StreetNetwork& network_;
  const DrivenWay& way_;
  const std::vector<Piece>& pieces_;
  Pose2 pose_;
  MissingStreets result_;
};

}  // namespace

MissingStreets missing_streets(const StreetNetwork& network, const DrivenWay& way,
                               const std::vector<Piece>& pieces, const Pose2& streets_from_map) {
  return Explainer(network, way, pieces, streets_from_map).explained();
}

}  // namespace slammot::streets
