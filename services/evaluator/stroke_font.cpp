#include "services/evaluator/stroke_font.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace slammot::evaluator {
namespace {

// One entry a character: points "xy" in units of a sixth of the height of capitals, strokes apart
// by
// '|'. The baseline is at y 2, capitals end at y 8, small letters at y 6.
struct Glyph {
  char letter;
  const char* strokes;
};

constexpr Glyph kGlyphs[] = {
    {'A', "02 28 42|14 34"},
    {'B', "02 08 38 47 46 35 05|35 44 43 32 02"},
    {'C', "47 38 18 07 03 12 32 43"},
    {'D', "02 08 28 47 43 22 02"},
    {'E', "48 08 02 42|05 35"},
    {'F', "48 08 02|05 35"},
    {'G', "47 38 18 07 03 12 32 43 45 25"},
    {'H', "02 08|42 48|05 45"},
    {'I', "02 08"},
    {'J', "38 33 22 12 03"},
    {'K', "02 08|48 05 42"},
    {'L', "08 02 42"},
    {'M', "02 08 25 48 42"},
    {'N', "02 08 42 48"},
    {'O', "12 03 07 18 38 47 43 32 12"},
    {'P', "02 08 38 47 46 35 05"},
    {'Q', "12 03 07 18 38 47 43 32 12|24 42"},
    {'R', "02 08 38 47 46 35 05|25 42"},
    {'S', "47 38 18 07 06 15 35 44 43 32 12 03"},
    {'T', "08 48|28 22"},
    {'U', "08 03 12 32 43 48"},
    {'V', "08 22 48"},
    {'W', "08 12 25 32 48"},
    {'X', "08 42|02 48"},
    {'Y', "08 25 48|25 22"},
    {'Z', "08 48 02 42"},
    {'a', "05 16 26 35 32|34 14 03 12 22 33"},
    {'b', "08 02|05 16 26 35 33 22 12 03"},
    {'c', "35 26 16 05 03 12 22 33"},
    {'d', "38 32|35 26 16 05 03 12 22 33"},
    {'e', "04 34 35 26 16 05 03 12 22 33"},
    {'f', "28 18 17 12|06 26"},
    {'g', "36 31 20 10 01|35 26 16 05 03 12 22 33"},
    {'h', "08 02|05 16 26 35 32"},
    {'i', "02 06|08"},
    {'j', "16 11 00|18"},
    {'k', "08 02|36 04 32"},
    {'l', "08 02"},
    {'m', "02 06|05 16 25 22|25 36 45 42"},
    {'n', "02 06|05 16 26 35 32"},
    {'o', "12 03 05 16 26 35 33 22 12"},
    {'p', "00 06|05 16 26 35 33 22 12 03"},
    {'q', "30 36|35 26 16 05 03 12 22 33"},
    {'r', "02 06|04 16 26"},
    {'s', "35 26 16 05 14 24 33 22 12 03"},
    {'t', "18 13 22|06 26"},
    {'u', "06 03 12 22 33|36 32"},
    {'v', "06 22 46"},
    {'w', "06 12 25 32 46"},
    {'x', "06 32|02 36"},
    {'y', "06 22|36 10 00"},
    {'z', "06 36 02 32"},
    {'0', "12 03 07 18 28 37 33 22 12"},
    {'1', "07 18 12"},
    {'2', "07 18 28 37 36 02 32"},
    {'3', "07 18 28 37 36 25 15|25 34 33 22 12 03"},
    {'4', "22 28 04 34"},
    {'5', "38 08 05 25 34 33 22 12 03"},
    {'6', "37 28 18 07 03 12 22 33 34 25 15 04"},
    {'7', "08 38 12"},
    {'8', "15 06 07 18 28 37 36 25 15 04 03 12 22 33 34 25"},
    {'9', "03 12 22 33 37 28 18 07 06 15 25 36"},
    {'.', "02"},
    {',', "12 01"},
    {':', "03|06"},
    {';', "12 01|16"},
    {'-', "05 25"},
    {'+', "05 45|23 27"},
    {'/', "02 38"},
    {'(', "19 07 03 11"},
    {')', "09 17 13 01"},
    {'[', "19 09 01 11"},
    {']', "09 19 11 01"},
    {'%', "02 48|07|43"},
    {'_', "01 41"},
    {'=', "04 34|06 36"},
    {'<', "37 05 33"},
    {'>', "07 35 03"},
    {'\'', "08 07"},
    {' ', ""},
};

constexpr const char* kUnknown = "02 08 38 32 02";
constexpr double kUnit = 1.0 / 6.0;
constexpr double kBaseline = 2.0;
constexpr double kGap = 1.6;    // between characters
constexpr double kBlank = 2.0;  // width of a blank

const char* strokes_of_letter(char letter) {
  const auto* const glyph = std::ranges::find(kGlyphs, letter, &Glyph::letter);
  return glyph == std::end(kGlyphs) ? kUnknown : glyph->strokes;
}

double width_of_letter(char letter) {
  double width = letter == ' ' ? kBlank : 0.0;
  bool is_x = true;
  for (const char* at = strokes_of_letter(letter); *at != '\0'; ++at) {
    if (*at < '0' || *at > '9') continue;
    if (is_x) width = std::max(width, static_cast<double>(*at - '0'));
    is_x = !is_x;
  }
  return width;
}

}  // namespace

std::vector<FontStroke> strokes_of(std::string_view text) {
  std::vector<FontStroke> strokes;
  double left = 0.0;
  for (const char letter : text) {
    FontStroke stroke;
    for (const char* at = strokes_of_letter(letter); *at != '\0'; ++at) {
      if (*at == '|') strokes.push_back(std::exchange(stroke, {}));
      if (*at < '0' || *at > '9') continue;
      const double x = *at - '0';
      const double y = *++at - '0';
      stroke.push_back({(left + x) * kUnit, (y - kBaseline) * kUnit});
    }
    if (!stroke.empty()) strokes.push_back(std::move(stroke));
    left += width_of_letter(letter) + kGap;
  }
  return strokes;
}

double width_of(std::string_view text) {
  double width = 0.0;
  for (const char letter : text) width += width_of_letter(letter) + kGap;
  return text.empty() ? 0.0 : (width - kGap) * kUnit;
}

}  // namespace slammot::evaluator
