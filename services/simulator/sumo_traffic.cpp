#include "services/simulator/sumo_traffic.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

#include <expat.h>

namespace slammot::simulator {
namespace {

using simulation::ObjectClass;
using simulation::RecordedObject;

using Attributes = std::map<std::string_view, std::string_view>;

ObjectClass class_of(std::string_view type) {
  const auto has = [type](std::string_view part) {
    return type.find(part) != std::string_view::npos;
  };
  if (has("bus") || has("coach")) return ObjectClass::bus;
  if (has("truck") || has("trailer") || has("delivery")) return ObjectClass::truck;
  if (has("bicycle") || has("bike")) return ObjectClass::bicycle;
  return has("ped") ? ObjectClass::pedestrian : ObjectClass::car;
}

std::optional<double> number(const Attributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return std::nullopt;
  double value = 0.0;
  const auto [end, fault] = std::from_chars(found->second.begin(), found->second.end(), value);
  return fault == std::errc() && end == found->second.end() && std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

/// Processes XML elements in order.
class Reader {
 public:
  void take(std::string_view element, const Attributes& attributes) {
    if (element == "timestep") begin_step(number(attributes, "time"));
    if (element == "vehicle" || element == "person") add(element, attributes);
  }

  const std::string& fault() const { return fault_; }
  std::vector<RecordedObject> objects() { return std::move(objects_); }

 private:
  void begin_step(std::optional<double> time_s) {
    if (!time_s || (now_s_ && *time_s <= *now_s_)) {
      fault_ = "a timestep whose time is missing or not later than the previous one";
      return;
    }
    if (!now_s_) first_s_ = *time_s;
    now_s_ = time_s;
  }

  void add(std::string_view element, const Attributes& attributes) {
    const auto x_m = number(attributes, "x"), y_m = number(attributes, "y"),
               angle_deg = number(attributes, "angle"), speed_mps = number(attributes, "speed");
    if (!now_s_ || !x_m || !y_m || !angle_deg || !speed_mps || !attributes.contains("id")) {
      fault_ = "a " + std::string(element) +
               " without id, x, y, angle or speed, or outside of a timestep";
      return;
    }
    RecordedObject& object = object_of(std::string(attributes.at("id")), element, attributes);
    const double heading_rad =
        geometry::wrap_angle(0.5 * std::numbers::pi - *angle_deg * std::numbers::pi / 180.0);
    const double back_m =
        object.kind == ObjectClass::pedestrian ? 0.0 : 0.5 * usual_size(object.kind).length_m;
    const geometry::Pose2 world_from_object{*x_m - back_m * std::cos(heading_rad),
                                            *y_m - back_m * std::sin(heading_rad), heading_rad};
    object.places.push_back({*now_s_ - first_s_, world_from_object, *speed_mps});
  }

  RecordedObject& object_of(std::string id, std::string_view element,
                            const Attributes& attributes) {
    const auto [entry, is_new] = index_by_id_.emplace(id, objects_.size());
    if (!is_new) return objects_[entry->second];
    const auto type = attributes.find("type");
    RecordedObject object;
    object.name = std::move(id);
    object.kind = element == "person" ? ObjectClass::pedestrian
                                      : class_of(type == attributes.end() ? "" : type->second);
    return objects_.emplace_back(std::move(object));
  }

  double first_s_ = 0.0;
  std::optional<double> now_s_;
  std::map<std::string, std::size_t> index_by_id_;
  std::vector<RecordedObject> objects_;
  std::string fault_;
};

struct Parsing {
  Reader reader;
  XML_Parser parser;
};

void on_element(void* user, const XML_Char* element, const XML_Char** names_and_values) {
  auto& parsing = *static_cast<Parsing*>(user);
  Attributes attributes;
  for (const XML_Char** at = names_and_values; *at != nullptr; at += 2) attributes[at[0]] = at[1];
  parsing.reader.take(element, attributes);
  if (!parsing.reader.fault().empty()) XML_StopParser(parsing.parser, XML_FALSE);
}

}  // namespace

files::Result<std::vector<RecordedObject>> read_sumo_traffic(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return files::Error{file.string() + ": cannot be read"};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       XML_ParserFree);
  Parsing parsing{{}, parser.get()};
  XML_SetUserData(parser.get(), &parsing);
  XML_SetStartElementHandler(parser.get(), on_element);
  if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), XML_TRUE) !=
      XML_STATUS_OK) {
    const std::string why = parsing.reader.fault().empty()
                                ? XML_ErrorString(XML_GetErrorCode(parser.get()))
                                : parsing.reader.fault();
    return files::Error{file.string() + ":" +
                        std::to_string(XML_GetCurrentLineNumber(parser.get())) + ": " + why};
  }
  std::vector<RecordedObject> objects = parsing.reader.objects();
  if (objects.empty()) return files::Error{file.string() + ": no vehicle and no person"};
  return objects;
}

}  // namespace slammot::simulator
