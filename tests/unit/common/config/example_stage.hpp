#pragma once

#include "common/config/fields.hpp"

namespace slammot::config {

struct ExampleInnerConfig {
  double x_m = 10.0;
};

/// Stands for a stage's configuration; message Example in slammot.proto is there for it.
struct ExampleConfig {
  int window_scans = 1;
  double resend_after_s = 1.0;
  bool loops = false;
  std::string name = "front";
  ExampleInnerConfig offset;
};

inline FieldTable<ExampleConfig> example_fields() {
  using C = ExampleConfig;
  const FieldTable<ExampleInnerConfig> inner = in_group<ExampleInnerConfig>(
      Group::sensor, {{"x_m", &ExampleInnerConfig::x_m, "Ahead.", kNotNegative}});
  FieldTable<C> own = {
      {"window_scans", &C::window_scans, "Scans in flight.", Range{1, 100}},
      {"resend_after_s", &C::resend_after_s, "Silence.", kPositive, {"Sent twice.", "Late."}},
      {"loops", &C::loops, "Again and again."},
      {"name", &C::name, "Of the scanner."}};
  own[1].group = Group::operation;
  return with_nested<C>(std::move(own), "offset", &C::offset, inner);
}

inline BoundStage bind_example(ExampleConfig& config) {
  return bind_stage("example", example_fields(), config);
}

}  // namespace slammot::config
