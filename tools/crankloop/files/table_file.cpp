#include "table_file.hpp"

#include "error.hpp"
#include "text_file.hpp"
#include "words.hpp"

namespace crankloop::program {
namespace {

void check_header(std::string_view line, const TableFormat& format, const std::string& path, int number) {
  const std::vector<std::string_view> names = split(line, ',');
  if (names.size() == 2 && names[0] == format.first && names[1] == format.second) return;
  throw InputError(path, number,
                   std::string("the header row must be '") + format.first + "," + format.second +
                       "'; columns are separated by commas");
}

double column(std::string_view text, const char* name, const Range& range, const std::string& path, int line) {
  if (!parse_number(text).ok()) {
    throw InputError(path, line,
                     std::string(name) + ": not a finite number with a point as decimal sign, and nothing else");
  }
  const ParsedNumber number = parse_number(text, range, "");
  if (!number.ok()) throw InputError(path, line, std::string(name) + ": " + number.problem);
  return number.value;
}

std::vector<TableRow> rows_of(const std::string& bytes, const TableFormat& format, const std::string& path) {
  const std::vector<std::string> lines = split_lines(bytes, path);
  std::vector<TableRow> rows;
  bool header_seen = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const int line = static_cast<int>(i) + 1;
    const std::string_view text = trim(lines[i]);
    if (text.empty() || text[0] == '#') continue;
    if (!header_seen) {
      check_header(text, format, path, line);
      header_seen = true;
      continue;
    }
    const std::vector<std::string_view> cells = split(text, ',');
    if (cells.size() != 2) {
      throw InputError(path, line,
                       "the row has " + std::to_string(cells.size()) + (cells.size() == 1 ? " column" : " columns") +
                           "; a row is '" + format.first + "," + format.second + "', with a point as decimal sign");
    }
    rows.push_back({column(cells[0], format.first, format.range_first, path, line),
                    column(cells[1], format.second, format.range_second, path, line), line});
  }
  const std::string header = std::string("'") + format.first + "," + format.second + "'";
  if (!header_seen)
    throw InputError(path, 1, "the file is empty; it needs the header row " + header + " and rows under it");
  if (rows.empty()) throw InputError(path, static_cast<int>(lines.size()), "no rows stand under the header " + header);
  return rows;
}

}  // namespace

std::vector<TableRow> read_table(const std::string& path, const TableFormat& format, const std::string& named_in,
                                 int named_at) {
  const FileBytes file = read_file(path, kMaxTableBytes);
  if (!file.ok()) throw InputError(named_in, named_at, "file: " + path + " " + file.problem);
  return rows_of(file.bytes, format, path);
}

std::vector<TableRow> read_table(const std::string& path, const TableFormat& format) {
  const FileBytes file = read_file(path, kMaxTableBytes);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  return rows_of(file.bytes, format, path);
}

}  // namespace crankloop::program
