#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/app/repeat_watch.hpp"
#include "common/app/service_context.hpp"
#include "common/wire/localized_scan.hpp"

namespace slammot::localization {

/// Publishes localized scans, and keeps the newest one of each scanner.
class ScanPublisher {
 public:
  explicit ScanPublisher(app::ServiceContext& context);
  ScanPublisher(const ScanPublisher&) = delete;
  ScanPublisher& operator=(const ScanPublisher&) = delete;

  /// scan_published_ns: by the system clock of the source of the scan.
  void publish(flow::LocalizedScan scan, std::int64_t scan_published_ns);

  /// Publishes the newest scan of the scanner once more, if there is one: the answer to a scan that
  /// is done, or to a sender that begins its drive again. It tells both how far the drive is. Of a
  /// series of scans that are done not all are answered.
  void answer_again(const std::string& scanner_id, std::int64_t stamp_ns);

  /// Continues after the scans of an earlier process.
  void take_up(const std::vector<flow::LocalizedScan>& newest);

  /// The newest scan of each scanner, without its beams.
  std::vector<flow::LocalizedScan> newest() const;

  void clear() { newest_.clear(); }

 private:
  void publish_newest(const std::string& scanner_id);

  app::ServiceContext& context_;
  dds::Writer<slammot_LocalizedScan>& scans_;
  wire::LocalizedScanEncoder encoder_;
  app::RepeatWatch repeats_;
  std::map<std::string, flow::LocalizedScan> newest_;
};

}  // namespace slammot::localization
