#include "input_schedule.hpp"

#include <algorithm>
#include <cmath>

#include "../files/error.hpp"
#include "../files/number.hpp"
#include "../files/text_file.hpp"
#include "../files/words.hpp"

namespace crankloop::program {
namespace {

constexpr std::size_t kMaxScheduleBytes = std::size_t{64} << 20;
constexpr const char* kSigns = "; columns are separated by commas, and the decimal sign is a point";

/// "fuel_kg" of "fuel_kg[2]".
std::string without_index(const std::string& name) { return name.substr(0, name.find('[')); }

std::vector<std::string> known_names(const std::vector<SceneInput>& inputs) {
  std::vector<std::string> names;
  for (const SceneInput& input : inputs) {
    if (names.empty() || names.back() != without_index(input.name)) names.push_back(without_index(input.name));
  }
  return names;
}

}  // namespace

InputSchedule::InputSchedule(const std::string& path, const std::vector<SceneInput>& inputs) : path_{path} {
  const FileBytes file = read_file(path, kMaxScheduleBytes);
  if (!file.ok()) throw InputError(path + ": " + file.problem);
  const std::vector<std::string> lines = split_lines(file.bytes, path);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string text(trim(lines[i]));
    if (text.empty() || text[0] == '#') continue;
    if (columns_.empty()) {
      read_header(text, static_cast<int>(i) + 1, inputs);
    } else {
      read_row(text, static_cast<int>(i) + 1);
    }
  }
  if (columns_.empty())
    throw InputError(path, 1, "the file is empty; it needs the header row 'time_s,NAME,...' and rows under it");
  if (times_s_.empty()) throw InputError(path, static_cast<int>(lines.size()), "no rows stand under the header");
}

void InputSchedule::refuse(int line, std::size_t place, const std::string& name, const std::string& why) const {
  throw InputError(path_, line, "column " + std::to_string(place) + (name.empty() ? "" : ", " + name) + ": " + why);
}

InputSchedule::Column InputSchedule::column_of(const std::string& name, int place, int line,
                                               const std::vector<SceneInput>& inputs) const {
  Column column{name, detail::VariableKind::real, {}, {}, {}};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i].name != name && without_index(inputs[i].name) != name) continue;
    column.kind = inputs[i].kind;
    column.range = inputs[i].range;
    column.inputs.push_back(i);
  }
  if (!column.inputs.empty()) return column;
  const std::vector<std::string> known = known_names(inputs);
  refuse(line, static_cast<std::size_t>(place), "",
         in_quotes(name) + " is no input of this engine" + suggestion(name, known) + "; its inputs are " + join(known));
}

void InputSchedule::read_header(const std::string& text, int line, const std::vector<SceneInput>& inputs) {
  const std::vector<std::string_view> names = split(text, ',');
  if (names[0] != "time_s") {
    refuse(line, 1, "", std::string("the header row begins with time_s, then come names of inputs") + kSigns);
  }
  if (names.size() < 2) refuse(line, 1, "", "a name of an input has to follow time_s");
  std::vector<std::string> driver(inputs.size());  // the column of each input
  for (std::size_t c = 1; c < names.size(); ++c) {
    if (names[c].empty()) refuse(line, c + 1, "", "a comma precedes it, but no name of an input stands there");
    Column column = column_of(std::string(names[c]), static_cast<int>(c) + 1, line, inputs);
    for (const std::size_t input : column.inputs) {
      if (!driver[input].empty()) {
        refuse(line, c + 1, column.name,
               driver[input] == column.name ? "there is such a column already"
                                            : inputs[input].name + " has the column " + driver[input] + " already");
      }
      driver[input] = column.name;
    }
    columns_.push_back(std::move(column));
  }
}

void InputSchedule::read_row(const std::string& text, int line) {
  const std::vector<std::string_view> cells = split(text, ',');
  if (cells.size() != columns_.size() + 1) {
    refuse(line, std::min(cells.size(), columns_.size() + 1), "",
           "the row has " + std::to_string(cells.size()) + (cells.size() == 1 ? " column" : " columns") +
               ", the header " + std::to_string(columns_.size() + 1) + kSigns);
  }
  const auto number = [&](std::size_t place, const std::string& name, const Range& range) {
    const ParsedNumber parsed = parse_number(cells[place], range, "");
    if (!parsed.ok()) refuse(line, place + 1, name, parsed.problem);
    return parsed.value;
  };
  const double time_s = number(0, "time_s", from(0));
  if (!times_s_.empty() && time_s <= times_s_.back()) {
    refuse(line, 1, "time_s",
           shortest(time_s) + " is not after " + shortest(times_s_.back()) + " of the row before; times must increase");
  }
  times_s_.push_back(time_s);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    Column& column = columns_[c];
    const double value = number(c + 1, column.name, column.range);
    if (column.kind != detail::VariableKind::real && value != std::floor(value))
      refuse(line, c + 2, column.name, in_quotes(cells[c + 1]) + " is not a whole number");
    column.values.push_back(value);
  }
}

void InputSchedule::at(double time_s, double* numbers) noexcept {
  while (row_ + 1 < times_s_.size() && times_s_[row_ + 1] <= time_s) ++row_;
  const bool between = row_ + 1 < times_s_.size() && time_s > times_s_[row_];
  const double share = between ? (time_s - times_s_[row_]) / (times_s_[row_ + 1] - times_s_[row_]) : 0;
  for (const Column& column : columns_) {
    double value = column.values[row_];
    if (between && column.kind == detail::VariableKind::real) value += (column.values[row_ + 1] - value) * share;
    for (const std::size_t input : column.inputs) numbers[input] = value;
  }
}

bool InputSchedule::drives(const std::string& name) const noexcept {
  return std::any_of(columns_.begin(), columns_.end(), [&](const Column& column) { return column.name == name; });
}

bool InputSchedule::drives_any(const std::string& name) const noexcept {
  return std::any_of(columns_.begin(), columns_.end(), [&](const Column& column) {
    return column.name.compare(0, name.size(), name) == 0 &&
           (column.name.size() == name.size() || column.name[name.size()] == '[');
  });
}

double InputSchedule::largest(const std::string& name) const noexcept {
  for (const Column& column : columns_) {
    if (column.name == name) return *std::max_element(column.values.begin(), column.values.end());
  }
  return 0;
}

std::string InputSchedule::columns() const {
  std::vector<std::string> names;
  for (const Column& column : columns_) names.push_back(column.name);
  return join(names);
}

}  // namespace crankloop::program
