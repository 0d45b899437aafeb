// Random definitions at and beyond their limits, and copies of them in memory that holds something else wherever they
// are not read.
//
// What belongs here: the definitions. What does not: what is promised of them (property/limit_definitions_test.cpp,
// contract/c_definition_test.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include <crankloop/define/engine_definition.hpp>

#include "support/engines.hpp"
#include "support/random.hpp"
#include "support/valve_trains.hpp"

namespace crankloop::support {

/// All the fields of a definition in one round.
template <class Visit, class Self, class... Others>
void each_part(Visit& visit, Self& definition, Others&... others) {
  EngineDefinition::each_field(visit, definition, others...);
  visit(ListedField{1, "trigger_count"}, definition.trigger_count, others.trigger_count...);
  visit(ListedField{definition.trigger_count, "triggers"}, definition.triggers, others.triggers...);
  visit(ListedField{definition.layout.cylinders, "misfires"}, definition.misfires, others.misfires...);
  visit(ListedField{1, "wheel_fault_count"}, definition.wheel_fault_count, others.wheel_fault_count...);
  visit(ListedField{definition.wheel_fault_count, "wheel_faults"}, definition.wheel_faults, others.wheel_faults...);
  visit(ListedField{definition.train_count, "contacts"}, definition.contacts, others.contacts...);
  visit(ListedField{definition.pressure.source == PressureSource::gas ? 1 : 0, "gas"}, definition.gas, others.gas...);
  visit(ListedField{1, "reluctor"}, definition.reluctor, others.reluctor...);
  visit(ListedField{1, "lambda_sensor"}, definition.lambda_sensor, others.lambda_sensor...);
  visit(ListedField{1, "sensor_fault_count"}, definition.sensor_fault_count, others.sensor_fault_count...);
  visit(ListedField{definition.sensor_fault_count, "sensor_faults"}, definition.sensor_faults, others.sensor_faults...);
}

template <class T>
inline constexpr bool kIsList = std::is_array_v<T>;
template <class T, std::size_t N>
inline constexpr bool kIsList<std::array<T, N>> = true;

/// Puts a number at a limit, or beyond, into about one field in `one_in`; of lists into what is read of them.
class Spoil {
 public:
  Spoil(Random& random, int one_in) : random_{random}, one_in_{one_in} {}

  template <class Field>
  void operator()(const ListedField& listed, Field& field) {
    if constexpr (kIsList<Field>) {
      for (std::size_t i = 0; i < std::size(field) && static_cast<int>(i) < listed.read; ++i)
        (*this)({1, ""}, field[i]);
    } else if constexpr (kHasFields<Field>) {
      if (listed.read > 0) Field::each_field(*this, field);
    } else if (listed.read > 0 && random_.whole(1, one_in_) == 1) {
      spoil(field);
    }
  }

 private:
  template <class Field>
  void spoil(Field& field) {
    if constexpr (std::is_same_v<Field, double>) {
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      const double values[] = {0,           -0.0,      -field,     0.9 * field,
                               1.1 * field, 1e-9,      5e-324,     1e300,
                               -1e300,      kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()};
      field = values[random_.whole(0, static_cast<int>(std::size(values)) - 1)];
    } else if constexpr (std::is_same_v<Field, int>) {
      // None that is allowed is above 17, so rows that are said to be there are there.
      const int values[] = {std::numeric_limits<int>::min(), -1, 0, 1, 2, 8, 9, 16, 17, 2'000'000'000};
      field = values[random_.whole(0, static_cast<int>(std::size(values)) - 1)];
    } else if constexpr (std::is_pointer_v<Field>) {
      field = nullptr;
    } else if constexpr (std::is_same_v<Field, bool>) {
      field = !field;
    } else {
      field = static_cast<Field>(random_.whole(0, 255));
    }
  }

  Random& random_;
  int one_in_;
};

/// A definition with the rows that it points to.
class LimitDefinition {
 public:
  explicit LimitDefinition(Random& random) {
    EngineDefinition& d = definition;
    d = four_2000();
    for (int deg = 0; deg < 720; deg += 30) rows_.push_back({1.0 * deg, 1e5});
    for (int deg = -100; deg <= 100; deg += 10) cam_.push_back({1.0 * deg, deg < -60 || deg > 60 ? 0 : 5e-3});
    for (int edge = 0; edge < 18; ++edge) edges_deg_.push_back(20.0 * edge);
    const int row = random.whole(0, 50);  // may be the one that is wrong
    if (row < 5) rows_[static_cast<std::size_t>(row)].at = std::numeric_limits<double>::quiet_NaN();
    if (row > 46) cam_[static_cast<std::size_t>(row - 46)].lift_m = -1e300;
    d.pressure.source = static_cast<PressureSource>(random.whole(0, 4));
    d.pressure.wiebe.net_mep_Pa = 800e3;
    d.pressure.points = rows_.data();
    d.pressure.point_count = static_cast<int>(rows_.size());
    if (random.coin()) d.train_count = random.whole(0, kMaxTrains);
    for (int t = 0; t < kMaxTrains; ++t) {
      d.trains[t] = d.trains[t % 2];
      d.gas.ports[t] = d.gas.ports[t % 2];
      if (random.coin()) d.trains[t].rocker = ohc_125_rocker();
      if (random.whole(0, 7) > 0) continue;
      d.trains[t].cam.source = CamSource::table;
      d.trains[t].cam.points = cam_.data();
      d.trains[t].cam.point_count = static_cast<int>(cam_.size());
      d.trains[t].cam.smoothing_m = 1e-3;
    }
    d.trigger_count = random.whole(0, 3);
    for (TriggerWheel& wheel : d.triggers) {
      wheel.pattern = random.coin() ? TriggerPattern::teeth : TriggerPattern::edges;
      wheel.places = 36;
      wheel.gap_count = 1;
      wheel.gaps[0] = {30, 2};
      wheel.edges_deg = edges_deg_.data();
      wheel.edge_count = static_cast<int>(edges_deg_.size());
    }
    Spoil spoil(random, 90);
    each_part(spoil, d);
  }
  LimitDefinition(const LimitDefinition&) = delete;
  LimitDefinition& operator=(const LimitDefinition&) = delete;

  EngineDefinition definition;

 private:
  std::vector<DiagramPoint> rows_;
  std::vector<CamPoint> cam_;
  std::vector<double> edges_deg_;
};

/// Copies what is read of a definition and nothing else: from `from` to `to`, by what `self` says.
struct CopyRead {
  template <class Self, class From, class To>
  void operator()(const ListedField& listed, const Self& self, const From& from, To& to) {
    if constexpr (std::is_array_v<From> || kIsList<From>) {
      for (std::size_t i = 0; i < std::size(from) && static_cast<int>(i) < listed.read; ++i)
        (*this)({1, listed.name}, self[i], from[i], to[i]);
    } else if constexpr (kHasFields<Self>) {
      if (listed.read > 0) Self::each_field(*this, self, from, to);
    } else if (listed.read > 0 ||
               listed.name ==
                   std::string_view("valve.per_cylinder")) {  // which only gas reads, but validate() of any train
      to = from;
    }
  }
};

/// The definition in memory full of `filling`, but for what is read of it.
inline EngineDefinition in_memory_of(unsigned char filling, const EngineDefinition& from) {
  EngineDefinition to;
  static_assert(std::is_trivially_copyable_v<EngineDefinition>);
  std::memset(static_cast<void*>(&to), filling, sizeof to);
  CopyRead copy;
  each_part(copy, from, from, to);
  if (from.pressure.source == PressureSource::gas) {
    for (int t = from.train_count > 0 ? from.train_count : 0; t < kMaxTrains; ++t)
      std::memset(static_cast<void*>(&to.gas.ports[t]), filling, sizeof to.gas.ports[t]);
  }
  return to;
}

}  // namespace crankloop::support
