#include <filesystem>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "services/evaluator/evaluation.hpp"
#include "services/evaluator/evaluation_text.hpp"
#include "services/evaluator/report_page.hpp"
#include "services/evaluator/scene_drawing.hpp"
#include "services/evaluator/way_drawing.hpp"
#include "tests/fuzz/mutation.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using slammot::testing::mutated;

const std::vector<std::string_view> kWords = {
    ",",         "\n",    " ",   "nan", "-1",        "0",      "1e9",          "9e9",
    "-9e9",      "1e400", "inf", "x",   "timestamp", "mode_0", "P5 9 9 255\n", "resolution: 0",
    "origin: [", "\r",    "."};

const files::MapImage kImage{4,    3,   0.2,
                             -1.0, 4.0, {0, 205, 254, 254, 205, 0, 0, 0, 254, 254, 205, 205}};

std::map<std::string, std::string> whole_files() {
  return {
      {"online.tum", straight_tum(0.0)},
      {"trajectory.tum", straight_tum(0.0)},
      {"tracks.csv", tracks_csv(0.0, 0.4)},
      {"track_details.csv",
       "timestamp,track_id,var_x,cov_xy,var_y,var_vx,cov_vxy,var_vy,mode_0\n0.000000,7,1,0,1,1,0,1,"
       "0.5\n"},
      {"predictions.csv",
       "timestamp,track_id,after,x,y,var_x,cov_xy,var_y\n0.000000,7,1.0,1,0,1,0,1\n"},
      {"online_covariance.csv",
       "timestamp,x,y,heading,var_x,cov_xy,cov_xh,var_y,cov_yh,var_h\n0.000000,0,0,0,1,0,0,1,0,"
       "1\n1.000000,10,0,0,1,0,0,1,0,1\n"},
      {"lanes.geojson",
       R"({"features":[{"properties":{"kind":"lane","line":0,"speed":8.1,"speed_spread":1,"width":3,"tracks":2,"confidence":0.6},"geometry":{"coordinates":[[0,1],[9,1]]}}]})"},
      {"labels.csv", "timestamp,detection,tracking\n0.000000,sm?-,smm-\n"},
      {"map.pgm", files::to_pgm(kImage)},
      {"map.yaml", files::to_map_server_yaml(kImage, "map.pgm")},
      {"moving.pgm", files::to_pgm(kImage)},
      {"moving.yaml", files::to_map_server_yaml(kImage, "moving.pgm")},
      {"graph.g2o",
       "VERTEX_SE2 1 0 0 0\nVERTEX_SE2 2 5 0 0\n# closure 1 2 accepted pose 5 0 0 chi_square 1 "
       "agreed 0.9 reason firm\nEDGE_SE2 1 2 5 0 0 1 0 0 1 0 1\n"},
      {"report.json",
       R"({"losses": [{"begin_s": 1, "end_s": 2}], "closures": [{"state": "accepted", "reason": "x"}], "input": {"sweep_s": 0.013, "clock": "nominal", "findings": ["late"]}, "measured": {"stage_latency": {"tracking": {"p50_ms": 0.1, "p99_ms": 0.2, "max_ms": 1.0}}}})"},
      {"drive.tum", straight_tum(100.0)},
      {"drive.objects.csv", car_ahead_csv(100.0)},
      {"drive.hits.csv", "timestamp,scanner,hits\n0.0,front,0*2 1*3 -1*1 -2*1\n0.1,front,0*7\n"},
      {"drive.walls.csv", "ax,ay,bx,by,class\n0,1,2,3,0\n"}};
}

/// Whatever is refused is refused with one line; whatever is taken can be compared and shown.
void compare(const std::filesystem::path& folder) {
  const auto truth = read_truth(folder / "drive");
  const auto result = read_result(folder);
  for (const files::Error* error :
       {truth ? nullptr : &truth.error(), result ? nullptr : &result.error()}) {
    if (error) EXPECT_EQ(error->message.find('\n'), std::string::npos) << error->message;
  }
  if (!truth || !result) return;
  const auto evaluation = evaluate(*result, *truth, {}, {});
  if (!evaluation) return;
  EXPECT_FALSE(to_json_text(*evaluation, {}).empty());
  EXPECT_FALSE(to_text(*evaluation, {}).empty());
  ReportSource source{"page", &*result, &*truth, &*evaluation, {}};
  EXPECT_FALSE(to_html(source).empty());
  const GroundView view = whole_view(*result, 64.0);
  const SceneDrawing scene(*result, page_theme("dark"), view.metres_per_pixel);
  Drawing drawing = scene.ground(view);
  scene.add_paths(view, drawing);
  if (result->ways) add_ways(*result->ways, view, page_theme("dark"), drawing);
  scene.add_tracks(view, result->corrected.front().stamp_ns, drawing);
  EXPECT_FALSE(to_pixels(drawing, 1.0).pixels.empty());
}

TEST(EvaluationFilesFuzz, SurviveDamageToAnyFile) {
  std::mt19937 random(5);
  testing::TemporaryFolder folder;
  const auto whole = whole_files();
  for (const auto& [name, text] : whole) write(folder / name, text);
  compare(folder.path());
  for (const auto& [name, text] : whole) {
    for (int i = 0; i < 15; ++i) {
      write(folder / name, mutated(text, kWords, random));
      compare(folder.path());
    }
    write(folder / name, text);
  }
}

TEST(EvaluationFilesFuzz, SurviveNumbersBeyondReason) {
  testing::TemporaryFolder folder;
  for (const auto& [name, text] : whole_files()) write(folder / name, text);
  for (const char* number : {"9e9", "-9e9", "1e-300", "-0"}) {
    const std::string n = number;
    write(folder / "drive.objects.csv",
          "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n0.0," + n + ",car," + n +
              "," + n + "," + n + "," + n + "," + n + "," + n + "," + n + "," + n + "\n");
    write(folder / "drive.walls.csv",
          "ax,ay,bx,by,class\n" + n + "," + n + "," + n + "," + n + ",0\n");
    compare(folder.path());
  }
}

}  // namespace
}  // namespace slammot::evaluator
