#include "services/evaluator/report_player.hpp"

#include <algorithm>
#include <cmath>

#include "common/files/base64.hpp"
#include "common/files/text.hpp"
#include "services/evaluator/doubts.hpp"
#include "services/evaluator/drive_data.hpp"
#include "services/evaluator/embedded_page.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

constexpr std::size_t kMostDoubts = 40;

/// A script that holds data, which the browser does not run.
std::string data_element(const char* id, const char* type, const std::string& content) {
  return "<script id=\"" + std::string(id) + "\" type=\"" + type + "\">" + content + "</script>\n";
}

std::string minutes(double seconds) {
  return files::text("%d:%04.1f", static_cast<int>(seconds / 60.0), std::fmod(seconds, 60.0));
}

}  // namespace

std::string_view page_file(std::string_view name) {
  for (const files::EmbeddedFile& file : embedded_page()) {
    if (file.name == name) return file.bytes;
  }
  return {};
}

std::string page_head(const std::string& title) {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\"><title>" +
         escaped(title) + "</title><style>\n" + std::string(page_file("style.css")) +
         std::string(page_file("report.css")) + "</style></head>\n";
}

std::string player_of(const RunResult& result) {
  const auto picture = draw_picture(result);
  const DriveData drive = encode_drive(result, picture ? &*picture : nullptr);
  return std::string(page_file("player.html")) +
         data_element("drive", "application/json", drive.header) +
         data_element("drive-data", "text/plain", files::to_base64(drive.bytes)) +
         data_element("drive-map", "text/plain", picture ? files::to_base64(picture->png) : "") +
         "<script>\n" + std::string(page_file("report.js")) + "</script>\n";
}

std::string player_page(const RunResult& result, const std::string& title) {
  return page_head(title) + "<body class=\"bare\">" + player_of(result) + "</body></html>\n";
}

std::string doubts_section(const RunResult& result) {
  const std::vector<Doubt> doubts = find_doubts(result);
  std::string html = "<section><h2>Where it was unsure or lost</h2>";
  if (doubts.empty())
    return html +
           "<p>Nowhere: every stretch was matched, and the standard deviation of the "
           "position stayed near its median.</p></section>";
  html += "<ul>";
  for (std::size_t i = 0; i < std::min(doubts.size(), kMostDoubts); ++i) {
    const double begin_s =
        static_cast<double>(doubts[i].begin_ns - result.corrected.front().stamp_ns) * 1e-9;
    const double length_s = static_cast<double>(doubts[i].end_ns - doubts[i].begin_ns) * 1e-9;
    html += "<li><button data-at=\"" + svg_number(begin_s) + "\">" + minutes(begin_s) +
            "</button> " + escaped(doubts[i].what) + ", for " + files::text("%.1f s", length_s) +
            "</li>";
  }
  html += "</ul>";
  if (doubts.size() > kMostDoubts)
    html += "<p>and " + std::to_string(doubts.size() - kMostDoubts) + " more times.</p>";
  return html + "</section>";
}

}  // namespace slammot::evaluator
