#pragma once

#include <memory>

#include <dds/dds.h>

#include "common/dds/qos.hpp"

namespace slammot::dds {

using QosPointer = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

/// Transient-local: the last samples of each key, so many, for readers that come later.
void keep_for_late_joiners(dds_qos_t* qos, std::int32_t depth);

/// The profile as the C library wants it; only for the sources of this folder.
QosPointer make_reader_qos(const QosProfile& profile);
/// With the history of History::kRestart.
QosPointer make_restart_reader_qos(const QosProfile& profile);
QosPointer make_writer_qos(const QosProfile& profile);
/// Best effort, volatile, with the history of History::kRecorder.
QosPointer make_recorder_qos();

}  // namespace slammot::dds
