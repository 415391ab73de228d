#include "services/ingest/ingest_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::ingest::IngestService>(argc, argv);
}
