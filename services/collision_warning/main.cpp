#include "services/collision_warning/collision_warning_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::collision_warning::CollisionWarningService>(argc, argv);
}
