#pragma once

#include "common/config/fields.hpp"
#include "services/ingest/ingest_config.hpp"

namespace slammot::ingest {

/// The settings of ingest as message Ingest has them.
const config::FieldTable<IngestConfig>& ingest_fields();

}  // namespace slammot::ingest
