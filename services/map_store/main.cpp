#include "services/map_store/map_store_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::map_store::MapStoreService>(argc, argv);
}
