#include "bench_report_parts.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crankloop::program::bench {

report::Axis axis(const char* title, const char* unit, bool logarithmic) {
  report::Axis one;
  one.title = title;
  one.unit = unit;
  one.logarithmic = logarithmic;
  return one;
}

std::string digits(double value, int count) { return report::format_number(value, count); }

std::string with_signs(std::string text) {
  const std::pair<const char*, const char*> signs[] = {{" us", " \u00B5s"}, {" um", " \u00B5m"}, {"^2", "\u00B2"}};
  for (const auto& [plain, sign] : signs) {
    const std::string from = plain;
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1))
      text.replace(at, from.size(), sign);
  }
  return text;
}

std::string error_text(const Row& row) { return with_signs(digits(row.error) + " " + row.error_unit); }

std::string time_text(const Row& row) { return digits(row.ns_median) + " \u00B1 " + digits(row.ns_spread / 2, 2); }

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

Rows where(const Rows& rows, const std::function<bool(const Row&)>& wanted) {
  Rows some;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(some), wanted);
  return some;
}

}  // namespace crankloop::program::bench
