// What `redline` prints: lines, the table of speeds or factors, and the CSV.
//
// What belongs here: columns and words. What does not: the search (redline_search.hpp), the page (redline_report.cpp).
#include "redline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../../engine_file/gas_order.hpp"
#include "../../files/csv.hpp"
#include "../../files/units.hpp"
#include "../../files/words.hpp"

namespace crankloop::program {
namespace {

/// Column of a result, in table and CSV.
struct ResultColumn {
  const char* name;
  int digits;  ///< significant ones in the table
  double (*value)(const SpeedResult&);
};
constexpr ResultColumn kColumns[] = {
    {"max_lift_mm", 6, [](const SpeedResult& r) { return r.cycle.largest_lift_m * 1e3; }},
    {"separations", 6, [](const SpeedResult& r) { return static_cast<double>(r.cycle.separations); }},
    {"separation_max_gap_mm", 4, [](const SpeedResult& r) { return r.cycle.separation_clearance_m * 1e3; }},
    {"seating_speed_m_s", 4, [](const SpeedResult& r) { return r.cycle.seating_speed_m_s; }},
    {"bounces", 6, [](const SpeedResult& r) { return static_cast<double>(r.cycle.bounces); }},
    {"bounce_height_mm", 4, [](const SpeedResult& r) { return r.cycle.bounce_height_m * 1e3; }},
    {"max_acceleration_m_s2", 5, [](const SpeedResult& r) { return r.cycle.largest_acceleration_m_s2; }},
    {"max_train_force_N", 5, [](const SpeedResult& r) { return r.train_N; }},
    {"max_cam_force_N", 5, [](const SpeedResult& r) { return r.cam_N; }},
    {"spring_margin", 4, [](const SpeedResult& r) { return r.spring_margin; }},
};

std::string digits(double value, int significant_digits) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.*g", significant_digits, value);
  return buffer;
}

/// Rows of text under a header, right-aligned in columns.
class TextTable {
 public:
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

  [[nodiscard]] std::string text() const {
    std::vector<std::size_t> width(rows_.front().size(), 0);
    for (const auto& row : rows_) {
      for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
    }
    std::string text;
    for (const auto& row : rows_) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i) {
        line += (i > 0 ? "  " : "") + std::string(width[i] - row[i].size(), ' ') + row[i];
      }
      text += line + "\n";
    }
    return text;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

constexpr const char* kMasked = "-";

/// Whether a column has a value: not beyond what the spring allows, nor the margin of a valve that never opens.
bool is_shown(const SpeedResult& result, const ResultColumn& column) {
  return result.is_possible && std::isfinite(column.value(result));
}

std::string table_of_speeds(const Sweep& sweep) {
  TextTable table;
  std::vector<std::string> header{"speed_rpm"};
  for (const ResultColumn& column : kColumns) header.emplace_back(column.name);
  table.row(header);
  for (const SpeedResult& result : sweep.at) {
    std::vector<std::string> cells{std::to_string(result.speed_rpm)};
    for (const ResultColumn& column : kColumns)
      cells.push_back(is_shown(result, column) ? digits(column.value(result), column.digits) : kMasked);
    table.row(cells);
  }
  return table.text();
}

std::string cell_of(const Onset& onset, const SpeedRange& range) {
  if (!onset.found) return ">" + std::to_string(range.to_rpm);
  return (onset.at_the_start ? "<=" : "") + std::to_string(onset.speed_rpm);
}

std::string cell_of(const StaticRedline& rigid) {
  return rigid.crank_rad_s > 0 ? digits(rigid.crank_rad_s * kRpmPerRad_s, 6) : "none";
}

/// Of what is varied: "factor", "rocker.intake.clearance_mm".
std::string column_of(const Redline& redline) {
  return redline.varied == nullptr || redline.varied->are_factors ? "factor" : redline.varied->keys;
}

std::string table_of_factors(const Redline& redline) {
  TextTable table;
  std::vector<std::string> header{column_of(redline), "separation_onset_rpm", "bounce_onset_rpm", "seating_limit_rpm",
                                  "static_redline_rpm"};
  for (const ResultColumn& column : kColumns) header.emplace_back(column.name);
  table.row(header);
  for (const Sweep& sweep : redline.sweeps) {
    std::vector<std::string> cells{sweep.value, cell_of(sweep.separation, redline.range),
                                   cell_of(sweep.bounce, redline.range), cell_of(sweep.seating, redline.range),
                                   cell_of(sweep.rigid)};
    const SpeedResult& result = sweep.at[redline.compared_at()];
    for (const ResultColumn& column : kColumns)
      cells.push_back(is_shown(result, column) ? digits(column.value(result), column.digits) : kMasked);
    table.row(cells);
  }
  return table.text();
}

void add_onset(Summary& s, const char* name, const Onset& onset, const Redline& redline) {
  if (!onset.found) return s.none(name, "rpm", "up to " + std::to_string(redline.range.to_rpm) + " rpm");
  std::vector<std::string> remarks;
  if (onset.at_the_start) remarks.emplace_back("or below: it is there at the lowest speed");
  if (onset.speed_rpm < redline.rated_rpm()) remarks.push_back("below rated_rpm = " + brief(redline.rated_rpm()));
  s.line(name, onset.speed_rpm, "rpm", join(remarks, "; "));
}

}  // namespace

Summary summary_of(const Redline& redline) {
  const Sweep& given = redline.as_given();
  const detail::ValveBody<double> body = redline.valve.body();
  Summary s;
  s.remark("valve train " + redline.valve.train().name + ", " + std::to_string(redline.range.from_rpm) + " to " +
           std::to_string(redline.range.to_rpm) + " rpm of the engine every " + std::to_string(redline.range.step_rpm) +
           "; double, rk4, tick " + brief(given.tick_s * 1e6) + " us, cycle " + std::to_string(kRedlineCycles) +
           " from rest");
  s.remark("onset: the lowest speed with a separation of at least 1 um, a bounce of at least " +
           brief(redline.limits.bounce_m * 1e6) + " um, or a seating speed above " + brief(redline.limits.seating_m_s) +
           " m/s; to 1 rpm, from the first speed of the sweep that has any");
  if (const std::string masked = masked_in_words(redline); !masked.empty()) s.remark(masked);
  s.remark(gas_on_head(redline.valve));
  if (redline.valve.valve().surge_modes == 0)
    s.remark("springs follow the valve without surge, which lowers the onsets: surge_modes of [valve " +
             redline.valve.train().name + "]");
  add_onset(s, "separation_onset", given.separation, redline);
  add_onset(s, "bounce_onset", given.bounce, redline);
  add_onset(s, "seating_limit", given.seating, redline);
  if (redline.following) {
    add_onset(s, "separation_onset_without_surge", redline.following->separation, redline);
    add_onset(s, "bounce_onset_without_surge", redline.following->bounce, redline);
  }
  if (given.rigid.crank_rad_s > 0) {
    s.line("static_redline", given.rigid.crank_rad_s * kRpmPerRad_s, "rpm", static_in_words(redline));
  } else {
    s.none("static_redline", "rpm", static_in_words(redline));
  }
  s.line("natural_frequency", open_frequency_rad_s(body) * kTurnsPerRad, "Hz", "open, on the train");
  s.line("seat_frequency", seated_frequency_rad_s(body) * kTurnsPerRad, "Hz", "on train and seat");
  return s;
}

std::string table_of(const Redline& redline) {
  if (redline.varied == nullptr) return table_of_speeds(redline.as_given());
  Summary s;
  s.remark("influence of " + redline.varied->keys + (redline.varied->are_factors ? ", times factor" : "") +
           "; from max_lift_mm on at " + std::to_string(redline.as_given().at[redline.compared_at()].speed_rpm) +
           " rpm, " +
           (redline.as_given().separation.found ? "just above the onset as given" : "the highest speed of the sweep"));
  return s.text() + table_of_factors(redline);
}

void write_csv(Output& out, const Redline& redline) {
  std::vector<std::string> header{column_of(redline), "speed_rpm"};
  for (const ResultColumn& column : kColumns) header.emplace_back(column.name);
  CsvWriter csv(out, header);
  for (const Sweep& sweep : redline.sweeps) {
    for (const SpeedResult& result : sweep.at) {
      if (redline.varied != nullptr && redline.varied->are_words) {
        csv.quoted_cell(sweep.value);
      } else {
        csv.cell(sweep.factor);
      }
      csv.cell(result.speed_rpm);
      for (const ResultColumn& column : kColumns) {
        if (is_shown(result, column)) {
          csv.cell(column.value(result));
        } else {
          csv.cell("");
        }
      }
      csv.end_row();
    }
  }
}

std::string masked_in_words(const Redline& redline) {
  std::size_t masked = 0;
  std::size_t all = 0;
  int first_rpm = 0;
  for (const Sweep& sweep : redline.sweeps) {
    all += sweep.at.size();
    for (const SpeedResult& result : sweep.at) {
      if (result.is_possible) continue;
      first_rpm = masked++ == 0 ? result.speed_rpm : std::min(first_rpm, result.speed_rpm);
    }
  }
  if (masked == 0) return "";
  return "left out: " + std::to_string(masked) + " of " + std::to_string(all) + " results, from " +
         std::to_string(first_rpm) + " rpm on, in which the valve flies beyond " +
         brief(redline.as_given().max_lift_m * 1e3) + " mm" +
         (redline.limits.lift_m > 0 ? ", where its spring binds"
                                    : ": 1.5 times the theoretical lift, for which no spring has room");
}

std::string static_in_words(const Redline& redline) {
  const Sweep& given = redline.as_given();
  if (!(given.rigid.crank_rad_s > 0)) return "the valve never opens";
  const std::string rigid = "of rigid parts without damping, at " + brief(given.rigid.cam_deg) + " deg";
  if (!given.separation.found || given.separation.at_the_start) return rigid;
  const double above = given.rigid.crank_rad_s * kRpmPerRad_s / given.separation.speed_rpm - 1;
  char percent[40];
  std::snprintf(percent, sizeof percent, "%.1f %%", 100 * std::abs(above));
  const Valve& valve = redline.valve.valve();
  std::vector<std::string> left_out{"vibration"};
  if (valve.surge_modes > 0) left_out.emplace_back("the springs' surge");
  if (gas_acts(redline.valve)) left_out.emplace_back("gas on the head");
  if (valve.guide_damping_ratio > 0) left_out.emplace_back("the guide's damping");
  return rigid + "; " + percent +
         (above > 0 ? " above the onset, which has " + join(left_out, " and ") + " too"
                    : " below the onset: vibration loads the train where the margin is least");
}

std::string text_of(const StaticRedline& rigid) {
  if (!(rigid.crank_rad_s > 0)) return "none";
  return std::to_string(std::lround(rigid.crank_rad_s * kRpmPerRad_s)) + " rpm";
}

std::string text_of(const Onset& onset, const SpeedRange& range) {
  if (!onset.found) return "none up to " + std::to_string(range.to_rpm) + " rpm";
  return (onset.at_the_start ? "at or below " : "") + std::to_string(onset.speed_rpm) + " rpm";
}

}  // namespace crankloop::program
