#include "services/localization/localization_service.hpp"

int main(int argc, char** argv) {
  return slammot::app::run_service<slammot::localization::LocalizationService>(argc, argv);
}
