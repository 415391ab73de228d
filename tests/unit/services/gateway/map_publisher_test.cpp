#include "services/gateway/map_publisher.hpp"

#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace slammot::gateway {
namespace {

/// What was published, and what is served.
class FakeAudience : public Audience {
 public:
  bool is_wanted(ChannelId channel) const override { return wanted.contains(channel); }
  void publish(ChannelId channel, std::int64_t, std::string payload) override {
    last[channel] = std::move(payload);
  }
  void put(const std::string& path, Content content) override { served[path] = std::move(content); }
  void remove(const std::string& path) override { served.erase(path); }

  std::set<std::string> paths_in_graph() const {
    std::set<std::string> paths;
    const auto graph = nlohmann::json::parse(last.at(ChannelId::kGraph));
    for (const auto& submap : graph["submaps"]) paths.insert(submap["path"]);
    return paths;
  }
  std::set<std::string> served_paths() const {
    std::set<std::string> paths;
    for (const auto& [path, content] : served) paths.insert(path);
    return paths;
  }

  std::set<ChannelId> wanted;
  std::map<ChannelId, std::string> last;
  std::map<std::string, Content> served;
};

class PublishedMap : public ::testing::Test {
 protected:
  void take(std::uint32_t submap_id, std::int8_t evidence) {
    flow::Submap submap;
    submap.map_id = {1};
    submap.submap_id = {submap_id};
    submap.cell_size_m = 0.5;
    submap.columns = submap.rows = 4;
    submap.so_log_odds.assign(16, evidence);
    submap.mo_evidence.assign(16, 0);
    wire::SubmapEncoder().encode("car", submap, [this](const slammot_SubmapTile& tile) {
      EXPECT_EQ(publisher_.take(tile), "");
    });
  }
  void publish_all() {
    publisher_.finish();
    publisher_.publish({});
  }

  FakeAudience audience_;
  MapPublisher publisher_{audience_};
};

TEST_F(PublishedMap, ServesEachSubmapOfItsGraphInItsLastVersion) {
  take(1, 20);
  take(2, 20);
  publish_all();
  const std::set<std::string> first = audience_.served_paths();
  EXPECT_EQ(first.size(), 2U);
  EXPECT_EQ(audience_.paths_in_graph(), first);
  take(2, 40);
  publish_all();
  EXPECT_EQ(audience_.served.size(), 2U);
  EXPECT_EQ(audience_.paths_in_graph(), audience_.served_paths());
  EXPECT_NE(audience_.served_paths(), first);
}

TEST_F(PublishedMap, ServesWhatArrivesWhileOthersAreCompressed) {
  take(1, 20);
  publisher_.publish({});  // begins
  take(2, 20);
  publisher_.finish();
  publisher_.publish({});
  EXPECT_EQ(audience_.served.size(), 2U);
  EXPECT_EQ(audience_.paths_in_graph().size(), 2U);
}

TEST_F(PublishedMap, IsDrawnOnlyForThoseWhoWantIt) {
  take(1, 20);
  publish_all();
  publish_all();
  EXPECT_FALSE(audience_.last.contains(ChannelId::kStationaryMap));
  audience_.wanted = {ChannelId::kStationaryMap};
  publisher_.publish({});  // begins to draw the map of before
  publish_all();
  EXPECT_TRUE(audience_.last.contains(ChannelId::kStationaryMap));
}

}  // namespace
}  // namespace slammot::gateway
