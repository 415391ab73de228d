#include "services/recorder/kept_samples.hpp"

#include <gtest/gtest.h>

#include "tests/support/mcap_example.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::recorder {
namespace {

/// Instances are told apart by the first byte, of which the examples have seven.
bool first_byte(mcap::ChannelId, mcap::Bytes cdr, std::vector<std::uint8_t>& key) {
  key.assign(cdr.begin(), cdr.begin() + 1);
  return true;
}

class KeptSamplesOf : public ::testing::Test {
 protected:
  KeptSamplesOf() {
    testing::write_example(path_, messages_, mcap::Compression::kZstd);
    file_ = std::make_unique<mcap::File>(std::move(*mcap::File::open(path_)));
  }

  /// {first byte: source time} as the messages say.
  std::map<std::uint8_t, std::int64_t> expected(std::int64_t log_time_ns) const {
    std::map<std::uint8_t, std::int64_t> last;
    for (const testing::ExampleMessage& message : messages_) {
      if (message.topic == "scans" && message.log_time_ns <= log_time_ns)
        last[message.data[0]] = message.publish_time_ns;
    }
    return last;
  }

  static std::map<std::uint8_t, std::int64_t> visited(KeptSamples& samples,
                                                      std::int64_t log_time_ns) {
    std::map<std::uint8_t, std::int64_t> last;
    samples.visit(log_time_ns, [&](mcap::ChannelId, const KeptSample& sample) {
      EXPECT_TRUE(last.emplace(sample.cdr[0], sample.source_ns).second) << "twice";
    });
    return last;
  }

  void expect_all_times_from(KeptSamples& samples) const {
    for (const int index : {280, 0, 3, 150, 299, 42}) {
      const std::int64_t time_ns = messages_[static_cast<std::size_t>(index)].log_time_ns;
      EXPECT_EQ(visited(samples, time_ns), expected(time_ns)) << index;
    }
    EXPECT_TRUE(visited(samples, messages_.front().log_time_ns - 1).empty());
    EXPECT_EQ(visited(samples, messages_.back().log_time_ns + 1'000'000'000'000).size(), 7U);
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "drive.mcap";
  std::vector<testing::ExampleMessage> messages_ = testing::example_messages(300);
  std::unique_ptr<mcap::File> file_;
};

TEST_F(KeptSamplesOf, ARecordingAreTheLastOfEachInstanceAtAnyTime) {
  KeptSamples samples(*file_, {"scans"}, first_byte);
  expect_all_times_from(samples);
}

TEST_F(KeptSamplesOf, ARecordingThatDoesNotFitIntoMemoryAreTheSame) {
  KeptSamples few(*file_, {"scans"}, first_byte, 50'000);
  expect_all_times_from(few);
  KeptSamples none(*file_, {"scans"}, first_byte, 0);
  expect_all_times_from(none);
}

TEST_F(KeptSamplesOf, NoTopicAreNone) {
  KeptSamples samples(*file_, {}, first_byte);
  EXPECT_TRUE(visited(samples, messages_.back().log_time_ns).empty());
}

TEST_F(KeptSamplesOf, SamplesWithoutKeyAreLeftOut) {
  KeptSamples samples(
      *file_, {"scans"},
      [](mcap::ChannelId, mcap::Bytes, std::vector<std::uint8_t>&) { return false; });
  EXPECT_TRUE(visited(samples, messages_.back().log_time_ns).empty());
}

TEST_F(KeptSamplesOf, ARecordingMayBeClosedWhileTheyAreRead) {
  for (int i = 0; i < 20; ++i) KeptSamples(*file_, {"scans"}, first_byte);
}

}  // namespace
}  // namespace slammot::recorder
