#pragma once

#include "common/config/fields.hpp"

namespace slammot::config {

/// Stands for a stage's configuration. It goes by the name of a stage whose message has fields of these names and types.
struct ExampleConfig {
  int window_scans = 1;
  double resend_after_s = 1.0;
  struct {
    double wait_for_readers_s = 10.0;
  } inner;
};

inline const FieldTable<ExampleConfig>& example_fields() {
  static const FieldTable<ExampleConfig> table = {
      {"window_scans", &ExampleConfig::window_scans, "Scans in flight.", Range{1, 100}},
      {"resend_after_s", &ExampleConfig::resend_after_s, "Silence.", kPositive},
      {"wait_for_readers_s", [](ExampleConfig& c) -> double& { return c.inner.wait_for_readers_s; }, "Patience.",
            kNotNegative},
  };
  return table;
}

inline BoundStage bind_example(ExampleConfig& config) { return bind_stage("ingest", example_fields(), config); }

}  // namespace slammot::config
