// The benchmark as a page: work-precision diagrams, whole ticks, ratios.
//
// What belongs here: assignment of rows to plots. What does not: drawing (report/), measuring.
#pragma once

#include <string>
#include <vector>

#include "crankloop/report/page.hpp"
#include "crankloop/report/sheet.hpp"
#include "row.hpp"

namespace crankloop::program::bench {

[[nodiscard]] report::Page bench_page(const std::vector<Row>& rows, const std::string& machine,
                                      const std::string& command_line);

/// The work-precision diagrams alone, as a picture.
[[nodiscard]] report::Sheet bench_sheet(const std::vector<Row>& rows, const std::string& machine);

/// A point of a work-precision diagram.
struct Work {
  double time;
  double error;
};

/// The Pareto front: points that no other beats in both, by increasing time.
[[nodiscard]] std::vector<Work> pareto_front(std::vector<Work> points);

}  // namespace crankloop::program::bench
