#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <cmath>

#include "common/dds/cut_sample.hpp"
#include "common/dds/reader.hpp"
#include "common/dds/writer.hpp"
#include "common/wire/collision_warnings.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/service.hpp"
#include "common/wire/stored_map.hpp"
#include "common/wire/submap.hpp"
#include "common/wire/tracked_objects.hpp"
#include "common/wire/traffic_ways.hpp"
#include "common/wire/truth.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/dds.hpp"

namespace slammot::fuzz {
namespace {

/// The library's own reader of a type's CDR: taken from a sample that went over a bus of its own.
template <typename Sample>
class Deserializer {
 public:
  explicit Deserializer(const dds::Topic<Sample>& topic)
      : reader_(participant(), topic), writer_(participant(), topic) {
    writer_.write(Sample{});
    dds_sample_info_t info;
    while (dds_takecdr(reader_.handle(), &example_, 1, &info, DDS_ANY_STATE) != 1) {}
  }

  /// Hands the sample to `use`, if the library takes the bytes.
  template <typename Use>
  void read(std::string_view cdr, Use use) const {
    std::string padded(cdr);
    padded.resize((padded.size() + 3) / 4 * 4);
    ddsrt_iovec_t part{padded.data(), padded.size()};
    ddsi_serdata* const data =
        ddsi_serdata_from_ser_iov(example_->type, SDK_DATA, 1, &part, padded.size());
    if (data == nullptr) return;
    Sample sample{};
    if (dds::read_whole(data, reader_.topic().least_bytes, &sample)) use(sample);
    dds_sample_free(&sample, reader_.topic().type, DDS_FREE_CONTENTS);
    ddsi_serdata_unref(data);
  }

 private:
  static const dds::Participant& participant() {
    static const testing::PrivateBus bus;
    static const dds::Participant joined = bus.join("fuzz");
    return joined;
  }

  dds::Reader<Sample> reader_;
  dds::Writer<Sample> writer_;
  ddsi_serdata* example_ = nullptr;
};

template <typename Sample>
void read_with(const dds::Topic<Sample>& topic, std::string_view cdr) {
  static const Deserializer<Sample> deserializer(topic);
  deserializer.read(cdr, [](const Sample& sample) {
    const auto decoded = wire::decode(sample);
    if (!decoded) require(!decoded.fault().empty(), "a fault has words");
  });
}

void read_correction(std::string_view cdr) {
  static const Deserializer<slammot_GraphCorrection> deserializer(dds::topics::kGraphCorrection);
  static wire::GraphCorrectionAssembler assembler;
  deserializer.read(cdr, [](const slammot_GraphCorrection& part) { (void)assembler.add(part); });
}

void read_ways(std::string_view cdr) {
  static const Deserializer<slammot_TrafficWays> deserializer(dds::topics::kTrafficWays);
  static wire::TrafficWaysAssembler assembler;
  deserializer.read(cdr, [](const slammot_TrafficWays& part) { (void)assembler.add(part); });
}

void read_tile(std::string_view cdr) {
  static const Deserializer<slammot_SubmapTile> deserializer(dds::topics::kSubmapTile);
  static wire::SubmapAssembler assembler;
  deserializer.read(cdr, [](const slammot_SubmapTile& tile) { (void)assembler.add(tile); });
}

}  // namespace

void read_sample(std::string_view bytes) {
  using namespace dds::topics;
  static constexpr std::array kReaders = {
      +[](std::string_view cdr) { read_with(kLaserScan, cdr); },
      +[](std::string_view cdr) { read_with(kOdometry, cdr); },
      +[](std::string_view cdr) { read_with(kGnssFix, cdr); },
      +[](std::string_view cdr) { read_with(kCompassReading, cdr); },
      +[](std::string_view cdr) { read_with(kLocalizedScan, cdr); },
      +[](std::string_view cdr) { read_with(kSegmentedScan, cdr); },
      +[](std::string_view cdr) { read_with(kTrackedObjects, cdr); },
      +[](std::string_view cdr) { read_with(kScanLabels, cdr); },
      +[](std::string_view cdr) { read_with(kCollisionWarnings, cdr); },
      +[](std::string_view cdr) { read_with(kConstraint, cdr); },
      +[](std::string_view cdr) { read_with(kStoredMap, cdr); },
      +[](std::string_view cdr) { read_with(kHeartbeat, cdr); },
      +[](std::string_view cdr) { read_with(kStatus, cdr); },
      +[](std::string_view cdr) { read_with(kCommand, cdr); },
      +[](std::string_view cdr) { read_with(kReply, cdr); },
      +[](std::string_view cdr) { read_correction(cdr); },
      +[](std::string_view cdr) { read_tile(cdr); },
      +[](std::string_view cdr) { read_ways(cdr); }};
  if (bytes.empty()) return;
  const auto topic = static_cast<unsigned char>(bytes.front());
  kReaders[topic % kReaders.size()](bytes.substr(1));
}

}  // namespace slammot::fuzz
