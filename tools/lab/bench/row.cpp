#include "row.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "crankloop/files/csv.hpp"
#include "crankloop/files/number.hpp"

namespace crankloop::program::bench {
namespace {

/// A JSON string. Names of contestants are plain text; a processor's name comes from the machine.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x20) {
      out += c;
      continue;
    }
    char escape[8];
    std::snprintf(escape, sizeof escape, "\\u%04x", code);
    out += escape;
  }
  return out + "\"";
}

std::string number_or_null(double value) {
  return std::isfinite(value) ? significant(static_cast<float>(value)) : "null";
}

/// Four significant digits, for reading.
std::string short_number(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string line_of(const Row& row, std::size_t names, std::size_t settings) {
  std::string line =
      "  " + padded(row.contestant, names) + "  " + padded(row.real, 6) + "  " + padded(row.setting, settings) + "  ";
  if (row.ratio) {
    line += padded(short_number(*row.ratio), 8);
  } else if (std::isfinite(row.ns_median)) {
    line += padded(short_number(row.ns_median) + " +- " + short_number(row.ns_spread / 2) + " ns per " + row.per, 40);
  }
  if (!row.error_unit.empty()) line += "  error " + short_number(row.error) + " " + row.error_unit;
  return line;
}

}  // namespace

std::string to_json(const std::vector<Row>& rows) {
  std::string text = "[";
  const char* separator = "\n";
  for (const Row& row : rows) {
    text += separator;
    text += "  {\"group\": " + quoted(row.group) + ", \"contestant\": " + quoted(row.contestant) +
            ", \"real\": " + quoted(row.real) + ", \"setting\": " + quoted(row.setting) +
            ", \"per\": " + quoted(row.per) + ", \"ns_median\": " + number_or_null(row.ns_median) +
            ", \"ns_spread\": " + number_or_null(row.ns_spread) + ", \"error\": " + number_or_null(row.error) +
            ", \"error_unit\": " + quoted(row.error_unit);
    if (row.ratio) text += ", \"ratio\": " + number_or_null(*row.ratio);
    text += "}";
    separator = ",\n";
  }
  return text + "\n]\n";
}

std::string to_text(const std::vector<Row>& rows) {
  std::string text;
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t end = first;
    std::size_t names = 0;
    std::size_t settings = 0;
    for (; end < rows.size() && rows[end].group == rows[first].group; ++end) {
      names = std::max(names, rows[end].contestant.size());
      settings = std::max(settings, rows[end].setting.size());
    }
    text += rows[first].group + "\n";
    for (; first < end; ++first) text += line_of(rows[first], names, settings) + "\n";
  }
  return text;
}

void write_csv(Output& out, const std::vector<Row>& rows) {
  // A CSV cell holds no comma (csv.hpp), our settings do.
  const auto cell = [](std::string text) {
    std::replace(text.begin(), text.end(), ',', ';');
    return text;
  };
  CsvWriter csv(
      out, {"group", "contestant", "real", "setting", "per", "ns_median", "ns_spread", "error", "error_unit", "ratio"});
  for (const Row& row : rows) {
    const auto number = [](double value) {
      return std::isfinite(value) ? significant(static_cast<float>(value)) : std::string();
    };
    csv.row(cell(row.group), cell(row.contestant), row.real, cell(row.setting), row.per, number(row.ns_median),
            number(row.ns_spread), number(row.error), cell(row.error_unit),
            row.ratio ? number(*row.ratio) : std::string());
  }
}

const Row& find(const std::vector<Row>& rows, std::string_view group, std::string_view contestant,
                std::string_view real, std::string_view setting) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
    return r.group == group && r.contestant == contestant && r.real == real && r.setting == setting;
  });
  if (row == rows.end())
    throw std::logic_error("the benchmark has no row " + std::string(group) + ", " + std::string(contestant) + ", " +
                           std::string(real) + ", " + std::string(setting));
  return *row;
}

}  // namespace crankloop::program::bench
