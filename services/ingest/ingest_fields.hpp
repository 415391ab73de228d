#pragma once

#include "common/config/fields.hpp"
#include "services/ingest/ingest_config.hpp"

namespace slammot::ingest {

/// Settings of ingest, as in message Ingest.
const config::FieldTable<IngestConfig>& ingest_fields();

}  // namespace slammot::ingest
