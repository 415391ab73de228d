#include "common/metrics/matching.hpp"

#include "common/association/assignment.hpp"

namespace slammot::metrics {

std::size_t MotSequence::object_rows() const {
  std::size_t rows = 0;
  for (const MotFrame& frame : frames) rows += frame.objects.size();
  return rows;
}

std::size_t MotSequence::track_rows() const {
  std::size_t rows = 0;
  for (const MotFrame& frame : frames) rows += frame.tracks.size();
  return rows;
}

std::vector<Match> best_pairs(const Eigen::MatrixXd& score) {
  const auto rows = static_cast<std::size_t>(score.rows());
  const auto columns = static_cast<std::size_t>(score.cols());
  association::CostMatrix costs(rows, columns, association::kForbidden);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const double value = score(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
      if (value > 0.0) costs(row, column) = -value;
    }
  }
  const std::vector<std::size_t> column_of_row = association::assign(costs, 0.0);
  std::vector<Match> pairs;
  for (std::size_t row = 0; row < rows; ++row) {
    if (column_of_row[row] != association::kUnassigned) pairs.push_back({row, column_of_row[row]});
  }
  return pairs;
}

}  // namespace slammot::metrics
