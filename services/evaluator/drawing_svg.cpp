#include "services/evaluator/drawing.hpp"

#include "common/files/base64.hpp"
#include "common/files/text.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

std::string ink_of(const char* use, const Ink& ink) {
  std::string text =
      files::text(" %s=\"#%02x%02x%02x\"", use, ink.colour[0], ink.colour[1], ink.colour[2]);
  if (ink.opacity < 1.0)
    text += files::text(" %s-opacity=\"%s\"", use, svg_number(ink.opacity).c_str());
  return text;
}

std::string path_of(const std::vector<PlotPoint>& points) {
  std::string path;
  for (const PlotPoint& point : points)
    path.append(path.empty() ? "M" : "L")
        .append(svg_number(point.x))
        .append(" ")
        .append(svg_number(point.y));
  return points.size() == 1 ? path + "h0" : path;
}

struct SvgWriter {
  std::string operator()(const LineMark& line) const {
    return "<path fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\"" +
           ink_of("stroke", line.ink) + attribute("stroke-width", line.width) +
           (line.is_dashed ? " stroke-dasharray=\"6 4\"" : "") + " d=\"" + path_of(line.points) +
           "\"/>\n";
  }
  std::string operator()(const AreaMark& area) const {
    return "<path" + ink_of("fill", area.ink) + " d=\"" + path_of(area.points) + "Z\"/>\n";
  }
  std::string operator()(const TextMark& text) const {
    constexpr const char* kAnchors[] = {"start", "middle", "end"};
    std::string turn;
    if (text.is_upward)
      turn =
          " transform=\"rotate(-90 " + svg_number(text.at.x) + " " + svg_number(text.at.y) + ")\"";
    return "<text" + attribute("x", text.at.x) + attribute("y", text.at.y) +
           attribute("font-size", text.size) + " text-anchor=\"" +
           kAnchors[static_cast<std::size_t>(text.anchor)] + "\"" + ink_of("fill", text.ink) +
           turn + ">" + escaped(text.text) + "</text>\n";
  }
  std::string operator()(const ImageMark& image) const {
    const auto png = files::to_png(*image.image);
    if (!png) return {};
    return "<image" + attribute("x", image.at.x) + attribute("y", image.at.y) +
           attribute("width", image.width) + attribute("height", image.height) +
           " preserveAspectRatio=\"none\" href=\"data:image/png;base64," + files::to_base64(*png) +
           "\"/>\n";
  }
};

}  // namespace

std::string to_svg(const Drawing& drawing) {
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"" +
                    attribute("width", drawing.width) + attribute("height", drawing.height) +
                    " viewBox=\"0 0 " + svg_number(drawing.width) + " " +
                    svg_number(drawing.height) +
                    "\" font-family=\"system-ui, 'DejaVu Sans', sans-serif\">\n<rect "
                    "width=\"100%\" height=\"100%\"" +
                    ink_of("fill", {drawing.background}) + "/>\n";
  for (const Mark& mark : drawing.marks) svg += std::visit(SvgWriter{}, mark);
  return svg + "</svg>\n";
}

}  // namespace slammot::evaluator
