#pragma once

#include <map>
#include <string>
#include <string_view>

#include "common/files/png_image.hpp"

namespace slammot::evaluator {

/// Colours by their names in the live page's theme.js.
using PageTheme = std::map<std::string, files::Rgb>;

/// The theme "dark" or "light" of a text in the form of theme.js; empty if it has no such theme.
PageTheme theme_in(std::string_view script, std::string_view name);

/// Of the live page that this program was built with.
PageTheme page_theme(std::string_view name);

/// Name in the theme of the colour of a class of objects, as tracks.csv names them.
std::string colour_name_of(std::string_view object_class);

}  // namespace slammot::evaluator
