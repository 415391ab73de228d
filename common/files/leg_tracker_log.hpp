#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "common/files/line_reader.hpp"
#include "common/files/line_source.hpp"
#include "common/files/result.hpp"

namespace slammot::files {

/// A recording of the leg_tracker data set (Leigh et al. 2015) as text, told in lines of CARMEN:
/// scan.txt ("bag stamp, header stamp, first beam and step [rad], beams, ranges [m]" a line)
/// becomes ROBOTLASER1, odom.txt beside it ("stamp x y heading speed yaw_rate"), if there is one,
/// becomes ODOM; each plain or .gz, # begins a comment. Stamps are those of the bag, which the
/// annotations have; by how much odometry comes late by them is for localization to find out. Where
/// the laser is on the base is not said.
class LegTrackerLog : public LineSource {
 public:
  /// A folder with scan.txt, or a single file in scan.txt's format.
  static Result<std::unique_ptr<LineSource>> open(const std::filesystem::path& path);

  /// True if the first line that is no comment has scan.txt's format.
  static bool is_scan_file(const std::filesystem::path& path);

  std::optional<std::string_view> next() override;
  /// Of scan.txt.
  std::uint64_t line_number() const override { return scans_.line_number(); }
  double fraction_read() const override { return scans_.fraction_read(); }
  std::uint64_t overlong_lines() const override {
    return scans_.overlong_lines() + (odometry_ ? odometry_->overlong_lines() : 0);
  }
  bool is_cut() const override { return scans_.is_cut() || (odometry_ && odometry_->is_cut()); }

 private:
  struct Line {
    double stamp_s = 0.0;
    std::string text;  ///< As a CARMEN line.
  };
  LegTrackerLog(LineReader scans, std::optional<LineReader> odometry)
      : scans_(std::move(scans)), odometry_(std::move(odometry)) {}

  std::optional<Line> next_scan();
  std::optional<Line> next_odometry();

  LineReader scans_;
  std::optional<LineReader> odometry_;
  std::optional<Line> scan_;  ///< Next line of each file, read in advance.
  std::optional<Line> odom_;
  std::string line_;
};

}  // namespace slammot::files
