// Several plots as one SVG file: a heading, and the plots in columns below it.
//
// What belongs here: the layout of such a file. What does not: drawing (plot.hpp), engines, writing files.
//
// The file needs no script, no font and no network, follows the reader's light or dark theme, and prints light.
#pragma once

#include <string>
#include <vector>

#include "plot.hpp"

namespace crankloop::report {

/// A drawing of the caller's own, in the sheet's type and colours.
struct Picture {
  std::string svg{};    ///< elements, from 0, 0 to width, height in user units
  std::string style{};  ///< CSS for its classes
  double width = 0;
  double height = 0;
};

struct Sheet {
  std::string title{};
  std::vector<std::string>
      remarks{};              ///< a line each below the title; it is not broken: about 60 characters per column
  Picture picture{};          ///< above the plots; absent without svg
  std::vector<Plot> plots{};  ///< row by row; captions are not shown, ids given anew
  int columns = 2;
};

/// The whole file. All text is escaped.
[[nodiscard]] std::string to_svg_file(const Sheet& sheet);

}  // namespace crankloop::report
