// A report as one self-contained HTML file: key figures, then sections of text, tables and plots.
//
// What belongs here: the order and look of a page. What does not: drawing (plot.hpp), engines, files.
//
// The page needs no network (its content security policy forbids it) and no script: its only script, read_out.hpp,
// shows values under the pointer. It follows the reader's light or dark theme, has one column on a phone and two on a
// desk, and prints light. It is well-formed XML too, which makes it testable.
#pragma once

#include "plot.hpp"

#include <string>
#include <variant>
#include <vector>

namespace crankloop::report {

struct Paragraph {
  std::string text{};
  bool note = false;  ///< highlighted: an assumption or a warning
};

struct List {
  std::vector<std::string> items{};
};

struct Column {
  std::string title{};
  std::string unit{};
  bool numeric = true;  ///< right-aligned
};

/// The first cell of a row is the row's heading. Short rows are filled with empty cells, surplus cells ignored.
struct Table {
  std::string caption{};
  std::vector<Column> columns{};
  std::vector<std::vector<std::string>> rows{};
  bool folded = false;  ///< hidden until the reader opens it; printed only if it is open
};

/// Neighbouring plots and tables of up to five columns share rows where there is room.
using Block = std::variant<Paragraph, List, Table, Plot>;

struct Section {
  std::string id{};
  std::string title{};
  std::vector<Block> blocks{};
};

/// A key figure at the head of the page.
struct Fact {
  std::string name{};
  std::string value{};
  std::string unit{};
  std::string note{};
};

struct Page {
  std::string title{};
  std::string subtitle{};
  std::vector<Fact> facts{};
  std::vector<Section> sections{};
  std::string footer{};
  std::string language = "en";
};

/// Notes at the top of the first section.
void put_first(Page& page, const std::vector<std::string>& notes);

/// The whole file. All text is escaped; ids are made valid and unique.
[[nodiscard]] std::string to_html(const Page& page);

}  // namespace crankloop::report
