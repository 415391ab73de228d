#include "services/inspector/graph_text.hpp"

#include <gtest/gtest.h>

namespace slammot::inspector {
namespace {

const std::set<Link> kLinks = {
    {"slammot-ingest", "slammot-localization", "slammot/laser_scan", true},
    {"slammot-ingest", "slammot-localization", "slammot/odometry", true},
    {"slammot-ingest", "viewer \"x\"", "slammot/odometry", false}};

TEST(GraphText, HasALineForEachPairOfProcesses) {
  EXPECT_EQ(graph_text(kLinks),
            "slammot-ingest -> slammot-localization: laser_scan, odometry\n"
            "slammot-ingest -> viewer \"x\": odometry (NOT CONNECTED)\n");
}

TEST(GraphDot, IsForGraphviz) {
  EXPECT_EQ(graph_dot(kLinks),
            "digraph bus {\n  rankdir=LR;\n  node [shape=box, fontname=sans];\n"
            "  edge [fontname=sans, fontsize=9];\n"
            "  \"slammot-ingest\" -> \"slammot-localization\" [label=\"laser_scan\\nodometry\"];\n"
            "  \"slammot-ingest\" -> \"viewer \\\"x\\\"\" [label=\"odometry (NOT CONNECTED)\", "
            "color=red];\n}\n");
}

}  // namespace
}  // namespace slammot::inspector
