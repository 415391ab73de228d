#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/submap.hpp"
#include "services/loop_closing/loop_closer.hpp"

namespace slammot::loop_closing {

/// Detects revisits among the stored submaps of one vehicle. Rebuilds its graph from them at start.
class LoopClosingService {
 public:
  struct Settings {
    LoopClosingConfig config;
  };
  static constexpr const char* kName = "loop_closing";
  static constexpr const char* kPurpose =
      "Detects revisited places and corrects the poses of all submaps.";
  static constexpr bool kGivesWay = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  LoopClosingService(app::ServiceContext& context, const Settings& settings);

 private:
  void take(const slammot_SubmapTile& tile);
  void begin_map(flow::MapId map_id);
  void add_waiting();
  void add(const flow::Submap& submap);
  void report_connection(flow::SubmapId newest, bool was_connected);
  void publish(flow::GraphCorrection correction);
  void publish_new_constraints();
  void finish_when_idle();

  app::ServiceContext& context_;
  LoopClosingConfig config_;
  LoopCloser closer_;
  wire::SubmapAssembler assembler_;
  wire::GraphCorrectionEncoder correction_encoder_;
  dds::Writer<slammot_Constraint>& constraints_;
  dds::Writer<slammot_GraphCorrection>& corrections_;
  std::map<flow::SubmapId, flow::Submap> waiting_;  ///< Submaps whose predecessors are missing.
  std::optional<flow::MapId> map_id_;               ///< Empty before the first submap.
  std::size_t added_ = 0;  ///< Submaps in the graph; their ids are smaller than this.
  int reports_since_submap_ = 0;
  std::map<std::tuple<flow::SubmapId, flow::SubmapId, flow::ConstraintKind>, flow::ClosureState>
      published_states_;
};

}  // namespace slammot::loop_closing
