#include "services/keys/permissions.hpp"

#include <algorithm>
#include <iterator>

#include "common/dds/topic_table.hpp"

namespace slammot::keys {
namespace {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
    "<dds xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
    "xsi:noNamespaceSchemaLocation=\"https://www.omg.org/spec/DDS-SECURITY/20170901/";
constexpr std::string_view kDomains =
    "<domains><id_range><min>0</min><max>230</max></id_range></domains>\n";

std::string escaped(std::string_view text) {
  std::string xml;
  for (const char c : text) {
    if (c == '<') xml += "&lt;";
    else if (c == '&') xml += "&amp;";
    else xml += c;
  }
  return xml;
}

std::string topics_xml(const std::string& direction, const std::vector<std::string>& topics) {
  if (topics.empty()) return {};
  std::string xml = "<" + direction + "><topics>";
  for (const std::string& topic : topics) xml += "<topic>" + escaped(topic) + "</topic>";
  return xml + "</topics></" + direction + ">\n";
}

std::string service_of(std::string identity) {
  std::ranges::replace(identity, '-', '_');
  return identity;
}

}  // namespace

std::vector<std::string> project_identities() {
  // these two publish nothing but what every service publishes
  std::vector<std::string> identities = {"recorder"};
  for (const std::string_view service : dds::publishing_services()) {
    std::ranges::replace_copy(service, std::back_inserter(identities.emplace_back()), '_', '-');
  }
  std::ranges::sort(identities);
  return identities;
}

std::string subject_of(const std::string& identity) { return "slammot-" + identity; }

Grant grant_of(const std::string& identity) {
  Grant grant{subject_of(identity), {}, {"slammot/*"}};
  for (const dds::TopicInfo* topic : dds::topic_table()) {
    const bool is_for_services = topic->publishers == "*" && identity == kTools;
    if (dds::may_publish(service_of(identity), *topic) && !is_for_services)
      grant.publishes.emplace_back(topic->name);
  }
  return grant;
}

std::string governance_xml() {
  std::string xml(kHead);
  xml += "omg_shared_ca_governance.xsd\">\n<domain_access_rules><domain_rule>\n";
  xml += kDomains;
  xml +=
      "<allow_unauthenticated_participants>false</allow_unauthenticated_participants>\n"
      "<enable_join_access_control>true</enable_join_access_control>\n"
      "<discovery_protection_kind>ENCRYPT</discovery_protection_kind>\n"
      "<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>\n"
      "<rtps_protection_kind>NONE</rtps_protection_kind>\n"
      "<topic_access_rules><topic_rule><topic_expression>*</topic_expression>\n"
      "<enable_discovery_protection>true</enable_discovery_protection>\n"
      "<enable_liveliness_protection>true</enable_liveliness_protection>\n"
      "<enable_read_access_control>true</enable_read_access_control>\n"
      "<enable_write_access_control>true</enable_write_access_control>\n"
      "<metadata_protection_kind>ENCRYPT</metadata_protection_kind>\n"
      "<data_protection_kind>NONE</data_protection_kind>\n"
      "</topic_rule></topic_access_rules>\n</domain_rule></domain_access_rules>\n</dds>\n";
  return xml;
}

std::string permissions_xml(const Grant& grant, const Validity& validity) {
  std::string xml(kHead);
  xml += "omg_shared_ca_permissions.xsd\">\n<permissions><grant name=\"" + grant.subject + "\">\n";
  xml += "<subject_name>CN=" + grant.subject + "</subject_name>\n";
  xml += "<validity><not_before>" + validity.from + "</not_before><not_after>" + validity.until +
         "</not_after></validity>\n";
  if (!grant.publishes.empty() || !grant.subscribes.empty()) {
    xml += "<allow_rule>";
    xml += kDomains;
    xml += topics_xml("publish", grant.publishes) + topics_xml("subscribe", grant.subscribes);
    xml += "</allow_rule>\n";
  }
  return xml + "<default>DENY</default>\n</grant></permissions>\n</dds>\n";
}

}  // namespace slammot::keys
