#include "common/traffic/traffic_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include "common/traffic/squares.hpp"

namespace slammot::traffic {
namespace {

using geometry::Matrix2;
using geometry::Vector2;

constexpr int kCellsAside = 4;  // of a block
constexpr double kBlockM = kCellsAside * kCellM;
constexpr int kMostDirections = 4;  // of a cell: two crossing ways, both ways each
constexpr double kSameDirection = std::numbers::sqrt2 / 2.0;  // cosine of 45 degrees

constexpr double kLeastSpeedMps = 0.5;
constexpr double kSignificant = 9.21;    // 99 % quantile of chi-square with two degrees of freedom
constexpr double kHalfCertainM2 = 0.25;  // variance of the position that halves the weight

Vector2 corner_of(std::uint64_t key) {
  const auto column = static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> 32U));
  const auto row = static_cast<std::int32_t>(static_cast<std::uint32_t>(key));
  return {column * kBlockM, row * kBlockM};
}

std::uint8_t cell_at(const Vector2& in_block_m) {
  const auto index = [](double coordinate_m) {
    return std::clamp(static_cast<int>(coordinate_m / kCellM), 0, kCellsAside - 1);
  };
  return static_cast<std::uint8_t>(kCellsAside * index(in_block_m.y()) + index(in_block_m.x()));
}

double certainty_of(const MoverState& state) {
  const double variance_m2 = 0.5 * state.covariance.topLeftCorner<2, 2>().trace();
  return kHalfCertainM2 / (kHalfCertainM2 + std::max(0.0, variance_m2));
}

/// States that move, no two nearer than a piece, so that the scatter from scan to scan does not
/// count as way.
std::vector<const MoverState*> thinned(const Passage& passage) {
  std::vector<const MoverState*> kept;
  for (const MoverState& state : passage.states) {
    if (!moves(state)) continue;
    if (kept.empty() ||
        (state.position_in_map_m - kept.back()->position_in_map_m).norm() >= kPieceM)
      kept.push_back(&state);
  }
  return kept;
}

bool went_somewhere(const std::vector<const MoverState*>& states) {
  return std::ranges::any_of(states, [&](const MoverState* state) {
    return (state->position_in_map_m - states.front()->position_in_map_m).norm() >= kLeastWayM;
  });
}

PlacedStream placed(const Stream& stream, std::uint64_t key) {
  return {&stream, corner_of(key) + (stream.position_sum_m / stream.weight).cast<double>()};
}

}  // namespace

struct TrafficMap::Piece {
  Mover mover = Mover::kVehicle;
  Vector2 position_m = Vector2::Zero();
  Vector2 direction = Vector2::Zero();
  double length_m = 0.0;
  double certainty = 0.0;
  double speed_mps = 0.0;
  double width_m = 0.0;
};

bool moves(const MoverState& state) {
  const Vector2& velocity_mps = state.velocity_in_map_mps;
  if (velocity_mps.norm() < kLeastSpeedMps) return false;
  const Matrix2 covariance =
      state.covariance.bottomRightCorner<2, 2>() + 1e-9 * Matrix2::Identity();
  return velocity_mps.dot(covariance.ldlt().solve(velocity_mps)) > kSignificant;
}

double Stream::agreement() const {
  return std::min(1.0, static_cast<double>(direction_sum.norm() / weight));
}

double Stream::speed_mps() const { return static_cast<double>(speed_sum_mps / weight); }

double Stream::speed_spread_mps() const {
  const double mean_mps = speed_mps();
  return std::sqrt(
      std::max(0.0, static_cast<double>(squared_speed_sum / weight) - mean_mps * mean_mps));
}

void TrafficMap::add(const Passage& passage) {
  const std::vector<const MoverState*> states = thinned(passage);
  if (went_somewhere(states)) add_steps(passage, states);
}

void TrafficMap::add_part(const Passage& part) { add_steps(part, thinned(part)); }

void TrafficMap::add_steps(const Passage& passage, const std::vector<const MoverState*>& states) {
  ++passages_;
  for (std::size_t i = 1; i < states.size(); ++i) add_step(passage, *states[i - 1], *states[i]);
}

void TrafficMap::add_step(const Passage& passage, const MoverState& from, const MoverState& to) {
  const Vector2 step_m = to.position_in_map_m - from.position_in_map_m;
  const Vector2 velocity_mps = 0.5 * (from.velocity_in_map_mps + to.velocity_in_map_mps);
  const double speed_mps = velocity_mps.norm();
  const double gap_s = static_cast<double>(to.stamp_ns - from.stamp_ns) * 1e-9;
  if (gap_s > kLongestGapS || speed_mps < kLeastSpeedMps) return;
  const Vector2 direction = velocity_mps / speed_mps;
  // A step across the velocity is a correction of the box, not a way.
  if (step_m.dot(direction) < kSameDirection * step_m.norm()) return;
  const double length_m = step_m.dot(direction);
  const int pieces = static_cast<int>(std::ceil(step_m.norm() / kPieceM));
  const double certainty = std::min(certainty_of(from), certainty_of(to));
  for (int i = 0; i < pieces; ++i)
    add_piece({passage.mover, from.position_in_map_m + (i + 0.5) / pieces * step_m, direction,
               length_m / pieces, certainty, speed_mps, passage.width_m});
}

/// The stream of the cell that agrees in direction; a new one if there is none and room for it,
/// else the most similar one. Null if the map is full.
Stream* TrafficMap::stream_at(Mover mover, const Vector2& position_m, const Vector2& direction) {
  const std::uint64_t key = square_key(position_m, kBlockM);
  auto& blocks = blocks_[static_cast<std::size_t>(mover)];
  if (is_full() && !blocks.contains(key)) return nullptr;
  Block& block = blocks[key];
  const std::uint8_t cell = cell_at(position_m - corner_of(key));
  Stream* nearest = nullptr;
  double nearest_cosine = -2.0;
  int directions = 0;
  for (Stream& stream : block) {
    if (stream.cell != cell) continue;
    ++directions;
    const double cosine = stream.direction().dot(direction);
    if (cosine > nearest_cosine) nearest = &stream, nearest_cosine = cosine;
  }
  if (nearest_cosine < kSameDirection && directions < kMostDirections) {
    if (is_full()) return nullptr;
    ++streams_;
    nearest = &block.emplace_back();
    nearest->cell = cell;
  }
  return nearest;
}

void TrafficMap::add_piece(const Piece& piece) {
  Stream* const stream = stream_at(piece.mover, piece.position_m, piece.direction);
  if (stream == nullptr) return;
  const Vector2 in_block_m = piece.position_m - corner_of(square_key(piece.position_m, kBlockM));
  const auto weight = static_cast<float>(piece.length_m * piece.certainty);
  const auto speed_mps = static_cast<float>(piece.speed_mps);
  if (stream->last_passage != passages_) ++stream->passages;
  stream->last_passage = passages_;
  stream->length_m += static_cast<float>(piece.length_m);
  stream->weight += weight;
  stream->position_sum_m += weight * in_block_m.cast<float>();
  stream->direction_sum += weight * piece.direction.cast<float>();
  stream->speed_sum_mps += weight * speed_mps;
  stream->squared_speed_sum += weight * speed_mps * speed_mps;
  stream->width_sum_m += weight * static_cast<float>(piece.width_m);
}

void TrafficMap::add(const std::vector<FreeStream>& streams,
                     const geometry::Pose2& map_from_frame) {
  const geometry::Matrix2 turn = geometry::rotation(map_from_frame.heading_rad);
  for (const FreeStream& free : streams) {
    const Vector2 position_m = map_from_frame * Vector2(free.position_m.cast<double>());
    const Vector2 direction_sum = turn * free.direction_sum.cast<double>();
    if (!(position_m.cwiseAbs().maxCoeff() < kFarthestM)) continue;
    Stream* const stream = stream_at(free.mover, position_m, direction_sum.normalized());
    if (stream == nullptr) continue;
    const Vector2 in_block_m = position_m - corner_of(square_key(position_m, kBlockM));
    stream->passages += free.passages;
    stream->length_m += free.length_m;
    stream->weight += free.weight;
    stream->position_sum_m += free.weight * in_block_m.cast<float>();
    stream->direction_sum += direction_sum.cast<float>();
    stream->speed_sum_mps += free.speed_sum_mps;
    stream->squared_speed_sum += free.squared_speed_sum;
    stream->width_sum_m += free.width_sum_m;
  }
}

std::vector<FreeStream> TrafficMap::free_streams(const geometry::Pose2& frame_from_map) const {
  const geometry::Matrix2 turn = geometry::rotation(frame_from_map.heading_rad);
  std::vector<FreeStream> all;
  all.reserve(streams_);
  for (const Mover mover : {Mover::kVehicle, Mover::kBicycle, Mover::kPedestrian}) {
    for (const PlacedStream& placed : streams(mover)) {
      const Stream& stream = *placed.stream;
      all.push_back({mover, stream.passages,
                     (frame_from_map * placed.position_m).cast<float>().eval(), stream.length_m,
                     stream.weight, (turn * stream.direction_sum.cast<double>()).cast<float>(),
                     stream.speed_sum_mps, stream.squared_speed_sum, stream.width_sum_m});
    }
  }
  return all;
}

void TrafficMap::append_near(Mover mover, const Vector2& centre_m, double half_side_m,
                             std::vector<PlacedStream>& found) const {
  const auto& blocks = blocks_[static_cast<std::size_t>(mover)];
  any_square_near(centre_m, half_side_m, kBlockM, [&](std::uint64_t key) {
    const auto known = blocks.find(key);
    if (known == blocks.end()) return false;
    for (const Stream& stream : known->second) found.push_back(placed(stream, known->first));
    return false;
  });
}

std::vector<PlacedStream> TrafficMap::streams(Mover mover) const {
  std::vector<PlacedStream> all;
  for (const auto& [key, block] : blocks_[static_cast<std::size_t>(mover)]) {
    for (const Stream& stream : block) all.push_back(placed(stream, key));
  }
  const auto place_of = [](const PlacedStream& stream) {
    return std::pair(stream.position_m.x(), stream.position_m.y());
  };
  std::ranges::sort(all, {}, place_of);
  return all;
}

}  // namespace slammot::traffic
