#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/traffic/passage.hpp"

namespace slammot::traffic {

constexpr double kCellM = 0.5;

/// Travel through one cell in about one direction: sums over the pieces of ways that lie in it.
struct Stream {
  std::uint8_t cell = 0;           ///< Within its block, row by row.
  std::uint32_t passages = 0;      ///< Different tracks.
  std::uint32_t last_passage = 0;  ///< Number of the passage that was added last.
  float length_m = 0.0F;           ///< Travelled here, by all passages.
  float weight = 0.0F;  ///< The same, each piece times the certainty of its state in (0, 1].
  Eigen::Vector2f position_sum_m = Eigen::Vector2f::Zero();  ///< From the block's corner.
  Eigen::Vector2f direction_sum = Eigen::Vector2f::Zero();   ///< Of unit vectors.
  float speed_sum_mps = 0.0F;
  float squared_speed_sum = 0.0F;  ///< [m2/s2]
  float width_sum_m = 0.0F;        ///< Of the objects.

  geometry::Vector2 direction() const { return direction_sum.cast<double>().normalized(); }

  /// Mean resultant length of the directions, in [0, 1]: 1 if all agree (Mardia and Jupp 2000).
  double agreement() const;
  double speed_mps() const;         ///< Mean.
  double speed_spread_mps() const;  ///< Standard deviation.
};

/// A stream without its cell, in the frame of whoever holds it.
struct FreeStream {
  Mover mover = Mover::kVehicle;
  std::uint32_t passages = 0;
  Eigen::Vector2f position_m = Eigen::Vector2f::Zero();  ///< Mean.
  float length_m = 0.0F;                                 ///< This and the sums as in Stream.
  float weight = 0.0F;
  Eigen::Vector2f direction_sum = Eigen::Vector2f::Zero();
  float speed_sum_mps = 0.0F;
  float squared_speed_sum = 0.0F;
  float width_sum_m = 0.0F;
};

/// True if the velocity is beyond what its covariance explains.
bool moves(const MoverState& state);

constexpr double kPieceM = 0.5 * kCellM;  ///< Least distance of states that count.
constexpr double kLeastWayM = 3.0;        ///< From the first state; a shorter one may be an error
                                          ///< of the box.
constexpr double kLongestGapS = 1.0;      ///< Between states that are joined.
constexpr double kFarthestM = 1e6;        ///< From the origin; what is beyond does not count.

/// A stream with its mean position in map.
struct PlacedStream {
  const Stream* stream = nullptr;
  geometry::Vector2 position_m = geometry::Vector2::Zero();
};

/// Where, in which direction and how fast objects moved: the moving-object map of Wang 2004,
/// section 6.3, with velocities. For each kind of mover a grid of cells; a cell holds a stream for
/// each direction in which it was crossed, at most four. Memory is bounded: when the map is full,
/// only cells that have a stream go on counting.
class TrafficMap {
 public:
  explicit TrafficMap(std::size_t most_streams = 500'000) : most_streams_(most_streams) {}

  /// Adds the way of one track. States with an insignificant speed and tracks that went nowhere add
  /// nothing; uncertain states weigh less.
  void add(const Passage& passage);

  /// Adds a part of the way of a track that went somewhere as a whole.
  void add_part(const Passage& part);

  /// Adds streams that another map holds in the frame.
  void add(const std::vector<FreeStream>& streams, const geometry::Pose2& map_from_frame);

  /// Copies of all streams, seen from the frame, in the order of streams().
  std::vector<FreeStream> free_streams(const geometry::Pose2& frame_from_map) const;

  /// Appends the streams of the blocks that touch the square of that half side to `found`.
  void append_near(Mover mover, const geometry::Vector2& centre_m, double half_side_m,
                   std::vector<PlacedStream>& found) const;

  /// All streams, in an order that depends on the place only.
  std::vector<PlacedStream> streams(Mover mover) const;

  std::size_t size() const { return streams_; }
  bool is_full() const { return streams_ >= most_streams_; }

 private:
  /// A square of 4 x 4 cells.
  using Block = std::vector<Stream>;
  struct Piece;

  void add_steps(const Passage& passage, const std::vector<const MoverState*>& states);
  void add_step(const Passage& passage, const MoverState& from, const MoverState& to);
  void add_piece(const Piece& piece);
  Stream* stream_at(Mover mover, const geometry::Vector2& position_m,
                    const geometry::Vector2& direction);

  std::size_t most_streams_;
  std::size_t streams_ = 0;
  std::uint32_t passages_ = 0;
  std::array<std::unordered_map<std::uint64_t, Block>, kMovers> blocks_;
};

}  // namespace slammot::traffic
